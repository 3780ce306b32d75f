//! The effort of the servos in a gait: torque and rate beside the line of their motors.
//!
//! A motor's line leads from its stall torque to its no-load rate. A servo that needs a torque at a
//! rate uses torque / stall + rate / no-load rate of it; that is also the share of the supply's
//! voltage that its motor needs. Above 1 it falls behind its pulses. The pads' friction, pins and
//! sliders ask for the same torque at any pace, the rotor for less at a slower one.

use lizard_contact::{Ground, Motor, Motors, Walker};

use crate::checks::checked_gait::CheckedGait;

/// Duration of a step, s.
const STEP: f64 = 0.0025;
/// Share of the line from which a servo has little left: play, a cold gear or a wire may take it.
pub const TIGHT: f64 = 0.9;
/// A motor that many times as strong and as fast follows every gait.
const STRONG: f64 = 1e6;
/// Rounds of the search for a pace.
const ROUNDS: usize = 20;

/// The torques of a servo at a moment, and its rate.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Sample {
    /// Torque of pads, joints and body, N mm.
    load: f64,
    /// Torque that turns the rotor faster, N mm.
    rotor: f64,
    /// Rate, deg/s.
    rate: f64,
}

/// The effort of the servos over a cycle of a gait.
#[derive(Debug, Clone, PartialEq)]
pub struct Effort {
    /// The servos' motors on the supply of [`Effort::of`], and their samples at full pace.
    servos: [(Motor, Vec<Sample>); 4],
}

impl Effort {
    /// Measures a gait on this ground with servos that follow it exactly.
    #[must_use]
    pub fn of(gait: &CheckedGait, ground: &Ground, motors: &Motors) -> Self {
        let mut servos = motors.each.map(|motor| (motor, Vec::new()));
        if !gait.moves() {
            return Self { servos };
        }
        // With their own gain and damping, but without a limit; the rotor is added afterwards.
        let strong = Motors {
            each: motors.each.map(|motor| Motor {
                stall: motor.stall * STRONG,
                rate: motor.rate * STRONG,
                full: motor.full * STRONG,
                spin_up: 0.0,
                idle: 0.0,
            }),
            ..*motors
        };
        let steps = (gait.period() / STEP).round();
        let seconds = gait.period() / steps;
        let at = |step: f64| gait.sweeps(gait.phase(step * seconds));
        let mut walker = Walker::new(*ground, at(0.0));
        let steps = steps as usize;
        for step in 1..=2 * steps {
            let (before, target) = (walker.servos(), at(step as f64));
            walker.drive(target.map(Some), seconds, &strong);
            if step <= steps {
                continue;
            }
            let (last, next) = (at(step as f64 - 1.0), at(step as f64 + 1.0));
            let now = walker.servos();
            for (i, (motor, samples)) in servos.iter_mut().enumerate() {
                let rate = (now[i] - before[i]) / seconds;
                let torque = motor.stall / motor.full * (target[i] - now[i]);
                let bend = (next[i] - 2.0 * target[i] + last[i]).to_radians();
                samples.push(Sample {
                    load: torque - motor.damping() * rate.to_radians(),
                    rotor: motor.inertia() * bend / (seconds * seconds),
                    rate,
                });
            }
        }
        Self { servos }
    }

    /// The largest share of a servo's line that the gait uses at a pace (1 is its own), on a
    /// supply given as a share of that of [`Effort::of`].
    #[must_use]
    pub fn line_share(&self, pace: f64, supply: f64) -> f64 {
        let of_servo = |(motor, samples): &(Motor, Vec<Sample>)| {
            let motor = motor.at_supply(supply);
            let used = samples.iter().map(|sample| {
                let torque = sample.load + sample.rotor * pace * pace;
                motor.line_share(torque, sample.rate * pace).abs()
            });
            used.fold(0.0, f64::max)
        };
        self.servos.iter().map(of_servo).fold(0.0, f64::max)
    }

    /// The greatest pace up to the gait's own at which no servo is above its line; 0 if it is
    /// above it at any pace.
    #[must_use]
    pub fn pace(&self, supply: f64) -> f64 {
        if self.line_share(1.0, supply) <= 1.0 {
            return 1.0;
        }
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..ROUNDS {
            let middle = f64::midpoint(low, high);
            match self.line_share(middle, supply) <= 1.0 {
                true => low = middle,
                false => high = middle,
            }
        }
        low
    }

    /// The largest torque that a servo needs for pads, joints and body, N mm.
    #[must_use]
    pub fn load(&self) -> f64 {
        let all = self.servos.iter().flat_map(|(_, samples)| samples);
        all.map(|sample| sample.load.abs()).fold(0.0, f64::max)
    }
}
