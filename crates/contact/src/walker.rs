//! The robot on its floor, step by step.
//!
//! The body's movement in a step depends on earlier steps, because they leave each leg with a lag behind its
//! servo. So a [`Walker`] follows a walk: it holds the servos, the lags and the place on the floor.

use crate::feet::{Body, Feet};
use crate::friction::{Compliance, Displacement, Inertia, Pads, Point, Twist};
use crate::ground::Ground;
use crate::lag_energy::LagEnergy;
use crate::motor::Motors;
use crate::motor_step::{MotorStep, ServoState};
use crate::place::Place;

/// Largest sweep of a step, deg. A larger one is divided into equal steps.
const MAX_SWEEP: f64 = 0.5;
/// The largest number of iterations in a step. The pads' positions are those in the middle of the step, which depend
/// on the lags after it; each iteration improves them.
const MAX_ITERATIONS: usize = 4;
/// Change of a lag in an iteration below which the lag counts as settled, rad.
const MAX_LAG_CHANGE: f64 = 1e-4;
/// Rounding error allowed in a number of steps.
const STEPS_ERROR: f64 = 1e-6;
/// Width to which kinks are rounded off after a step, rad.
const KINK_WIDTH: f64 = 1e-12;

/// A robot that walks on a floor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Walker {
    ground: Ground,
    /// Factors on the load of each pad, and on the ratio of backward to forward friction.
    uneven: ([f64; 4], f64),
    /// Sweeps of the servos, deg.
    servos: [f64; 4],
    /// Speeds of the servos while motors turn them, deg/s.
    rates: [f64; 4],
    /// Lags of the legs behind their servos, deg.
    lag: [f64; 4],
    /// Speed of the body, mm/s and rad/s, while motors drive it.
    speed: Twist,
    /// Speeds of the pads over the floor, mm/s, while motors drive them.
    pad_speeds: [Point; 4],
    place: Place,
}

/// The slides and loads of the feet from one pose to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slip {
    /// Distance that each foot slid over the floor, mm.
    pub slid_distances: [f64; 4],
    /// Load of each foot at the end of the movement, relative to the mean.
    pub loads: [f64; 4],
}

impl Slip {
    const NONE: Self = Self {
        slid_distances: [0.0; 4],
        loads: [1.0; 4],
    };

    fn add(&mut self, pads: &Pads, displacement: &Displacement) {
        self.loads = pads.load;
        for (sum, [x, y]) in self
            .slid_distances
            .iter_mut()
            .zip(pads.slides(displacement))
        {
            *sum += x.hypot(y);
        }
    }
}

impl Walker {
    /// Makes a robot that stands with its servos at these sweeps (deg, foot forward
    /// positive, servo order) and its springs at rest.
    pub fn new(ground: Ground, sweeps: [f64; 4]) -> Self {
        Self::with_unevenness(ground, sweeps, [1.0; 4], 1.0)
    }

    /// Makes a robot that stands with its servos at these sweeps (deg) and its springs at rest, with
    /// factors on the loads of the pads and on the ratio of backward to forward friction.
    pub fn with_unevenness(ground: Ground, sweeps: [f64; 4], load: [f64; 4], ratio: f64) -> Self {
        Self {
            ground,
            uneven: (load, ratio),
            servos: sweeps,
            rates: [0.0; 4],
            speed: [0.0; 3],
            pad_speeds: [[0.0; 2]; 4],
            lag: [0.0; 4],
            place: Place::START,
        }
    }

    /// Place of the body on the floor.
    pub fn place(&self) -> Place {
        self.place
    }

    /// Moves the robot to another place on the floor.
    pub fn set_place(&mut self, place: Place) {
        self.place = place;
    }

    /// The floor, the pads and the drive of the legs.
    pub fn ground(&self) -> &Ground {
        &self.ground
    }

    /// Changes floor, pads or drive from the next step on. A leg that lags more than its new
    /// drive allows moves to the stop.
    pub fn set_ground(&mut self, ground: Ground) {
        self.ground = ground;
        let (drive, servos) = (&self.ground.drive, self.servos);
        self.lag = std::array::from_fn(|i| drive.limit_lag(i, servos[i], self.lag[i]));
    }

    /// Lag of each leg behind its servo, deg.
    pub fn lag(&self) -> [f64; 4] {
        self.lag
    }

    /// Sweeps of the legs, deg.
    pub fn legs(&self) -> [f64; 4] {
        std::array::from_fn(|i| self.servos[i] - self.lag[i])
    }

    /// Sweeps of the servos, deg.
    pub fn servos(&self) -> [f64; 4] {
        self.servos
    }

    /// Lets motors turn the servos towards these sweeps (deg) for some seconds. A servo without a
    /// target does not turn, because its gears hold it.
    pub fn drive(&mut self, targets: [Option<f64>; 4], seconds: f64, motors: &Motors) -> Slip {
        let mut slip = Slip::NONE;
        let step_count = (seconds / motors.step() - STEPS_ERROR).ceil().max(1.0);
        for _ in 0..step_count as usize {
            let (pads, displacement) = self.drive_step(targets, seconds / step_count, motors);
            self.place = self.place.moved(displacement.twist);
            slip.add(&pads, &displacement);
        }
        slip
    }

    /// Finds the displacement in a short time step, and turns servos and legs.
    fn drive_step(
        &mut self,
        targets: [Option<f64>; 4],
        seconds: f64,
        motors: &Motors,
    ) -> (Pads, Displacement) {
        let (grip, joints) = (self.ground.grip(), &motors.joints);
        let (servos, rates) = (self.servos, self.rates.map(f64::to_radians));
        let slider = joints.torques(servos, rates, motors.fade_speed(seconds));
        let motor_steps: [Option<MotorStep>; 4] = std::array::from_fn(|i| {
            let state = ServoState {
                target: targets[i]?.to_radians(),
                servo: servos[i].to_radians(),
                rate: rates[i],
            };
            let friction = [joints.drag, slider[i]];
            Some(MotorStep::new(
                &motors.each[i],
                state,
                seconds,
                friction,
                grip,
            ))
        });
        // The sweeps of the servos at an unchanged rate, from which their lags are counted.
        let reference: [f64; 4] = std::array::from_fn(|i| match targets[i] {
            Some(_) => servos[i] + self.rates[i] * seconds,
            None => servos[i],
        });
        let start_points = self.ground.feet.positions(self.legs());
        // A loaded motor turns nearly as far as an unloaded one, so this is a good estimate.
        let lag_estimate = std::array::from_fn(|i| {
            self.lag[i].to_radians()
                + motor_steps[i].map_or(0.0, |motor_step| motor_step.unloaded_end())
        });
        let pads = Pads {
            body: Some(self.inertia(seconds)),
            ..self.pads(start_points, reference, lag_estimate, motor_steps)
        };
        let displacement = pads.minimum();
        for (i, total_lag) in displacement.lag.into_iter().enumerate() {
            let servo_lag = pads.compliance.map_or(0.0, |compliance| {
                compliance.lag_energy[i].servo_lag(total_lag, KINK_WIDTH)
            });
            self.servos[i] = reference[i] - servo_lag.to_degrees();
            self.rates[i] = (self.servos[i] - servos[i]) / seconds;
            self.lag[i] = (total_lag - servo_lag).to_degrees();
        }
        self.speed = displacement.twist.map(|component| component / seconds);
        let slides = pads.slides(&displacement);
        self.pad_speeds = slides.map(|slide| slide.map(|component| component / seconds));
        (pads, displacement)
    }

    /// The inertia in a time step: of the body, as if its mass stood at the hips, and of the legs, whose mass
    /// is at the pads.
    fn inertia(&self, seconds: f64) -> Inertia {
        const KG_PER_G: f64 = 1e-3;
        const M_PER_MM: f64 = 1e-3;
        let Feet {
            hip_forward,
            hip_side: [front, hind],
            ..
        } = self.ground.feet;
        let Body { mass, .. } = self.ground.body;
        let leg_mass = self.ground.body.leg_mass();
        let stiffness_of =
            |mass: f64| mass * KG_PER_G * M_PER_MM / (seconds * seconds * self.ground.grip());
        let stiffness = stiffness_of(mass - 4.0 * leg_mass);
        let hip_square = hip_forward * hip_forward + (front * front + hind * hind) / 2.0;
        Inertia {
            stiffness: [stiffness, stiffness, stiffness * hip_square],
            previous_twist: self.speed.map(|component| component * seconds),
            leg_stiffness: stiffness_of(leg_mass),
            slides: self
                .pad_speeds
                .map(|speed| speed.map(|component| component * seconds)),
        }
    }

    /// Moves the servos to these sweeps, deg.
    pub fn step(&mut self, sweeps: [f64; 4]) -> Slip {
        let mut slip = Slip::NONE;
        self.move_servos(sweeps, |pads, displacement| slip.add(pads, displacement));
        slip
    }

    /// Moves the servos to these sweeps in small steps, without inertia, and calls `visit` after each step.
    pub(crate) fn move_servos(
        &mut self,
        sweeps: [f64; 4],
        mut visit: impl FnMut(&Pads, &Displacement),
    ) {
        let servos = self.servos;
        (self.rates, self.speed) = ([0.0; 4], [0.0; 3]);
        self.pad_speeds = [[0.0; 2]; 4];
        let max_turn = (0..4).fold(0.0f64, |max, i| max.max((sweeps[i] - servos[i]).abs()));
        let step_count = (max_turn / MAX_SWEEP).ceil().max(1.0) as usize;
        for step in 1..=step_count {
            let share = step as f64 / step_count as f64;
            let next = std::array::from_fn(|i| servos[i] + share * (sweeps[i] - servos[i]));
            let (pads, displacement) = self.find_step(next);
            self.place = self.place.moved(displacement.twist);
            self.servos = next;
            self.lag = displacement.lag.map(f64::to_degrees);
            visit(&pads, &displacement);
        }
    }

    /// Finds the displacement of a small step of the servos to these sweeps.
    fn find_step(&self, servos: [f64; 4]) -> (Pads, Displacement) {
        let start_points = self.ground.feet.positions(self.legs());
        let mut lag = self.lag.map(f64::to_radians);
        let mut pads = self.pads(start_points, servos, lag, [None; 4]);
        let mut displacement = pads.minimum();
        for _ in 1..MAX_ITERATIONS {
            let error = (0..4).fold(0.0f64, |error, i| {
                error.max((displacement.lag[i] - lag[i]).abs())
            });
            if error < MAX_LAG_CHANGE {
                break;
            }
            lag = displacement.lag;
            pads = self.pads(start_points, servos, lag, [None; 4]);
            displacement = pads.minimum_near(Some(&displacement));
        }
        (pads, displacement)
    }

    /// Sets up the pads of a small step, after which the legs lag about `lag` rad behind their
    /// servos.
    fn pads(
        &self,
        start_points: [Point; 4],
        servos: [f64; 4],
        lag: [f64; 4],
        motors: [Option<MotorStep>; 4],
    ) -> Pads {
        let feet = &self.ground.feet;
        let end_sweeps: [f64; 4] = std::array::from_fn(|i| servos[i] - lag[i].to_degrees());
        let end_points = feet.positions(end_sweeps);
        let derivatives = feet.sweep_derivatives(end_sweeps);
        // Positions in the middle of the step, so that the reverse step is its exact inverse.
        let positions = points_from(&|i, j| (start_points[i][j] + end_points[i][j]) / 2.0);
        let lag_before = self.lag.map(f64::to_radians);
        let (load_factors, ratio_factor) = self.uneven;
        let loads = self.ground.loads(positions);
        let (drive, grip) = (&self.ground.drive, self.ground.grip());
        // No pad carries more than the whole robot.
        let max_pad_torque = 4.0 * feet.reach * (self.ground.ratio * ratio_factor).max(1.0);
        Pads {
            at: positions,
            swing: points_from(&|i, j| {
                end_points[i][j] - start_points[i][j] + (lag[i] - lag_before[i]) * derivatives[i][j]
            }),
            ratio: self.ground.ratio * ratio_factor,
            load: std::array::from_fn(|i| loads[i] * load_factors[i]),
            body: None,
            compliance: (drive.can_lag() || motors.iter().any(Option::is_some)).then(|| {
                Compliance {
                    lag_derivatives: derivatives,
                    previous_lags: lag_before,
                    lag_energy: std::array::from_fn(|i| LagEnergy {
                        motor: motors[i],
                        ..drive.lag_energy_of_leg(i, servos[i], grip, max_pad_torque)
                    }),
                }
            }),
        }
    }
}

fn points_from(component: &dyn Fn(usize, usize) -> f64) -> [Point; 4] {
    std::array::from_fn(|i| std::array::from_fn(|j| component(i, j)))
}
