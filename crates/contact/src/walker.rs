//! The simulation of a robot on its floor, step by step.
//!
//! The body's displacement in a step depends on earlier steps, because they leave each leg with a lag behind its servo.
//! A [`Walker`] therefore keeps the state of a walk: the servos' sweeps, the lags and the pose on the floor.

use crate::body_pose::BodyPose;
use crate::friction::{Compliance, Displacement, Inertia, Pads, Point, Twist};
use crate::ground_contact::GroundContact;
use crate::lag_energy::LagEnergy;
use crate::motor::Motors;
use crate::motor_step::{MotorStep, ServoState};

/// Largest sweep in one step, deg. A larger sweep is divided into equal steps.
const MAX_STEP_SWEEP: f64 = 0.5;
/// Largest number of iterations in a step. The pads' positions in the middle of the step depend on the lags after the
/// step; each iteration improves the estimate of these lags.
const MAX_ITERATIONS: usize = 4;
/// Largest error of a lag's estimate that needs no further iteration, rad.
const LAG_TOLERANCE: f64 = 1e-4;
/// Largest rounding error of a computed number of steps.
const STEP_COUNT_TOLERANCE: f64 = 1e-6;
/// Width over which the energy's kinks are smoothed when a lag is divided between servo and leg, rad.
const KINK_WIDTH: f64 = 1e-12;

/// A robot that walks on a floor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Walker {
    /// The contact of the robot with its floor.
    ground: GroundContact,
    /// Factors of the pads' loads.
    load_factors: [f64; 4],
    /// Factor of the ratio of backward to forward friction.
    ratio_factor: f64,
    /// Sweeps of the servos, deg.
    servo_sweeps: [f64; 4],
    /// Rates of the servos while motors turn them, deg/s.
    servo_rates: [f64; 4],
    /// Lags of the legs behind their servos, deg.
    lags: [f64; 4],
    /// Velocity of the body while motors drive the robot, mm/s and rad/s.
    body_velocity: Twist,
    /// Velocities of the pads over the floor while motors drive them, mm/s.
    pad_velocities: [Point; 4],
    /// Pose of the body on the floor.
    body_pose: BodyPose,
}

/// The contacts of the feet with the floor in a motion from one pose to the next: slides and loads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contacts {
    /// Distance that each foot slid over the floor, mm.
    pub slid_distances: [f64; 4],
    /// Load of each foot at the end of the motion, relative to the mean.
    pub loads: [f64; 4],
}

impl Contacts {
    const NONE: Self = Self {
        slid_distances: [0.0; 4],
        loads: [1.0; 4],
    };

    /// Adds the slides of a step, and keeps its loads.
    fn add(&mut self, pads: &Pads, displacement: &Displacement) {
        self.loads = pads.loads;
        let slides = pads.slides(displacement);
        for (sum, [x, y]) in self.slid_distances.iter_mut().zip(slides) {
            *sum += x.hypot(y);
        }
    }
}

impl Walker {
    /// Creates a walker without lags, with its servos at these sweeps (deg, foot forward positive, servo order).
    pub fn new(ground: GroundContact, sweeps: [f64; 4]) -> Self {
        Self::with_unevenness(ground, sweeps, [1.0; 4], 1.0)
    }

    /// Creates a walker without lags, with its servos at these sweeps (deg), and with factors of the pads' loads and of
    /// the ratio of backward to forward friction.
    pub fn with_unevenness(
        ground: GroundContact,
        sweeps: [f64; 4],
        load_factors: [f64; 4],
        ratio_factor: f64,
    ) -> Self {
        Self {
            ground,
            load_factors,
            ratio_factor,
            servo_sweeps: sweeps,
            servo_rates: [0.0; 4],
            body_velocity: [0.0; 3],
            pad_velocities: [[0.0; 2]; 4],
            lags: [0.0; 4],
            body_pose: BodyPose::START,
        }
    }

    /// Pose of the body on the floor.
    pub fn body_pose(&self) -> BodyPose {
        self.body_pose
    }

    /// Moves the robot to another pose on the floor.
    pub fn set_body_pose(&mut self, body_pose: BodyPose) {
        self.body_pose = body_pose;
    }

    /// The contact of the robot with its floor.
    pub fn ground(&self) -> &GroundContact {
        &self.ground
    }

    /// Changes the robot or its floor. A leg that lags more than its new drive allows moves to the stop.
    pub fn set_ground(&mut self, ground: GroundContact) {
        self.ground = ground;
        let (drive, servo_sweeps) = (&self.ground.drive, self.servo_sweeps);
        self.lags = std::array::from_fn(|i| drive.clamp_lag(i, servo_sweeps[i], self.lags[i]));
    }

    /// Lag of each leg behind its servo, deg.
    pub fn lags(&self) -> [f64; 4] {
        self.lags
    }

    /// Sweeps of the legs, deg.
    pub fn leg_sweeps(&self) -> [f64; 4] {
        std::array::from_fn(|i| self.servo_sweeps[i] - self.lags[i])
    }

    /// Sweeps of the servos, deg.
    pub fn servo_sweeps(&self) -> [f64; 4] {
        self.servo_sweeps
    }

    /// Lets motors turn the servos towards these sweeps (deg) for this number of seconds. A servo without a target is
    /// held by the friction of its gears.
    pub fn run_motors(
        &mut self,
        targets: [Option<f64>; 4],
        seconds: f64,
        motors: &Motors,
    ) -> Contacts {
        let mut contacts = Contacts::NONE;
        let min_step_count = seconds / motors.compute_time_step() - STEP_COUNT_TOLERANCE;
        let step_count = min_step_count.ceil().max(1.0);
        for _ in 0..step_count as usize {
            let (pads, displacement) = self.advance_step(targets, seconds / step_count, motors);
            self.body_pose = self.body_pose.moved_by_twist(displacement.twist);
            contacts.add(&pads, &displacement);
        }
        contacts
    }

    /// Finds the displacement in a short time step, and updates servos, lags and velocities.
    fn advance_step(
        &mut self,
        targets: [Option<f64>; 4],
        seconds: f64,
        motors: &Motors,
    ) -> (Pads, Displacement) {
        let joint_friction = &motors.joint_friction;
        let (start_sweeps, start_rates) =
            (self.servo_sweeps, self.servo_rates.map(f64::to_radians));
        let smoothing_speed = motors.compute_smoothing_speed(seconds);
        let slider_torques =
            joint_friction.slider_torques(start_sweeps, start_rates, smoothing_speed);
        let motor_steps: [Option<MotorStep>; 4] = std::array::from_fn(|i| {
            let state = ServoState {
                target_angle: targets[i]?.to_radians(),
                angle: start_sweeps[i].to_radians(),
                rate: start_rates[i],
            };
            Some(MotorStep::new(
                &motors.per_servo[i],
                state,
                seconds,
                [joint_friction.pin_torque, slider_torques[i]],
                self.ground.mean_friction_force(),
            ))
        });
        // The servos' lags are relative to the sweeps that the servos would reach at unchanged rates.
        let reference_sweeps: [f64; 4] = std::array::from_fn(|i| match targets[i] {
            Some(_) => start_sweeps[i] + self.servo_rates[i] * seconds,
            None => start_sweeps[i],
        });
        let start_points = self.ground.legs.foot_positions(self.leg_sweeps());
        // In a short step a loaded motor turns nearly as far as an unloaded motor, so this is a good estimate.
        let unloaded_lags = motor_steps.map(|step| step.map_or(0.0, |step| step.unloaded_lag()));
        let lag_estimates = std::array::from_fn(|i| self.lags[i].to_radians() + unloaded_lags[i]);
        let pads = Pads {
            inertia: Some(self.compute_inertia(seconds)),
            ..self.build_pads(start_points, reference_sweeps, lag_estimates, motor_steps)
        };
        let displacement = pads.minimise_cost(None);
        for (i, total_lag) in displacement.lags.into_iter().enumerate() {
            let servo_lag = pads.compliance.map_or(0.0, |compliance| {
                compliance.lag_energies[i].servo_lag(total_lag, KINK_WIDTH)
            });
            self.servo_sweeps[i] = reference_sweeps[i] - servo_lag.to_degrees();
            self.servo_rates[i] = (self.servo_sweeps[i] - start_sweeps[i]) / seconds;
            self.lags[i] = (total_lag - servo_lag).to_degrees();
        }
        self.body_velocity = displacement.twist.map(|component| component / seconds);
        let slides = pads.slides(&displacement);
        self.pad_velocities = slides.map(|slide| slide.map(|component| component / seconds));
        (pads, displacement)
    }

    /// Computes the inertia in a time step of `seconds`. The body's mass counts as if it were at the hips, the legs'
    /// mass as if it were at the pads.
    fn compute_inertia(&self, seconds: f64) -> Inertia {
        const KG_PER_G: f64 = 1e-3;
        const M_PER_MM: f64 = 1e-3;
        let GroundContact { legs, body, .. } = self.ground;
        let ([front, hind], leg_mass) = (legs.hip_side, body.leg_mass());
        let to_stiffness = |mass: f64| {
            mass * KG_PER_G * M_PER_MM / (seconds * seconds * self.ground.mean_friction_force())
        };
        let stiffness = to_stiffness(body.mass - 4.0 * leg_mass);
        let squared_hip_distance =
            legs.hip_forward * legs.hip_forward + (front * front + hind * hind) / 2.0;
        let per_step = |velocity: f64| velocity * seconds;
        Inertia {
            stiffness: [stiffness, stiffness, stiffness * squared_hip_distance],
            previous_twist: self.body_velocity.map(per_step),
            leg_stiffness: to_stiffness(leg_mass),
            previous_slides: self.pad_velocities.map(|velocity| velocity.map(per_step)),
        }
    }

    /// Moves the servos to these sweeps (deg) in small steps, without inertia.
    pub fn move_to(&mut self, sweeps: [f64; 4]) -> Contacts {
        let mut contacts = Contacts::NONE;
        self.move_servos(sweeps, |pads, step| contacts.add(pads, step));
        contacts
    }

    /// Moves the servos to these sweeps (deg) in small steps, without inertia, and calls `visit` after each step.
    pub(crate) fn move_servos(
        &mut self,
        sweeps: [f64; 4],
        mut visit: impl FnMut(&Pads, &Displacement),
    ) {
        let start_sweeps = self.servo_sweeps;
        (self.servo_rates, self.body_velocity) = ([0.0; 4], [0.0; 3]);
        self.pad_velocities = [[0.0; 2]; 4];
        let changes = (0..4).map(|i| (sweeps[i] - start_sweeps[i]).abs());
        let max_change = changes.fold(0.0, f64::max);
        let step_count = (max_change / MAX_STEP_SWEEP).ceil().max(1.0) as usize;
        for step in 1..=step_count {
            let fraction = step as f64 / step_count as f64;
            let next_sweeps =
                std::array::from_fn(|i| start_sweeps[i] + fraction * (sweeps[i] - start_sweeps[i]));
            let (pads, displacement) = self.find_displacement(next_sweeps);
            self.body_pose = self.body_pose.moved_by_twist(displacement.twist);
            self.servo_sweeps = next_sweeps;
            self.lags = displacement.lags.map(f64::to_degrees);
            visit(&pads, &displacement);
        }
    }

    /// Finds the displacement in a small step of the servos to these sweeps, deg.
    fn find_displacement(&self, servo_sweeps: [f64; 4]) -> (Pads, Displacement) {
        let start_points = self.ground.legs.foot_positions(self.leg_sweeps());
        let mut lag_estimates = self.lags.map(f64::to_radians);
        let mut pads = self.build_pads(start_points, servo_sweeps, lag_estimates, [None; 4]);
        let mut displacement = pads.minimise_cost(None);
        for _ in 1..MAX_ITERATIONS {
            let errors = (0..4).map(|i| (displacement.lags[i] - lag_estimates[i]).abs());
            if errors.fold(0.0, f64::max) < LAG_TOLERANCE {
                break;
            }
            lag_estimates = displacement.lags;
            pads = self.build_pads(start_points, servo_sweeps, lag_estimates, [None; 4]);
            displacement = pads.minimise_cost(Some(&displacement));
        }
        (pads, displacement)
    }

    /// Builds the pads for a small step of the servos to `servo_sweeps` (deg), after which the lags are about
    /// `lag_estimates` (rad).
    fn build_pads(
        &self,
        start_points: [Point; 4],
        servo_sweeps: [f64; 4],
        lag_estimates: [f64; 4],
        motor_steps: [Option<MotorStep>; 4],
    ) -> Pads {
        let legs = &self.ground.legs;
        let end_sweeps = std::array::from_fn(|i| servo_sweeps[i] - lag_estimates[i].to_degrees());
        let end_points = legs.foot_positions(end_sweeps);
        let derivatives = legs.sweep_derivatives(end_sweeps);
        // With the positions in the middle of the step, the reverse step is its exact inverse.
        let positions = build_points(&|i, j| (start_points[i][j] + end_points[i][j]) / 2.0);
        let previous_lags = self.lags.map(f64::to_radians);
        let friction_ratio = self.ground.friction_ratio * self.ratio_factor;
        let GroundContact { stance, body, .. } = &self.ground;
        let loads = stance.relative_loads(body, positions);
        let drive = &self.ground.drive;
        // No pad carries more than the whole robot.
        let max_pad_torque = 4.0 * legs.reach * friction_ratio.max(1.0);
        let force_unit = self.ground.mean_friction_force();
        let is_compliant = drive.can_lag() || motor_steps.iter().any(Option::is_some);
        Pads {
            positions,
            swings: build_points(&|i, j| {
                end_points[i][j] - start_points[i][j]
                    + (lag_estimates[i] - previous_lags[i]) * derivatives[i][j]
            }),
            friction_ratio,
            loads: std::array::from_fn(|i| loads[i] * self.load_factors[i]),
            inertia: None,
            compliance: is_compliant.then(|| Compliance {
                sweep_derivatives: derivatives,
                previous_lags,
                lag_energies: std::array::from_fn(|i| LagEnergy {
                    motor: motor_steps[i],
                    ..drive.lag_energy(i, servo_sweeps[i], force_unit, max_pad_torque)
                }),
            }),
        }
    }
}

/// Builds four points from their components, a function of the pad and the axis.
fn build_points(component: &dyn Fn(usize, usize) -> f64) -> [Point; 4] {
    std::array::from_fn(|i| std::array::from_fn(|j| component(i, j)))
}
