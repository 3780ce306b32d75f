//! A simulated servo whose true values are known: a motor behind its pulses, with dead band, play and friction.

use fastrand::Rng;
use lizard_film::Picture;
use lizard_film::orders::{ORDER_INTERVAL, Order, orders};

use crate::render::Studio;

/// Duration of a frame of the firmware, s.
const FRAME: f64 = 0.02;
/// Time step of the simulation, s.
const STEP: f64 = 0.0005;
/// Frames that a move to a pose takes.
const MOVE_FRAMES: usize = 8;
/// Error beyond the dead band from which the servo uses its full torque, deg.
pub const FULL: f64 = 3.0;
/// Dry friction of the gears, as a share of the stall torque.
pub const FRICTION: f64 = 0.02;

/// A servo in the jig.
#[derive(Clone)]
pub struct Servo {
    /// Angle turned for each deg ordered.
    pub gain: f64,
    /// Rate without load or friction, deg/s.
    pub rate: f64,
    /// Time constant of the rotor, s.
    pub spin_up: f64,
    /// Width of the dead band, in ordered deg.
    pub dead_band: f64,
    /// Total free play of the horn on its shaft, deg.
    pub play: f64,
    /// Torque of the load, clockwise, as a share of the stall torque.
    pub load: f64,
    /// Rate of the pulse in a large step, deg/s.
    pub slew: f64,
    /// Time of the first order, s.
    pub begin: f64,
    /// Heading of the card at neutral, deg.
    pub neutral: f64,
}

impl Default for Servo {
    fn default() -> Self {
        Self {
            gain: 1.0,
            rate: 500.0,
            spin_up: 0.02,
            dead_band: 1.0,
            play: 0.0,
            load: 0.0,
            slew: 1000.0,
            begin: 0.7,
            neutral: 20.0,
        }
    }
}

impl Servo {
    /// The steady rate without load, reduced by friction, deg/s.
    pub fn own_rate(&self) -> f64 {
        self.rate * (1.0 - FRICTION)
    }

    /// The time at which all orders are complete, s.
    pub fn end(&self) -> f64 {
        self.begin + ORDER_INTERVAL * orders(1.0).len() as f64
    }

    /// Simulates the card's angles, deg, at `STEP` from time 0. The orders are counter-clockwise from
    /// neutral if `side` is 1, clockwise if it is -1.
    pub fn turns(&self, side: f64) -> Turning {
        let orders = orders(side);
        let pulses = self.pulses(&orders);
        let (mut angle, mut rate, mut horn) = (0.0, 0.0, 0.0f64);
        let mut angles = Vec::new();
        for pulse in pulses {
            for _ in 0..(FRAME / STEP).round() as usize {
                let error = pulse - angle / self.gain;
                let excess = (error.abs() - self.dead_band / 2.0).max(0.0);
                let drive = (excess / FULL).min(1.0) * (error * self.gain).signum() - self.load;
                // Friction slows a turning motor down to a stop, and holds a motor at rest.
                let push = self.rate * drive - rate;
                let friction_rate = self.rate * FRICTION;
                let max_change = friction_rate * STEP / self.spin_up;
                rate += push * STEP / self.spin_up;
                rate -= rate.clamp(-max_change, max_change);
                angle += rate * STEP;
                horn = horn.clamp(angle - self.play / 2.0, angle + self.play / 2.0);
                angles.push(self.neutral + horn);
            }
        }
        Turning(angles)
    }

    /// Takes pictures of the card on the horn, at the full rate only while it turns fast, and passes them on with
    /// their times.
    pub fn pictures(
        &self,
        studio: &Studio,
        side: f64,
        rate: f64,
        rng: &mut Rng,
        mut take: impl FnMut(f64, &Picture),
    ) {
        let turning = self.turns(side);
        let background = studio.background(rng);
        let mut seconds = 0.0;
        while seconds < self.end() {
            // The axis is 8 mm beside the middle of the tag.
            let spot_at = |time: f64| {
                let heading = turning.at(time).to_radians();
                [8.0 * heading.cos(), 8.0 * heading.sin(), heading]
            };
            take(seconds, &background.picture(seconds, spot_at, rng));
            let turn = turning.at(seconds + 0.25) - turning.at(seconds - 0.08);
            seconds += if turn.abs() > 30.0 { 1.0 / rate } else { 0.2 };
        }
    }

    /// The pulse in each frame, as an angle in deg.
    fn pulses(&self, orders: &[Order]) -> Vec<f64> {
        let frames = (self.end() / FRAME) as usize + 1;
        let (mut start_pulse, mut pulse) = (0.0, 0.0);
        let mut last_order = 0;
        let pulse_at = |i: usize| {
            let seconds = i as f64 * FRAME - self.begin;
            let order = ((seconds / ORDER_INTERVAL).max(0.0) as usize).min(orders.len() - 1);
            if order != last_order {
                (last_order, start_pulse) = (order, pulse);
            }
            let ordered = orders[order].pulse_angle();
            let is_flip = order > 0 && orders[order].is_reversed != orders[order - 1].is_reversed;
            pulse = if is_flip {
                let max_step = self.slew * FRAME;
                pulse + (ordered - pulse).clamp(-max_step, max_step)
            } else {
                let begin = ORDER_INTERVAL * order as f64;
                let share = ((seconds - begin) / (MOVE_FRAMES as f64 * FRAME)).clamp(0.0, 1.0);
                start_pulse + (ordered - start_pulse) * share * share * (3.0 - 2.0 * share)
            };
            pulse
        };
        (0..frames).map(pulse_at).collect()
    }
}

/// The angles of a card over time.
pub struct Turning(Vec<f64>);

impl Turning {
    /// The angle at a time, deg.
    pub fn at(&self, seconds: f64) -> f64 {
        let index = (seconds / STEP).max(0.0) as usize;
        self.0[index.min(self.0.len() - 1)]
    }
}
