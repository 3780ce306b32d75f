//! A servo's motor: its torque falls as it turns faster, and its rotor takes time to spin up.
//!
//! At a constant supply voltage the torque of a DC motor falls linearly with its speed, from the stall torque at
//! standstill to zero at the no-load speed. Up to this limit a servo applies torque in proportion to its error.
//! Through a gear ratio of several hundred the rotor's inertia is far larger than that of a leg, so only rotor
//! and friction decide how well the servo follows its pulses.

use crate::joints::JointFriction;

/// A servo's motor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motor {
    /// Stall torque, N mm.
    pub stall_torque: f64,
    /// No-load speed, deg/s.
    pub no_load_speed: f64,
    /// Time constant with which the rotor spins up without load, s.
    pub spin_up_time: f64,
    /// Error beyond the dead band at which the full torque is applied, deg.
    pub full_torque_error: f64,
    /// Error within which no torque is applied, deg: half the dead band.
    pub half_dead_band: f64,
}

impl Motor {
    /// Returns this motor at another supply voltage, given relative to its present one.
    pub fn at_supply(&self, voltage_ratio: f64) -> Self {
        Self {
            stall_torque: self.stall_torque * voltage_ratio,
            no_load_speed: self.no_load_speed * voltage_ratio,
            ..*self
        }
    }

    /// Torque that the motor loses for each rad/s by its back EMF, N mm s.
    pub fn damping(&self) -> f64 {
        self.stall_torque / self.no_load_speed.to_radians()
    }

    /// Inertia of the rotor at the servo's output shaft, N mm s^2.
    pub fn inertia(&self) -> f64 {
        self.damping() * self.spin_up_time
    }

    /// The share of the motor's torque-speed line that a torque (N mm) at a rate (deg/s) takes: 1 for a point on
    /// the line, which is the most that the motor can do; negative while the motor brakes.
    pub fn line_share(&self, torque: f64, rate: f64) -> f64 {
        torque / self.stall_torque + rate / self.no_load_speed
    }
}

/// The motors of the four servos, and the friction of pins and sliders, which loads them in addition to the pads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motors {
    /// The motors in servo order.
    pub per_servo: [Motor; 4],
    /// Friction of pins and sliders.
    pub joints: JointFriction,
}

/// Upper bound of the time step, s.
const MAX_TIME_STEP: f64 = 0.0025;
/// Phase by which the free vibration of a servo advances in a time step, rad.
const RADIANS_PER_STEP: f64 = 0.25;

impl Motors {
    /// The time step of the simulation of the motors, s. A light rotor with a high gain vibrates fast, and a
    /// long step would damp its vibration.
    pub(crate) fn time_step(&self) -> f64 {
        let radian_time_of = |motor: &Motor| match motor.spin_up_time > 0.0 {
            true => (motor.full_torque_error / motor.no_load_speed * motor.spin_up_time).sqrt(),
            // Without a rotor nothing vibrates.
            false => f64::INFINITY,
        };
        let steps = self
            .per_servo
            .iter()
            .map(|motor| RADIANS_PER_STEP * radian_time_of(motor));
        steps.fold(MAX_TIME_STEP, f64::min)
    }

    /// The speed of a slider, mm/s, below which its friction is modelled as proportional to the speed, so that it
    /// cannot reverse a servo within a time step of `seconds`.
    pub(crate) fn fade_speed(&self, seconds: f64) -> f64 {
        let square_of = |[x, y]: [f64; 2]| x * x + y * y;
        let max_arm_square = self
            .joints
            .slider_arms
            .map(square_of)
            .into_iter()
            .fold(0.0, f64::max);
        let resistance_of = |motor: &Motor| motor.inertia() + motor.damping() * seconds;
        let min_resistance = self
            .per_servo
            .iter()
            .map(resistance_of)
            .fold(f64::INFINITY, f64::min);
        2.0 * self.joints.slider_force * max_arm_square * seconds / min_resistance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assert_near;
    use crate::drive::{Drive, DriveKind};
    use crate::feet::{Body, PAPER_FEET};
    use crate::ground::Ground;
    use crate::stance::Stance;
    use crate::walker::Walker;

    const SG90: Motor = Motor {
        stall_torque: 176.5,
        no_load_speed: 500.0,
        spin_up_time: 0.02,
        full_torque_error: 3.0,
        half_dead_band: 0.0,
    };

    const JOINTS: JointFriction = JointFriction {
        pin_torque: 0.0,
        slider_force: 0.0,
        slider_arms: [[-22.5, 19.8], [-22.5, -19.8], [22.5, -19.8], [22.5, 19.8]],
        base: 135.0,
    };

    /// A robot of this mass (g) on a floor with this friction coefficient. The feet of a light robot hardly load
    /// its servos.
    fn ground_with(mass: f64, friction_coefficient: f64) -> Ground {
        Ground {
            feet: PAPER_FEET,
            body: Body {
                mass,
                ..Body::DEFAULT
            },
            stance: Stance::LEVEL,
            friction_coefficient,
            friction_ratio: 1.0,
            drive: Drive::RIGID,
        }
    }

    fn motors_with(motor: Motor, joints: JointFriction) -> Motors {
        Motors {
            per_servo: [motor; 4],
            joints,
        }
    }

    /// Turns all servos from 0 towards `target` deg for this number of seconds.
    fn turn_servos(ground: Ground, motors: &Motors, target: f64, seconds: f64) -> Walker {
        let mut walker = Walker::new(ground, [0.0; 4]);
        walker.drive([Some(target); 4], seconds, motors);
        walker
    }

    #[test]
    fn an_unloaded_servo_spins_up_with_the_time_constant_of_its_rotor() {
        let light_ground = ground_with(0.1, 0.001);
        for seconds in [0.02, 0.04, 0.1] {
            let walker = turn_servos(light_ground, &motors_with(SG90, JOINTS), 1000.0, seconds);
            // The solution of J w' = stall - b w from rest.
            let Motor {
                no_load_speed: rate,
                spin_up_time,
                ..
            } = SG90;
            let exact_angle =
                rate * (seconds - spin_up_time * (1.0 - (-seconds / spin_up_time).exp()));
            for angle in walker.servo_sweeps() {
                assert_near(angle / exact_angle, 1.0, 0.12);
            }
        }
    }

    #[test]
    fn the_rate_of_a_servo_falls_in_proportion_to_the_torque_of_its_sliding_pad() {
        // The two front legs swing forward, the hind legs back: every pad slides and loads its leg.
        let heavy_ground = ground_with(800.0, 1.0);
        let quick_motor = Motor {
            spin_up_time: 0.001,
            ..SG90
        };
        let mut walker = Walker::new(heavy_ground, [0.0; 4]);
        let targets = [8e3, 8e3, -8e3, -8e3].map(Some);
        let mut mean_angle_after_20_ms = || {
            walker.drive(targets, 0.02, &motors_with(quick_motor, JOINTS));
            walker.servo_sweeps().map(f64::abs).iter().sum::<f64>() / 4.0
        };
        // The first 20 ms, in which rotors and legs accelerate, do not count.
        let mean_rate = (-mean_angle_after_20_ms() + mean_angle_after_20_ms()) / 0.02;
        let pad_torque = heavy_ground.mean_pad_friction() * heavy_ground.feet.reach;
        let expected_rate = SG90.no_load_speed * (1.0 - pad_torque / SG90.stall_torque);
        assert_near(mean_rate / expected_rate, 1.0, 0.1);
    }

    #[test]
    fn on_ice_legs_that_swing_forward_move_the_body_back_by_their_share_of_the_mass() {
        let ice = ground_with(435.0, 1e-4);
        let walker = turn_servos(ice, &motors_with(SG90, JOINTS), 20.0, 0.5);
        let leg_travel =
            ice.feet.positions(walker.leg_sweeps())[0][0] - ice.feet.positions([0.0; 4])[0][0];
        assert!(leg_travel > 15.0, "{leg_travel}");
        let share = 4.0 * ice.body.leg_mass() / ice.body.mass;
        let body_travel = walker.place().travel().forward;
        assert_near(body_travel, -share * leg_travel, 0.02);
    }

    #[test]
    fn friction_of_the_pins_slows_a_servo_and_holds_it_above_the_stall_torque() {
        let light_ground = ground_with(0.1, 0.001);
        let joints_with_pin_torque = |pin_torque| JointFriction {
            pin_torque,
            ..JOINTS
        };
        let angle_after = |joints| {
            turn_servos(light_ground, &motors_with(SG90, joints), 1000.0, 0.4).servo_sweeps()[0]
        };
        let rate_ratio =
            angle_after(joints_with_pin_torque(SG90.stall_torque / 2.0)) / angle_after(JOINTS);
        assert_near(rate_ratio, 0.5, 0.03);
        let held_angle = angle_after(joints_with_pin_torque(1.01 * SG90.stall_torque));
        assert_near(held_angle, 0.0, 1e-6);
    }

    #[test]
    fn a_slider_resists_only_servos_that_change_its_length() {
        let light_ground = ground_with(0.1, 0.001);
        let joints = JointFriction {
            slider_force: 3.0,
            ..JOINTS
        };
        let angles_after = |directions: [f64; 4], joints| {
            let mut walker = Walker::new(light_ground, [0.0; 4]);
            let targets = directions.map(|direction| Some(1000.0 * direction));
            walker.drive(targets, 0.04, &motors_with(SG90, joints));
            walker.servo_sweeps()
        };
        let first_leg_only = [1.0, 0.0, 0.0, 0.0];
        let [slow, fast] = [joints, JOINTS].map(|joints| angles_after(first_leg_only, joints)[0]);
        let lever_arm = JOINTS.slider_lever_arms([0.0; 4])[0].abs();
        assert_near(lever_arm, 19.8, 1e-9);
        let rate_share = 1.0 - 3.0 * lever_arm / SG90.stall_torque;
        assert_near(slow / fast, rate_share, 0.06);
        // Both feet of a side swing forward: the slider's arms turn alike, and its length hardly changes.
        let [slow, fast] = [joints, JOINTS].map(|joints| angles_after([1.0; 4], joints)[0]);
        let loss = 1.0 - slow / fast;
        assert!(loss < 0.4 * (1.0 - rate_share), "{slow} {fast}");
    }

    #[test]
    fn an_unloaded_servo_settles_within_its_dead_band() {
        let light_ground = ground_with(0.1, 0.001);
        let dead_band_motor = Motor {
            half_dead_band: 0.5,
            ..SG90
        };
        for (motor, max_error) in [(dead_band_motor, 0.51), (SG90, 0.02)] {
            let motors = motors_with(motor, JOINTS);
            let [angle, ..] = turn_servos(light_ground, &motors, 10.0, 1.0).servo_sweeps();
            assert_near(angle, 10.0, max_error);
        }
    }

    #[test]
    fn the_line_share_is_one_on_the_torque_speed_line_and_greater_at_a_lower_supply() {
        let motor_at_low_supply = SG90.at_supply(0.875);
        for (torque, rate, share) in [(176.5, 0.0, 1.0), (0.0, 500.0, 1.0), (88.25, 250.0, 1.0)] {
            assert_near(SG90.line_share(torque, rate), share, 1e-12);
            assert_near(
                motor_at_low_supply.line_share(torque, rate),
                share / 0.875,
                1e-12,
            );
        }
        // The rotor's inertia does not depend on the supply.
        assert_near(motor_at_low_supply.inertia(), SG90.inertia(), 1e-12);
    }

    #[test]
    fn a_turning_servo_pulls_its_leg_at_the_end_of_its_play() {
        let ground_with_play = Ground {
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
            walker.drive(targets, seconds, &motors_with(SG90, JOINTS));
            [walker.servo_sweeps(), walker.lags(), walker.leg_sweeps()].map(|angles| angles[0])
        };
        let [servo, lag, _] = turn_first_servo(10.0, 1.0);
        assert_near(servo, 10.0, 1e-6);
        assert!(lag.abs() < 1.0, "{lag}");
        // While the servo turns, the leg lags behind it by the play.
        let [servo, lag, leg] = turn_first_servo(90.0, 0.1);
        assert_near(lag, 1.0, 1e-3);
        assert_near(leg, servo - lag, 1e-12);
    }
}
