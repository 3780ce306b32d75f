//! A servo's motor: its torque falls as it turns faster, and its rotor takes time to spin up.
//!
//! At a constant supply voltage the torque of a DC motor falls linearly with its speed, from the stall torque at
//! standstill to zero at the no-load speed. Up to this limit a servo applies torque in proportion to its error, the
//! angle from its shaft to its target. Reflected through a gear ratio of several hundred, the rotor's inertia is far
//! larger than a leg's. Only the rotor and friction therefore decide how well the servo follows its pulses.

use crate::joints::JointFriction;

/// A servo's motor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motor {
    /// Stall torque, N mm.
    pub stall_torque: f64,
    /// No-load speed, deg/s.
    pub no_load_speed: f64,
    /// Time constant with which the unloaded rotor spins up, s.
    pub rotor_time_constant: f64,
    /// Error beyond the dead band at which the servo applies its full torque, deg.
    pub full_torque_error: f64,
    /// Error up to which the servo applies no torque, deg: half the dead band.
    pub half_dead_band: f64,
}

impl Motor {
    /// Returns this motor at another supply voltage; `voltage_ratio` is relative to the present voltage.
    pub fn with_supply_ratio(&self, voltage_ratio: f64) -> Self {
        Self {
            stall_torque: self.stall_torque * voltage_ratio,
            no_load_speed: self.no_load_speed * voltage_ratio,
            ..*self
        }
    }

    /// Torque lost to back EMF per rad/s, N mm s.
    pub fn damping(&self) -> f64 {
        self.stall_torque / self.no_load_speed.to_radians()
    }

    /// Rotor inertia reflected to the output shaft, N mm s^2.
    pub fn reflected_inertia(&self) -> f64 {
        self.damping() * self.rotor_time_constant
    }

    /// Utilisation of the torque-speed line at a torque (N mm) and a rate (deg/s): 1 on the line, negative in braking.
    pub fn utilisation(&self, torque: f64, rate: f64) -> f64 {
        torque / self.stall_torque + rate / self.no_load_speed
    }
}

/// The motors of the four servos, and the friction of pins and sliders that loads them in addition to the pads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motors {
    /// The motors in servo order.
    pub per_servo: [Motor; 4],
    /// Friction of pins and sliders.
    pub joint_friction: JointFriction,
}

/// Upper bound of the time step, s.
const MAX_TIME_STEP: f64 = 0.0025;
/// Phase by which the free vibration of a servo advances in a time step, rad.
const PHASE_PER_STEP: f64 = 0.25;

impl Motors {
    /// Computes the time step of the motors' simulation, s. A light rotor with a high gain vibrates fast, and a long
    /// step would damp its vibration.
    pub(crate) fn compute_time_step(&self) -> f64 {
        let motors = self.per_servo.iter();
        // Without a rotor nothing vibrates.
        let rotors = motors.filter(|motor| motor.rotor_time_constant > 0.0);
        let max_steps = rotors.map(|motor| {
            let response_time = motor.full_torque_error / motor.no_load_speed;
            PHASE_PER_STEP * (response_time * motor.rotor_time_constant).sqrt()
        });
        max_steps.fold(MAX_TIME_STEP, f64::min)
    }

    /// Computes the slider speed, mm/s, below which the model makes friction proportional to speed, so that friction
    /// cannot reverse a servo within a time step of `seconds`.
    pub(crate) fn compute_smoothing_speed(&self, seconds: f64) -> f64 {
        let friction = &self.joint_friction;
        let squared_arms = friction.slider_arms.iter().map(|[x, y]| x * x + y * y);
        let max_squared_arm = squared_arms.fold(0.0, f64::max);
        let effective_inertia =
            |motor: &Motor| motor.reflected_inertia() + motor.damping() * seconds;
        let inertias = self.per_servo.iter().map(effective_inertia);
        let min_inertia = inertias.fold(f64::INFINITY, f64::min);
        2.0 * friction.slider_force * max_squared_arm * seconds / min_inertia
    }
}

/// The motor of an SG-90.
#[cfg(test)]
pub(crate) const SG90: Motor = Motor {
    stall_torque: 176.5,
    no_load_speed: 500.0,
    rotor_time_constant: 0.02,
    full_torque_error: 3.0,
    half_dead_band: 0.0,
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assert_near;
    use crate::drive::{Drive, DriveKind};
    use crate::ground_contact::{GroundContact, PAPER_GROUND};
    use crate::leg_geometry::Body;
    use crate::walker::Walker;

    const JOINTS: JointFriction = JointFriction {
        pin_torque: 0.0,
        slider_force: 0.0,
        slider_arms: [[-22.5, 19.8], [-22.5, -19.8], [22.5, -19.8], [22.5, 19.8]],
        shaft_spans: [[135.0, 0.0]; 2],
    };

    /// A light robot, whose feet hardly load its servos.
    const LIGHT_GROUND: GroundContact = ground_with(0.1, 0.001);

    /// Creates the contact of a robot of `mass` (g).
    const fn ground_with(mass: f64, friction_coefficient: f64) -> GroundContact {
        GroundContact {
            body: Body {
                mass,
                ..Body::DEFAULT
            },
            friction_coefficient,
            ..PAPER_GROUND
        }
    }

    fn motors_with(motor: Motor, joint_friction: JointFriction) -> Motors {
        Motors {
            per_servo: [motor; 4],
            joint_friction,
        }
    }

    /// Turns all servos from 0 towards `target` (deg) for this number of seconds.
    fn turn_servos(ground: GroundContact, motors: &Motors, target: f64, seconds: f64) -> Walker {
        let mut walker = Walker::new(ground, [0.0; 4]);
        walker.run_motors([Some(target); 4], seconds, motors);
        walker
    }

    #[test]
    fn an_unloaded_servo_spins_up_with_its_rotor_time_constant() {
        for seconds in [0.02, 0.04, 0.1] {
            let walker = turn_servos(LIGHT_GROUND, &motors_with(SG90, JOINTS), 1000.0, seconds);
            // The solution of J w' = stall - b w from rest.
            let tau = SG90.rotor_time_constant;
            let exact_angle = SG90.no_load_speed * (seconds - tau * (1.0 - (-seconds / tau).exp()));
            for angle in walker.servo_sweeps() {
                assert_near(angle / exact_angle, 1.0, 0.12);
            }
        }
    }

    #[test]
    fn a_servos_rate_falls_in_proportion_to_its_sliding_pads_torque() {
        // The front legs swing forward and the hind legs back, so every pad slides and loads its leg.
        let heavy_ground = ground_with(800.0, 1.0);
        let quick_motor = Motor {
            rotor_time_constant: 0.001,
            ..SG90
        };
        let mut walker = Walker::new(heavy_ground, [0.0; 4]);
        let targets = [8e3, 8e3, -8e3, -8e3].map(Some);
        let mut drive_and_compute_mean_angle = || {
            walker.run_motors(targets, 0.02, &motors_with(quick_motor, JOINTS));
            walker.servo_sweeps().map(f64::abs).iter().sum::<f64>() / 4.0
        };
        // Rotors and legs accelerate in the first 20 ms, which therefore do not count.
        let start_angle = drive_and_compute_mean_angle();
        let mean_rate = (drive_and_compute_mean_angle() - start_angle) / 0.02;
        let pad_torque = heavy_ground.mean_friction_force() * heavy_ground.legs.reach;
        let expected_rate = SG90.no_load_speed * (1.0 - pad_torque / SG90.stall_torque);
        assert_near(mean_rate / expected_rate, 1.0, 0.1);
    }

    #[test]
    fn on_ice_legs_that_swing_forward_move_the_body_back_by_their_mass_fraction() {
        let ice = ground_with(435.0, 1e-4);
        let walker = turn_servos(ice, &motors_with(SG90, JOINTS), 20.0, 0.5);
        let leg_travel_mm = ice.legs.foot_positions(walker.leg_sweeps())[0][0]
            - ice.legs.foot_positions([0.0; 4])[0][0];
        assert!(leg_travel_mm > 15.0, "the legs moved {leg_travel_mm} mm");
        let mass_fraction = 4.0 * ice.body.leg_mass() / ice.body.mass;
        let body_travel_mm = walker.body_pose().travel().forward;
        assert_near(body_travel_mm, -mass_fraction * leg_travel_mm, 0.02);
    }

    #[test]
    fn pin_friction_slows_a_servo_and_stops_it_if_it_exceeds_the_stall_torque() {
        let joints_with_pin_torque = |pin_torque| JointFriction {
            pin_torque,
            ..JOINTS
        };
        let final_angle = |joints| {
            turn_servos(LIGHT_GROUND, &motors_with(SG90, joints), 1000.0, 0.4).servo_sweeps()[0]
        };
        let rate_ratio =
            final_angle(joints_with_pin_torque(SG90.stall_torque / 2.0)) / final_angle(JOINTS);
        assert_near(rate_ratio, 0.5, 0.03);
        let held_angle = final_angle(joints_with_pin_torque(1.01 * SG90.stall_torque));
        assert_near(held_angle, 0.0, 1e-6);
    }

    #[test]
    fn a_slider_resists_only_the_servos_that_change_its_length() {
        let joints = JointFriction {
            slider_force: 3.0,
            ..JOINTS
        };
        let final_angles = |directions: [f64; 4], joints| {
            let mut walker = Walker::new(LIGHT_GROUND, [0.0; 4]);
            let targets = directions.map(|direction| Some(1000.0 * direction));
            walker.run_motors(targets, 0.04, &motors_with(SG90, joints));
            walker.servo_sweeps()
        };
        let first_leg_only = [1.0, 0.0, 0.0, 0.0];
        let [slow, fast] = [joints, JOINTS].map(|joints| final_angles(first_leg_only, joints)[0]);
        let lever_arm = JOINTS.slider_lever_arms([0.0; 4])[0].abs();
        assert_near(lever_arm, 19.8, 1e-9);
        let rate_ratio = 1.0 - 3.0 * lever_arm / SG90.stall_torque;
        assert_near(slow / fast, rate_ratio, 0.06);
        // Both feet of a side swing forward, so the slider's arms turn alike and its length hardly changes.
        let [slow, fast] = [joints, JOINTS].map(|joints| final_angles([1.0; 4], joints)[0]);
        let loss = 1.0 - slow / fast;
        assert!(loss < 0.4 * (1.0 - rate_ratio), "{slow} deg of {fast} deg");
    }

    #[test]
    fn an_unloaded_servo_settles_within_its_dead_band() {
        let dead_band_motor = Motor {
            half_dead_band: 0.5,
            ..SG90
        };
        for (motor, max_error) in [(dead_band_motor, 0.51), (SG90, 0.02)] {
            let motors = motors_with(motor, JOINTS);
            let [angle, ..] = turn_servos(LIGHT_GROUND, &motors, 10.0, 1.0).servo_sweeps();
            assert_near(angle, 10.0, max_error);
        }
    }

    #[test]
    fn utilisation_is_1_on_the_torque_speed_line_and_greater_at_a_lower_supply() {
        let low_supply_motor = SG90.with_supply_ratio(0.875);
        for (torque, rate) in [(176.5, 0.0), (0.0, 500.0), (88.25, 250.0)] {
            for (motor, expected) in [(SG90, 1.0), (low_supply_motor, 1.0 / 0.875)] {
                assert_near(motor.utilisation(torque, rate), expected, 1e-12);
            }
        }
        // The rotor's inertia does not depend on the supply.
        let inertia = low_supply_motor.reflected_inertia();
        assert_near(inertia, SG90.reflected_inertia(), 1e-12);
    }

    #[test]
    fn a_turning_servo_pulls_its_leg_once_the_play_is_taken_up() {
        let ground_with_play = GroundContact {
            drive: Drive {
                kind: DriveKind::Rigid,
                play: 1.0,
            },
            ..ground_with(400.0, 0.7)
        };
        // At its target the servo does not pull, and the leg may be anywhere within its play.
        let turn_first_servo = |target: f64, seconds: f64| {
            let mut walker = Walker::new(ground_with_play, [0.0; 4]);
            let targets = [target, 0.0, 0.0, 0.0].map(Some);
            walker.run_motors(targets, seconds, &motors_with(SG90, JOINTS));
            [walker.servo_sweeps(), walker.lags(), walker.leg_sweeps()].map(|angles| angles[0])
        };
        let [servo, lag, _] = turn_first_servo(10.0, 1.0);
        assert_near(servo, 10.0, 1e-6);
        assert!(lag.abs() < 1.0, "the lag is {lag} deg");
        // While the servo turns, the leg lags by the play.
        let [servo, lag, leg] = turn_first_servo(90.0, 0.1);
        assert_near(lag, 1.0, 1e-3);
        assert_near(leg, servo - lag, 1e-12);
    }
}
