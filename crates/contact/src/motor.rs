//! A servo's motor: its torque falls as it turns faster, and its rotor takes time to spin up.
//!
//! A DC motor on a supply has a line: full torque at stall, none at its no-load speed. Below
//! its limit a servo applies torque in proportion to its error. Its rotor, seen through
//! hundreds to one of gears, is far harder to turn than a leg, so rotor and friction alone decide
//! how well the servo follows its pulses.
//!
//! In a short step of time all of this is one convex function of the error at the end of the
//! step: the motor's torque, its damping and its rotor's change of speed are the slopes of it.
//! So the contact problem of `friction.rs` takes a servo as it takes a spring.

use crate::joints::Joints;

/// A servo's motor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motor {
    /// Stall torque, N mm.
    pub stall: f64,
    /// No-load speed, deg/s.
    pub rate: f64,
    /// Time constant of the rotor without load, s.
    pub spin_up: f64,
    /// Error beyond the dead band at which the full torque is applied, deg.
    pub full: f64,
    /// Error within which no torque is applied, deg: half the dead band.
    pub idle: f64,
}

impl Motor {
    /// Returns the same motor on another supply, given as a share of its own.
    pub fn at_supply(&self, share: f64) -> Self {
        Self {
            stall: self.stall * share,
            rate: self.rate * share,
            ..*self
        }
    }

    /// Torque that the motor loses for each rad/s by its back EMF, N mm s.
    pub fn damping(&self) -> f64 {
        self.stall / self.rate.to_radians()
    }

    /// Inertia of the rotor through the gears, N mm s^2.
    pub fn inertia(&self) -> f64 {
        self.damping() * self.spin_up
    }

    /// The share of the motor's line that a torque (N mm) at a rate (deg/s) uses: 1 on the line
    /// itself, negative where the motor brakes.
    pub fn line_share(&self, torque: f64, rate: f64) -> f64 {
        torque / self.stall + rate / self.rate
    }
}

/// The motors of the four servos, and the friction of pins and sliders, which they turn besides the
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
    /// The time step of the simulation of the motors, s: a light rotor with a high gain swings
    /// fast, and a long step would damp it.
    pub(crate) fn step(&self) -> f64 {
        let swing = |motor: &Motor| match motor.spin_up > 0.0 {
            true => (motor.full / motor.rate * motor.spin_up).sqrt(),
            // Without a rotor nothing swings.
            false => f64::INFINITY,
        };
        let swings = self.each.iter().map(|motor| STEP_PER_RADIAN * swing(motor));
        swings.fold(MAX_STEP, f64::min)
    }

    /// The speed of a slider, mm/s, below which its friction fades so that in a step of time it
    /// cannot turn a servo back.
    pub(crate) fn fade_speed(&self, seconds: f64) -> f64 {
        let arm = |[x, y]: [f64; 2]| x * x + y * y;
        let square = self.joints.arms.map(arm).into_iter().fold(0.0, f64::max);
        let resistance = |motor: &Motor| motor.inertia() + motor.damping() * seconds;
        let smallest = self
            .each
            .iter()
            .map(resistance)
            .fold(f64::INFINITY, f64::min);
        2.0 * self.joints.slider * square * seconds / smallest
    }
}

/// The motion of a servo at the beginning of a step, in rad and rad/s.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ServoState {
    /// Angle that the pulse asks for.
    pub target: f64,
    /// Angle of the servo.
    pub servo: f64,
    /// Rate of the servo.
    pub rate: f64,
}

/// The value, slope and curvature of an energy.
pub(crate) type Expansion = (f64, f64, f64);

/// The energy of a motor in a short time step, as a function of the servo's place: the angle, rad,
/// by which it is behind a reference, the angle that it would have at an unchanged rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MotorStep {
    /// Target ahead of the reference, rad.
    ahead: f64,
    /// Half the dead band: the error up to which there is no torque, rad.
    idle: f64,
    /// Error beyond the dead band at which the torque is full, rad.
    full: f64,
    /// Torque at stall.
    stall: f64,
    /// Stiffness that the rotor's inertia and the damping have in a step of this length.
    inertial_stiffness: f64,
    /// Place to which inertia and damping alone would lead, rad.
    unloaded: f64,
    /// Place of a servo that does not turn in this step, rad.
    unmoved: f64,
    /// Torque of dry friction.
    drag: f64,
    /// Torque of the slider on the servo.
    slider: f64,
}

impl MotorStep {
    /// Describes a step of `seconds`. `drag` and `slider` are the torques of dry friction and of
    /// the slider, N mm; the unit of all forces inside is `force` N.
    pub fn new(
        motor: &Motor,
        turn: ServoState,
        seconds: f64,
        [drag, slider]: [f64; 2],
        force: f64,
    ) -> Self {
        let inertia = motor.inertia() / (seconds * seconds);
        let inertial_stiffness = inertia + motor.damping() / seconds;
        let unloaded_turn = turn.rate * seconds;
        Self {
            ahead: turn.target - turn.servo - unloaded_turn,
            idle: motor.idle.to_radians(),
            full: motor.full.to_radians(),
            stall: motor.stall / force,
            inertial_stiffness: inertial_stiffness / force,
            unloaded: unloaded_turn * (1.0 - inertia / inertial_stiffness),
            unmoved: unloaded_turn,
            drag: drag / force,
            slider: slider / force,
        }
    }

    /// Energy at a place, its slope and its curvature, with the kink of dry friction rounded off
    /// within `eps` rad.
    pub fn expand(&self, place: f64, eps: f64) -> Expansion {
        let error = self.ahead + place;
        let excess = (error.abs() - self.idle).max(0.0);
        let gain = self.stall / self.full;
        let (energy, torque, stiffness) = match excess < self.full {
            true if excess > 0.0 => (gain * excess * excess / 2.0, gain * excess, gain),
            true => (0.0, 0.0, 0.0),
            false => (self.stall * (excess - self.full / 2.0), self.stall, 0.0),
        };
        let deviation = place - self.unloaded;
        let from_still = place - self.unmoved;
        let length = (from_still * from_still + eps * eps).sqrt();
        let (direction, curvature) = match length > 0.0 {
            true => (from_still / length, eps * eps / (length * length * length)),
            false => (0.0, 0.0),
        };
        (
            energy
                + self.inertial_stiffness * deviation * deviation / 2.0
                + self.drag * length
                + self.slider * place,
            torque.copysign(error)
                + self.inertial_stiffness * deviation
                + self.drag * direction
                + self.slider,
            stiffness + self.inertial_stiffness + self.drag * curvature,
        )
    }

    /// Place at the end of the step without a load, to the first order, rad.
    pub fn unloaded_end(&self) -> f64 {
        -self.expand(0.0, 0.0).1 / self.inertial_stiffness
    }

    /// The place at which the motor's torque equals the load's. `slope` gives the load's torque
    /// and stiffness at a place; the torque is at most `max`, and changes fast at the `kinks`.
    pub fn balance(
        &self,
        kinks: [f64; 2],
        max: f64,
        eps: f64,
        slope: impl Fn(f64) -> (f64, f64),
    ) -> f64 {
        let reach = (self.stall + self.drag + self.slider.abs() + max) / self.inertial_stiffness;
        let (mut low, mut high) = (self.unloaded - reach, self.unloaded + reach);
        let guess = self.unloaded_end().max(kinks[0]).min(kinks[1]);
        let mut place = guess.max(low).min(high);
        let mut longest = reach;
        for _ in 0..MAX_ITERATIONS {
            let (_, torque, stiffness) = self.expand(place, eps);
            let (load, load_stiffness) = slope(place);
            let error = torque - load;
            match error > 0.0 {
                true => high = place,
                false => low = place,
            }
            let newton = place - error / (stiffness + load_stiffness);
            let far = (newton - place).abs();
            if far <= f64::EPSILON * (reach + place.abs()) {
                return newton;
            }
            // Newton's steps shrink, unless a kink lies in between.
            let is_between = |place: &f64| low < *place && *place < high;
            let next = match is_between(&newton) && far <= longest {
                true => newton,
                false => {
                    let kink = kinks.into_iter().find(is_between);
                    kink.unwrap_or(f64::midpoint(low, high))
                }
            };
            longest = (next - place).abs();
            place = next;
        }
        place
    }
}

/// Iterations of a balance at most: as many as bisection alone would need.
const MAX_ITERATIONS: usize = 60;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drive::{Drive, Kind};
    use crate::feet::{Body, Feet};
    use crate::ground::Ground;
    use crate::stance::Stance;
    use crate::walker::Walker;

    const SG90: Motor = Motor {
        stall: 176.5,
        rate: 500.0,
        spin_up: 0.02,
        full: 3.0,
        idle: 0.0,
    };

    const JOINTS: Joints = Joints {
        drag: 0.0,
        slider: 0.0,
        arms: [[-22.5, 19.8], [-22.5, -19.8], [22.5, -19.8], [22.5, 19.8]],
        base: 135.0,
    };

    /// A robot of this mass on a floor; a light one hardly holds its servos.
    fn ground(mass: f64, friction: f64) -> Ground {
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

    fn motors(motor: Motor, joints: Joints) -> Motors {
        Motors {
            each: [motor; 4],
            joints,
        }
    }

    /// Lets all servos turn from 0 towards `target` deg for some seconds.
    fn turned(ground: Ground, motors: &Motors, target: f64, seconds: f64) -> Walker {
        let mut walker = Walker::new(ground, [0.0; 4]);
        walker.drive([Some(target); 4], seconds, motors);
        walker
    }

    #[test]
    fn without_a_load_it_spins_up_as_a_motor_with_a_rotor_does() {
        let free = ground(0.1, 0.001);
        for seconds in [0.02, 0.04, 0.1] {
            let walker = turned(free, &motors(SG90, JOINTS), 1000.0, seconds);
            // The solution of J w' = stall - b w from rest.
            let Motor { rate, spin_up, .. } = SG90;
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
        let heavy = ground(800.0, 1.0);
        let quick = Motor {
            spin_up: 0.001,
            ..SG90
        };
        let mut walker = Walker::new(heavy, [0.0; 4]);
        let targets = [Some(8.0), Some(8.0), Some(-8.0), Some(-8.0)].map(|at| at.map(|x| 1e3 * x));
        walker.drive(targets, 0.02, &motors(quick, JOINTS));
        let torque = heavy.grip() * heavy.feet.reach;
        let rate = SG90.rate * (1.0 - torque / SG90.stall);
        let mean = walker.servos().map(f64::abs).iter().sum::<f64>() / 4.0 / 0.02;
        assert!((mean / rate - 1.0).abs() < 0.1, "{mean} {rate}");
    }

    #[test]
    fn dry_friction_of_the_joints_is_a_load_and_may_hold_a_servo() {
        let free = ground(0.1, 0.001);
        let drag = |drag| Joints { drag, ..JOINTS };
        let after = |joints| turned(free, &motors(SG90, joints), 1000.0, 0.4).servos()[0];
        let half = after(drag(SG90.stall / 2.0)) / after(JOINTS);
        assert!((half - 0.5).abs() < 0.03, "{half}");
        assert!(after(drag(1.01 * SG90.stall)).abs() < 1e-6);
    }

    #[test]
    fn a_slider_resists_only_servos_that_change_its_length() {
        let free = ground(0.1, 0.001);
        let joints = Joints {
            slider: 3.0,
            ..JOINTS
        };
        let angles_after = |targets: [f64; 4], joints| {
            let mut walker = Walker::new(free, [0.0; 4]);
            walker.drive(
                targets.map(|at| Some(1000.0 * at)),
                0.04,
                &motors(SG90, joints),
            );
            walker.servos()
        };
        let alone = [1.0, 0.0, 0.0, 0.0];
        let [slow, fast] = [joints, JOINTS].map(|joints| angles_after(alone, joints)[0]);
        let lever = JOINTS.levers([0.0; 4])[0].abs();
        assert!((lever - 19.8).abs() < 1e-9, "{lever}");
        let share = 1.0 - 3.0 * lever / SG90.stall;
        assert!((slow / fast - share).abs() < 0.06, "{slow} {fast} {share}");
        // Both feet of a side forward: the arms turn alike, and its length hardly changes.
        let [slow, fast] = [joints, JOINTS].map(|joints| angles_after([1.0; 4], joints)[0]);
        assert!(1.0 - slow / fast < 0.4 * (1.0 - share), "{slow} {fast}");
    }

    #[test]
    fn a_servo_settles_where_its_gain_bears_the_load_and_keeps_its_dead_band() {
        let free = ground(0.1, 0.001);
        let banded = Motor { idle: 0.5, ..SG90 };
        let angle = turned(free, &motors(banded, JOINTS), 10.0, 1.0).servos()[0];
        assert!((9.49..10.51).contains(&angle), "{angle}");
        let angle = turned(free, &motors(SG90, JOINTS), 10.0, 1.0).servos()[0];
        assert!((angle - 10.0).abs() < 0.02, "{angle}");
    }

    #[test]
    fn the_share_of_the_line_is_one_at_stall_and_at_the_no_load_speed() {
        let low = SG90.at_supply(0.875);
        for (torque, rate, supply) in [(176.5, 0.0, 1.0), (0.0, 500.0, 1.0), (88.25, 250.0, 1.0)] {
            assert!((SG90.line_share(torque, rate) - supply).abs() < 1e-12);
            assert!((low.line_share(torque, rate) - supply / 0.875).abs() < 1e-12);
        }
        assert!(
            (low.inertia() - SG90.inertia()).abs() < 1e-12,
            "the rotor stays"
        );
    }

    #[test]
    fn a_servo_drags_its_leg_at_the_end_of_its_play() {
        let floor = Ground {
            drive: Drive {
                kind: Kind::Rigid,
                play: 1.0,
            },
            ..ground(400.0, 0.7)
        };
        let mut walker = Walker::new(floor, [0.0; 4]);
        walker.drive(
            [Some(10.0), Some(0.0), Some(0.0), Some(0.0)],
            1.0,
            &motors(SG90, JOINTS),
        );
        let (servo, lag) = (walker.servos()[0], walker.lag()[0]);
        // On its way the servo drags the leg at the end of its play; at its end nothing pulls.
        assert!(
            (servo - 10.0).abs() < 1e-6 && lag.abs() < 1.0,
            "{servo} {lag}"
        );
        let mut walker = Walker::new(floor, [0.0; 4]);
        walker.drive(
            [Some(90.0), Some(0.0), Some(0.0), Some(0.0)],
            0.1,
            &motors(SG90, JOINTS),
        );
        assert!((walker.lag()[0] - 1.0).abs() < 1e-3, "{:?}", walker.lag());
        assert!((walker.legs()[0] - (walker.servos()[0] - walker.lag()[0])).abs() < 1e-12);
    }

    #[test]
    fn the_energy_of_a_step_has_its_torque_as_slope() {
        let turn = ServoState {
            target: 0.2,
            servo: 0.05,
            rate: 3.0,
        };
        let motor_step = MotorStep::new(&SG90, turn, 0.0025, [12.0, -4.0], 0.7);
        for step in -40..40 {
            let place = f64::from(step) / 200.0 + 1e-4;
            let expanded_at = |place: f64| motor_step.expand(place, 1e-3);
            let (before, after) = (expanded_at(place - 1e-6), expanded_at(place + 1e-6));
            let (_, torque, stiffness) = expanded_at(place);
            let slope = (after.0 - before.0) / 2e-6;
            assert!(
                (slope - torque).abs() < 1e-3 * torque.abs().max(1.0),
                "{place}"
            );
            let bend = (after.1 - before.1) / 2e-6;
            assert!(
                (bend / stiffness - 1.0).abs() < 1e-2,
                "{place} {bend} {stiffness}"
            );
        }
    }
}
