//! The servos' effort in a gait: their torque and speed relative to the torque-speed lines of their motors.
//!
//! A motor's torque-speed line runs from its stall torque to its no-load speed. The utilisation of the line is torque /
//! stall torque + speed / no-load speed, which is also the fraction of the supply voltage that the motor needs. Above 1
//! the servo falls behind its pulses. Friction of pads, pins and sliders takes the same torque at any pace; the rotor's
//! inertia takes less at a lower pace.

use lizard_contact::{GroundContact, Motor, Motors, Walker};

use crate::checks::checked_gait::CheckedGait;

/// Duration of a simulation step, s.
const STEP_SECONDS: f64 = 0.0025;
/// Largest number of steps before the measured cycle, in which pads and springs forget the start.
const MAX_LEAD_IN_STEPS: usize = 1600;
/// Utilisation above which a servo has little reserve: play, cold gears or a thin wire may use up the reserve.
pub const HIGH_UTILISATION: f64 = 0.9;
/// Factor that raises a motor's torque and speed so that the servo follows every gait exactly.
const STRONG_FACTOR: f64 = 1e6;
/// Bisection steps of the search for the highest pace.
const BISECTION_STEPS: usize = 20;

/// The torques and the speed of a servo at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Sample {
    /// Torque for pads, joints and body, N mm.
    load_torque: f64,
    /// Torque that accelerates the rotor, N mm.
    rotor_torque: f64,
    /// Speed, deg/s.
    speed: f64,
}

/// The effort of the servos over a cycle of a gait.
#[derive(Debug, Clone, PartialEq)]
pub struct Effort {
    /// For each servo, its motor as passed to [`Effort::simulate`], and its samples at the gait's nominal pace.
    servos: [(Motor, Vec<Sample>); 4],
}

impl Effort {
    /// Simulates a gait on this ground with servos that follow the gait exactly, and measures their effort.
    #[must_use]
    pub fn simulate(gait: &CheckedGait, ground: &GroundContact, motors: &Motors) -> Self {
        let mut servos = motors.per_servo.map(|motor| (motor, Vec::new()));
        if !gait.has_movement() {
            return Self { servos };
        }
        // The motors keep their gain and damping but have no limits; the rotor's torque is added afterwards.
        let strong_motors = Motors {
            per_servo: motors.per_servo.map(|motor| Motor {
                stall_torque: motor.stall_torque * STRONG_FACTOR,
                no_load_speed: motor.no_load_speed * STRONG_FACTOR,
                full_torque_error: motor.full_torque_error * STRONG_FACTOR,
                rotor_time_constant: 0.0,
                half_dead_band: 0.0,
            }),
            ..*motors
        };
        let step_count = (gait.period() / STEP_SECONDS).round();
        let step_seconds = gait.period() / step_count;
        let sweeps_at = |step: f64| gait.sweeps(gait.phase_at(step * step_seconds));
        let step_count = step_count as usize;
        let start_step = step_count.saturating_sub(MAX_LEAD_IN_STEPS);
        let mut walker = Walker::new(*ground, sweeps_at(start_step as f64));
        for step in start_step + 1..=2 * step_count {
            let previous_sweeps = walker.servo_sweeps();
            let target = sweeps_at(step as f64);
            walker.run_motors(target.map(Some), step_seconds, &strong_motors);
            if step <= step_count {
                continue;
            }
            let (previous_target, next_target) =
                (sweeps_at(step as f64 - 1.0), sweeps_at(step as f64 + 1.0));
            let sweeps = walker.servo_sweeps();
            for (i, (motor, samples)) in servos.iter_mut().enumerate() {
                let speed = (sweeps[i] - previous_sweeps[i]) / step_seconds;
                let torque = motor.stall_torque / motor.full_torque_error * (target[i] - sweeps[i]);
                let second_difference =
                    (next_target[i] - 2.0 * target[i] + previous_target[i]).to_radians();
                samples.push(Sample {
                    load_torque: torque - motor.damping() * speed.to_radians(),
                    rotor_torque: motor.reflected_inertia() * second_difference
                        / (step_seconds * step_seconds),
                    speed,
                });
            }
        }
        Self { servos }
    }

    /// Computes the highest utilisation of any servo at `pace`, which is relative to the gait's nominal pace.
    /// `supply_ratio` is the supply voltage relative to the motors' voltage in [`Effort::simulate`].
    #[must_use]
    pub fn utilisation(&self, pace: f64, supply_ratio: f64) -> f64 {
        let servo_utilisation = |(motor, samples): &(Motor, Vec<Sample>)| {
            let motor = motor.with_supply_ratio(supply_ratio);
            let utilisations = samples.iter().map(|sample| {
                let torque = sample.load_torque + sample.rotor_torque * pace * pace;
                motor.utilisation(torque, sample.speed * pace).abs()
            });
            utilisations.fold(0.0, f64::max)
        };
        self.servos
            .iter()
            .map(servo_utilisation)
            .fold(0.0, f64::max)
    }

    /// Finds the highest pace, up to 1, at which no servo exceeds its torque-speed line; 0 if a servo exceeds its line
    /// at every pace. `supply_ratio` is as in [`Effort::utilisation`].
    #[must_use]
    pub fn find_max_pace(&self, supply_ratio: f64) -> f64 {
        if self.utilisation(1.0, supply_ratio) <= 1.0 {
            return 1.0;
        }
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..BISECTION_STEPS {
            let middle = f64::midpoint(low, high);
            match self.utilisation(middle, supply_ratio) <= 1.0 {
                true => low = middle,
                false => high = middle,
            }
        }
        low
    }
}
