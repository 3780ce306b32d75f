//! A servo's motor: its torque falls as it turns faster, and its rotor takes time to spin up.
//!
//! The torque of a DC motor on a supply falls in a straight line, from full torque at stall to none at the
//! no-load speed. Below its limit a servo applies torque in proportion to its error. Seen through gears with a
//! ratio of several hundred, its rotor is far harder to turn than a leg, so only rotor and friction decide how
//! well the servo follows its pulses.

use crate::joints::Joints;

/// A servo's motor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motor {
    /// Stall torque, N mm.
    pub stall: f64,
    /// No-load speed, deg/s.
    pub no_load_speed: f64,
    /// Time constant of the rotor without load, s.
    pub spin_up: f64,
    /// Error beyond the dead band at which the full torque is applied, deg.
    pub full_torque_error: f64,
    /// Error within which no torque is applied, deg: half the dead band.
    pub half_dead_band: f64,
}

impl Motor {
    /// Returns this motor at another supply voltage, given as a share of its present one.
    pub fn at_supply(&self, share: f64) -> Self {
        Self {
            stall: self.stall * share,
            no_load_speed: self.no_load_speed * share,
            ..*self
        }
    }

    /// Torque that the motor loses for each rad/s by its back EMF, N mm s.
    pub fn damping(&self) -> f64 {
        self.stall / self.no_load_speed.to_radians()
    }

    /// Inertia of the rotor through the gears, N mm s^2.
    pub fn inertia(&self) -> f64 {
        self.damping() * self.spin_up
    }

    /// The share of the motor's torque-speed line that a torque (N mm) at a rate (deg/s) uses: 1 on the line
    /// itself, negative while the motor brakes.
    pub fn line_share(&self, torque: f64, rate: f64) -> f64 {
        torque / self.stall + rate / self.no_load_speed
    }
}

/// The motors of the four servos, and the friction of pins and sliders, which loads them in addition to the
/// feet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motors {
    /// The motors in servo order.
    pub each: [Motor; 4],
    /// Friction of pins and sliders.
    pub joints: Joints,
}

/// Longest time step, s.
const MAX_STEP: f64 = 0.0025;
/// Time step relative to the time in which the vibration of a servo advances by one radian.
const STEP_PER_RADIAN: f64 = 0.25;

impl Motors {
    /// The time step of the simulation of the motors, s: a light rotor with a high gain vibrates fast, and a
    /// long step would damp it.
    pub(crate) fn step(&self) -> f64 {
        let radian_time_of = |motor: &Motor| match motor.spin_up > 0.0 {
            true => (motor.full_torque_error / motor.no_load_speed * motor.spin_up).sqrt(),
            // Without a rotor nothing vibrates.
            false => f64::INFINITY,
        };
        let steps = self
            .each
            .iter()
            .map(|motor| STEP_PER_RADIAN * radian_time_of(motor));
        steps.fold(MAX_STEP, f64::min)
    }

    /// The speed of a slider, mm/s, below which its friction falls in proportion to the speed. So the friction
    /// cannot turn a servo back within a time step.
    pub(crate) fn fade_speed(&self, seconds: f64) -> f64 {
        let square_of = |[x, y]: [f64; 2]| x * x + y * y;
        let arm_square = self
            .joints
            .arms
            .map(square_of)
            .into_iter()
            .fold(0.0, f64::max);
        let resistance_of = |motor: &Motor| motor.inertia() + motor.damping() * seconds;
        let min_resistance = self
            .each
            .iter()
            .map(resistance_of)
            .fold(f64::INFINITY, f64::min);
        2.0 * self.joints.slider * arm_square * seconds / min_resistance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drive::{Drive, DriveKind};
    use crate::feet::{Body, Feet};
    use crate::ground::Ground;
    use crate::stance::Stance;
    use crate::walker::Walker;

    const SG90: Motor = Motor {
        stall: 176.5,
        no_load_speed: 500.0,
        spin_up: 0.02,
        full_torque_error: 3.0,
        half_dead_band: 0.0,
    };

    const JOINTS: Joints = Joints {
        drag: 0.0,
        slider: 0.0,
        arms: [[-22.5, 19.8], [-22.5, -19.8], [22.5, -19.8], [22.5, 19.8]],
        base: 135.0,
    };

    /// A robot of this mass (g) on a floor; the feet of a light one hardly load its servos.
    fn ground_with(mass: f64, friction: f64) -> Ground {
        Ground {
            feet: Feet {
                hip_forward: 55.0,
                hip_side: [35.0; 2],
                mount: 0.0,
                reach: 45.0,
            },
            body: Body {
                mass,
                ..Body::DEFAULT
            },
            stance: Stance::LEVEL,
            friction,
            ratio: 1.0,
            drive: Drive::RIGID,
        }
    }

    fn motors_with(motor: Motor, joints: Joints) -> Motors {
        Motors {
            each: [motor; 4],
            joints,
        }
    }

    /// Lets all servos turn from 0 towards `target` deg for some seconds.
    fn turn_servos(ground: Ground, motors: &Motors, target: f64, seconds: f64) -> Walker {
        let mut walker = Walker::new(ground, [0.0; 4]);
        walker.drive([Some(target); 4], seconds, motors);
        walker
    }

    #[test]
    fn without_a_load_it_spins_up_as_a_motor_with_a_rotor_does() {
        let light_ground = ground_with(0.1, 0.001);
        for seconds in [0.02, 0.04, 0.1] {
            let walker = turn_servos(light_ground, &motors_with(SG90, JOINTS), 1000.0, seconds);
            // The solution of J w' = stall - b w from rest.
            let Motor {
                no_load_speed: rate,
                spin_up,
                ..
            } = SG90;
            let exact = rate * (seconds - spin_up * (1.0 - (-seconds / spin_up).exp()));
            for sweep in walker.servos() {
                assert!(
                    (sweep / exact - 1.0).abs() < 0.12,
                    "{seconds} {sweep} {exact}"
                );
            }
        }
    }

    #[test]
    fn the_load_of_a_pad_that_slides_takes_its_share_of_the_rate() {
        // Two legs that swing against the two others: each pad slides, and drags at its leg.
        let heavy_ground = ground_with(800.0, 1.0);
        let quick_motor = Motor {
            spin_up: 0.001,
            ..SG90
        };
        let mut walker = Walker::new(heavy_ground, [0.0; 4]);
        let targets =
            [Some(8.0), Some(8.0), Some(-8.0), Some(-8.0)].map(|target| target.map(|x| 1e3 * x));
        let mut angle_after = || {
            walker.drive(targets, 0.02, &motors_with(quick_motor, JOINTS));
            walker.servos().map(f64::abs).iter().sum::<f64>() / 4.0
        };
        // The first 20 ms, in which rotor and legs speed up, are left out.
        let mean_rate = (-angle_after() + angle_after()) / 0.02;
        let torque = heavy_ground.grip() * heavy_ground.feet.reach;
        let rate = SG90.no_load_speed * (1.0 - torque / SG90.stall);
        assert!((mean_rate / rate - 1.0).abs() < 0.1, "{mean_rate} {rate}");
    }

    #[test]
    fn on_ice_legs_that_swing_forward_push_the_body_back_by_their_share_of_the_mass() {
        let ice = ground_with(435.0, 1e-4);
        let walker = turn_servos(ice, &motors_with(SG90, JOINTS), 20.0, 0.5);
        let leg_travel =
            ice.feet.positions(walker.legs())[0][0] - ice.feet.positions([0.0; 4])[0][0];
        assert!(leg_travel > 15.0, "{leg_travel}");
        let share = 4.0 * ice.body.leg_mass() / ice.body.mass;
        let body_travel = walker.place().travel().forward;
        assert!(
            (body_travel + share * leg_travel).abs() < 0.02,
            "{body_travel} {leg_travel}"
        );
    }

    #[test]
    fn dry_friction_of_the_joints_is_a_load_and_may_hold_a_servo() {
        let light_ground = ground_with(0.1, 0.001);
        let joints_with_drag = |drag| Joints { drag, ..JOINTS };
        let angle_after =
            |joints| turn_servos(light_ground, &motors_with(SG90, joints), 1000.0, 0.4).servos()[0];
        let rate_ratio = angle_after(joints_with_drag(SG90.stall / 2.0)) / angle_after(JOINTS);
        assert!((rate_ratio - 0.5).abs() < 0.03, "{rate_ratio}");
        assert!(angle_after(joints_with_drag(1.01 * SG90.stall)).abs() < 1e-6);
    }

    #[test]
    fn a_slider_resists_only_servos_that_change_its_length() {
        let light_ground = ground_with(0.1, 0.001);
        let joints = Joints {
            slider: 3.0,
            ..JOINTS
        };
        let angles_after = |targets: [f64; 4], joints| {
            let mut walker = Walker::new(light_ground, [0.0; 4]);
            walker.drive(
                targets.map(|direction| Some(1000.0 * direction)),
                0.04,
                &motors_with(SG90, joints),
            );
            walker.servos()
        };
        let one_leg = [1.0, 0.0, 0.0, 0.0];
        let [slow, fast] = [joints, JOINTS].map(|joints| angles_after(one_leg, joints)[0]);
        let lever = JOINTS.levers([0.0; 4])[0].abs();
        assert!((lever - 19.8).abs() < 1e-9, "{lever}");
        let share = 1.0 - 3.0 * lever / SG90.stall;
        assert!((slow / fast - share).abs() < 0.06, "{slow} {fast} {share}");
        // Both feet of a side swing forward: the slider's arms turn alike, and its length hardly changes.
        let [slow, fast] = [joints, JOINTS].map(|joints| angles_after([1.0; 4], joints)[0]);
        assert!(1.0 - slow / fast < 0.4 * (1.0 - share), "{slow} {fast}");
    }

    #[test]
    fn a_servo_settles_where_its_gain_bears_the_load_and_keeps_its_dead_band() {
        let light_ground = ground_with(0.1, 0.001);
        let banded_motor = Motor {
            half_dead_band: 0.5,
            ..SG90
        };
        let angle =
            turn_servos(light_ground, &motors_with(banded_motor, JOINTS), 10.0, 1.0).servos()[0];
        assert!((9.49..10.51).contains(&angle), "{angle}");
        let angle = turn_servos(light_ground, &motors_with(SG90, JOINTS), 10.0, 1.0).servos()[0];
        assert!((angle - 10.0).abs() < 0.02, "{angle}");
    }

    #[test]
    fn the_share_of_the_line_is_one_at_stall_and_at_the_no_load_speed() {
        let low_supply = SG90.at_supply(0.875);
        for (torque, rate, share) in [(176.5, 0.0, 1.0), (0.0, 500.0, 1.0), (88.25, 250.0, 1.0)] {
            assert!((SG90.line_share(torque, rate) - share).abs() < 1e-12);
            assert!((low_supply.line_share(torque, rate) - share / 0.875).abs() < 1e-12);
        }
        assert!(
            (low_supply.inertia() - SG90.inertia()).abs() < 1e-12,
            "the rotor stays"
        );
    }

    #[test]
    fn a_servo_drags_its_leg_at_the_end_of_its_play() {
        let floor = Ground {
            drive: Drive {
                kind: DriveKind::Rigid,
                play: 1.0,
            },
            ..ground_with(400.0, 0.7)
        };
        let mut walker = Walker::new(floor, [0.0; 4]);
        walker.drive(
            [Some(10.0), Some(0.0), Some(0.0), Some(0.0)],
            1.0,
            &motors_with(SG90, JOINTS),
        );
        let (servo, lag) = (walker.servos()[0], walker.lag()[0]);
        // While it turns, the servo drags the leg at the end of its play; at its target nothing pulls.
        assert!(
            (servo - 10.0).abs() < 1e-6 && lag.abs() < 1.0,
            "{servo} {lag}"
        );
        let mut walker = Walker::new(floor, [0.0; 4]);
        walker.drive(
            [Some(90.0), Some(0.0), Some(0.0), Some(0.0)],
            0.1,
            &motors_with(SG90, JOINTS),
        );
        assert!((walker.lag()[0] - 1.0).abs() < 1e-3, "{:?}", walker.lag());
        assert!((walker.legs()[0] - (walker.servos()[0] - walker.lag()[0])).abs() < 1e-12);
    }
}
