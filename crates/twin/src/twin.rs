//! Simulates a robot on a floor, frame by frame, from its servo pulses.

use lizard_contact::{BodyPose, FORWARD_TURN_SIGN, GroundContact, Walker};
use lizard_kinematics::wrap;
use lizard_robot::{CheckedGait, Robot};

use crate::FRAME_PERIOD_S;
use crate::servo::ServoModel;
use crate::shape::Shape;
use crate::state::State;
use crate::totals::Totals;

/// A simulated robot on a floor, with the state of its servos and legs.
#[derive(Debug, Clone)]
pub struct Twin {
    robot: Robot,
    servo_model: ServoModel,
    /// Actual servo sweeps from neutral, deg, counter-clockwise positive.
    sweeps: [f64; 4],
    walker: Walker,
    frame_count: u64,
}

impl Twin {
    /// Creates a twin in the neutral pose, without pulses and without lag in its legs.
    pub fn new(robot: &Robot, servo_model: ServoModel) -> Self {
        Self {
            robot: robot.clone(),
            servo_model,
            sweeps: [0.0; 4],
            walker: Walker::new(*robot.ground(), [0.0; 4]),
            frame_count: 0,
        }
    }

    /// Simulates a frame of 20 ms with the given pulse widths, us. `None` means that a servo has no pulse: its gears
    /// hold it where it is.
    pub fn simulate_pulses(&mut self, widths_us: [Option<f64>; 4]) -> State {
        let servos = self.robot.servos();
        let targets = std::array::from_fn(|i| widths_us[i].map(|width| servos[i].sweep(width)));
        self.simulate_targets(targets)
    }

    /// Simulates a frame of 20 ms with the pulses for the given servo angles, deg, chassis frame.
    pub fn simulate_angles(&mut self, angles: [f64; 4]) -> State {
        let servos = self.robot.servos();
        let targets = std::array::from_fn(|i| Some(wrap(angles[i] - servos[i].neutral)));
        self.simulate_targets(targets)
    }

    /// Simulates a frame in which the servos turn towards target sweeps from neutral, deg, counter-clockwise positive;
    /// a servo with `None` has no pulse.
    fn simulate_targets(&mut self, targets: [Option<f64>; 4]) -> State {
        let previous_sweeps = self.sweeps;
        let servos = self.robot.servos();
        let targets: [Option<f64>; 4] = std::array::from_fn(|i| {
            let (min, max) = servos[i].travel();
            targets[i].map(|target| target.clamp(min, max))
        });
        let contacts = match self.servo_model {
            ServoModel::Motors(motors) => {
                let forward_targets =
                    std::array::from_fn(|i| targets[i].map(|target| FORWARD_TURN_SIGN[i] * target));
                let contacts = self
                    .walker
                    .run_motors(forward_targets, FRAME_PERIOD_S, &motors);
                let servo_sweeps = self.walker.servo_sweeps();
                self.sweeps = std::array::from_fn(|i| FORWARD_TURN_SIGN[i] * servo_sweeps[i]);
                contacts
            }
            ServoModel::Ideal | ServoModel::Unloaded { .. } => {
                for (i, servo) in servos.iter().enumerate() {
                    if let Some(target) = targets[i] {
                        self.sweeps[i] = self.servo_model.compute_end_sweep(
                            previous_sweeps[i],
                            target,
                            servo.us_per_degree,
                        );
                    }
                }
                // The legs' sweeps without lag.
                let leg_sweeps = std::array::from_fn(|i| FORWARD_TURN_SIGN[i] * self.sweeps[i]);
                self.walker.move_to(leg_sweeps)
            }
        };
        let errors =
            std::array::from_fn(|i| targets[i].map_or(0.0, |target| target - self.sweeps[i]));
        self.frame_count += 1;
        let angles = self.angles();
        let solution = self.robot.lizard().solve(&angles.into()).ok();
        let body_pose = self.walker.body_pose();
        let ground = self.walker.ground();
        let mean_load = ground.body.mean_load();
        State {
            frame: self.frame_count,
            has_pulse: targets.map(|target| target.is_some()),
            body_pose,
            angles,
            rates: std::array::from_fn(|i| (self.sweeps[i] - previous_sweeps[i]) / FRAME_PERIOD_S),
            errors,
            lags: self.walker.lags(),
            feet: ground
                .legs
                .foot_positions(self.walker.leg_sweeps())
                .map(|foot| body_pose.to_floor(foot)),
            slips: contacts.slid_distances,
            loads: contacts.loads.map(|fraction| fraction * mean_load),
            margins: solution.map(|solution| solution.margins),
            strokes: solution.map(|solution| [solution.left.s, solution.right.s]),
        }
    }

    /// The simulated robot.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Computes the current joint positions, chassis frame; `None` if the loop of a five-bar or slider does not close.
    pub fn shape(&self) -> Option<Shape> {
        Shape::from_angles(&self.robot, self.angles(), self.leg_sweeps())
    }

    /// The current servo angles, deg, chassis frame.
    pub fn angles(&self) -> [f64; 4] {
        std::array::from_fn(|i| self.robot.servos()[i].neutral + self.sweeps[i])
    }

    /// The current leg sweeps, deg, foot forward positive. A leg may lag behind its servo.
    pub fn leg_sweeps(&self) -> [f64; 4] {
        self.walker.leg_sweeps()
    }

    /// The current model of floor, pads and leg drive.
    pub fn ground(&self) -> &GroundContact {
        self.walker.ground()
    }

    /// Changes the floor, the pads and the leg drive from the next frame on.
    pub fn set_ground(&mut self, ground: GroundContact) {
        self.walker.set_ground(ground);
    }

    /// Simulates two cycles of a gait at its nominal rate from neutral, with the current ground and servos, and returns
    /// the totals of the second cycle. Does not change this twin.
    pub fn simulate_cycle(&self, gait: &CheckedGait) -> Totals {
        let mut twin = Self::new(&self.robot, self.servo_model);
        twin.set_ground(*self.ground());
        let mut totals = Totals::new(BodyPose::START);
        for _ in 0..2 {
            totals = Totals::new(twin.walker.body_pose());
            for (_, phase) in gait.frames() {
                totals.add(&twin.simulate_angles(gait.table_angles(phase)));
            }
        }
        totals
    }

    /// The servo model.
    pub fn servo_model(&self) -> ServoModel {
        self.servo_model
    }

    /// Changes the servo model from the next frame on.
    pub fn set_servo_model(&mut self, servo_model: ServoModel) {
        self.servo_model = servo_model;
    }

    /// Moves the robot to another pose on the floor.
    pub fn set_body_pose(&mut self, body_pose: BodyPose) {
        self.walker.set_body_pose(body_pose);
    }
}
