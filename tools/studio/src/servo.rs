//! Simulation of a servo with known true values: a motor that lags behind its pulses, with dead band, play and
//! friction.

use fastrand::Rng;
use lizard_video::Frame;
use lizard_video::servo_commands::{COMMAND_INTERVAL, ServoCommand, list_commands};

use crate::render::Studio;

/// Time from one pulse to the next, s.
const PULSE_INTERVAL_S: f64 = 0.02;
/// Time step of the simulation, s.
const STEP_S: f64 = 0.0005;
/// Number of pulses during a move to a pose.
const MOVE_PULSES: usize = 8;
/// The smallest error, measured from the edge of the dead band, at which the servo uses its full torque, deg.
pub const FULL_TORQUE_DEG: f64 = 3.0;
/// Dry friction of the gears, as a fraction of the stall torque.
pub const FRICTION_FRACTION: f64 = 0.02;

/// A servo in the jig of docs/measure.md, with the sheet's card on its horn.
#[derive(Clone)]
pub struct Servo {
    /// Degrees that the servo turns per commanded degree.
    pub gain: f64,
    /// Angular speed without load and friction, deg/s.
    pub no_load_rate: f64,
    /// Rotor time constant, s.
    pub rotor_time_constant: f64,
    /// Width of the dead band, commanded deg.
    pub dead_band: f64,
    /// Total free play of the horn on its shaft, deg.
    pub play: f64,
    /// Torque of the load, clockwise, as a fraction of the stall torque.
    pub load: f64,
    /// Rate of the commanded angle in a large step, deg/s.
    pub slew_rate: f64,
    /// Time of the first command, s.
    pub first_command_s: f64,
    /// Heading of the card at neutral, deg.
    pub neutral_heading: f64,
}

impl Default for Servo {
    fn default() -> Self {
        Self {
            gain: 1.0,
            no_load_rate: 500.0,
            rotor_time_constant: 0.02,
            dead_band: 1.0,
            play: 0.0,
            load: 0.0,
            slew_rate: 1000.0,
            first_command_s: 0.7,
            neutral_heading: 20.0,
        }
    }
}

impl Servo {
    /// Returns the steady speed without load but with friction, deg/s.
    pub fn steady_rate(&self) -> f64 {
        self.no_load_rate * (1.0 - FRICTION_FRACTION)
    }

    /// Returns the time at which all commands are complete, s.
    pub fn end_s(&self) -> f64 {
        self.first_command_s + COMMAND_INTERVAL * list_commands(1.0).len() as f64
    }

    /// Simulates the card's angles. The commands are counter-clockwise from neutral if `side` is 1, and clockwise if it
    /// is -1.
    pub fn simulate(&self, side: f64) -> CardAngles {
        let commands = list_commands(side);
        let pulses = self.simulate_pulses(&commands);
        let (mut angle, mut rate, mut horn_angle) = (0.0, 0.0, 0.0f64);
        let mut angles = Vec::new();
        for pulse in pulses {
            for _ in 0..(PULSE_INTERVAL_S / STEP_S).round() as usize {
                let error = pulse - angle / self.gain;
                let excess = (error.abs() - self.dead_band / 2.0).max(0.0);
                let drive =
                    (excess / FULL_TORQUE_DEG).min(1.0) * (error * self.gain).signum() - self.load;
                // Friction slows a turning motor down to a stop, and holds a motor at rest.
                let speed_error = self.no_load_rate * drive - rate;
                let friction_rate = self.no_load_rate * FRICTION_FRACTION;
                let max_change = friction_rate * STEP_S / self.rotor_time_constant;
                rate += speed_error * STEP_S / self.rotor_time_constant;
                rate -= rate.clamp(-max_change, max_change);
                angle += rate * STEP_S;
                horn_angle = horn_angle.clamp(angle - self.play / 2.0, angle + self.play / 2.0);
                angles.push(self.neutral_heading + horn_angle);
            }
        }
        CardAngles(angles)
    }

    /// Records the card on the horn and passes each frame with its time to `use_frame`. The full frame rate is used
    /// only while the card turns fast.
    pub fn record(
        &self,
        studio: &Studio,
        side: f64,
        frames_per_s: f64,
        rng: &mut Rng,
        mut use_frame: impl FnMut(f64, &Frame),
    ) {
        let card_angles = self.simulate(side);
        let background = studio.render_background(rng);
        let mut seconds = 0.0;
        while seconds < self.end_s() {
            // The servo's axis is 8 mm from the tag's centre.
            let pose_at = |time: f64| {
                let heading = card_angles.angle_at(time).to_radians();
                [8.0 * heading.cos(), 8.0 * heading.sin(), heading]
            };
            use_frame(seconds, &background.render_frame(seconds, pose_at, rng));
            let turn = card_angles.angle_at(seconds + 0.25) - card_angles.angle_at(seconds - 0.08);
            seconds += match turn.abs() > 30.0 {
                true => 1.0 / frames_per_s,
                false => 0.2,
            };
        }
    }

    /// Simulates all pulses, each as an angle in deg.
    fn simulate_pulses(&self, commands: &[ServoCommand]) -> Vec<f64> {
        let pulse_count = (self.end_s() / PULSE_INTERVAL_S) as usize + 1;
        let (mut start_pulse, mut pulse) = (0.0, 0.0);
        let mut last_index = 0;
        let pulse_at = |pulse_index: usize| {
            let seconds = pulse_index as f64 * PULSE_INTERVAL_S - self.first_command_s;
            let index = ((seconds / COMMAND_INTERVAL).max(0.0) as usize).min(commands.len() - 1);
            if index != last_index {
                (last_index, start_pulse) = (index, pulse);
            }
            let commanded = commands[index].pulse_angle();
            let is_reversal =
                index > 0 && commands[index].is_reversed != commands[index - 1].is_reversed;
            pulse = if is_reversal {
                let max_step = self.slew_rate * PULSE_INTERVAL_S;
                pulse + (commanded - pulse).clamp(-max_step, max_step)
            } else {
                let move_seconds = seconds - COMMAND_INTERVAL * index as f64;
                let fraction = move_seconds / (MOVE_PULSES as f64 * PULSE_INTERVAL_S);
                let fraction = fraction.clamp(0.0, 1.0);
                start_pulse
                    + (commanded - start_pulse) * fraction * fraction * (3.0 - 2.0 * fraction)
            };
            pulse
        };
        (0..pulse_count).map(pulse_at).collect()
    }
}

/// The angles of a card, deg, at every `STEP_S` from time 0.
pub struct CardAngles(Vec<f64>);

impl CardAngles {
    /// Returns the angle at a time, deg.
    pub fn angle_at(&self, seconds: f64) -> f64 {
        let index = (seconds / STEP_S).max(0.0) as usize;
        self.0[index.min(self.0.len() - 1)]
    }
}
