//! A gait as the four bars of a gait diagram: one for each leg, from the start to the end of its stance. The page edits
//! gaits in this form, and `lizard tune` varies them.

use crate::config::servo::LEG_NAMES;
use crate::file::edit::to_key;
use crate::gaits::gait::Gait;
use crate::gaits::waveform::Waveform;

/// A gait whose legs have one waveform; each leg has its own start and gain.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Bars {
    /// Name of the gait in robot.toml.
    pub name: String,
    /// True if the legs have a common stance, then swing one after the other and hold in between; false if all legs
    /// always move.
    pub held: bool,
    /// Duration of a cycle at full speed, s.
    pub period: f64,
    /// The duty factor: the stance's fraction of the cycle; unused if the legs hold.
    pub duty: f64,
    /// Largest sweep of a leg, deg.
    pub amplitude: f64,
    /// Phase at which each stance starts, 0 to 1, in servo order: LF, RF, RH, LH. If the legs hold, only the order of
    /// the phases matters: it is the order of the swings.
    pub start: [f64; 4],
    /// Each leg's amplitude relative to `amplitude`; negative if the leg moves opposite to the others.
    pub gain: [f64; 4],
}

impl Bars {
    /// Converts a gait to bars; `None` if a leg stands still or follows a path. A gait marked as reversed
    /// becomes bars of the same movement, without the mark.
    pub(crate) fn from_gait(gait: &Gait) -> Option<Self> {
        let amplitudes = gait.strides.each_ref().map(|stride| stride.amplitude);
        let amplitude = amplitudes.map(f64::abs).into_iter().fold(0.0, f64::max);
        let mut bars = Self {
            name: gait.name.clone(),
            held: false,
            period: gait.period,
            duty: 0.75,
            amplitude,
            start: [0.0; 4],
            gain: amplitudes.map(|leg_amplitude| leg_amplitude / amplitude),
        };
        for (start, stride) in bars.start.iter_mut().zip(&gait.strides) {
            match stride.waveform {
                Waveform::Wave { duty } => {
                    bars.duty = duty;
                    *start = stride.start;
                }
                Waveform::Held { swing_index } => {
                    bars.held = true;
                    *start = swing_index as f64 / 4.0;
                }
                _ => return None,
            }
        }
        Some(match gait.is_reversed {
            true => bars.reversed(),
            false => bars,
        })
    }

    /// Returns the gait reversed in time: a gait that walks forward becomes one that walks backward.
    ///
    /// A wave's stance and swing are each point-symmetric about their middle. A wave played backwards is therefore the
    /// negated wave, whose stance starts where the original stance ends. A held gait played backwards is the negated
    /// gait with the opposite order of legs; all four legs are shifted in time equally, which makes no difference.
    pub fn reversed(&self) -> Self {
        let reversed_start = |leg: usize| match self.held {
            true => 1.0 - self.start[leg],
            false => (-self.start[leg] - self.duty).rem_euclid(1.0),
        };
        let mut reversed = Self {
            start: std::array::from_fn(reversed_start),
            gain: self.gain.map(|gain| -gain),
            ..self.clone()
        };
        if self.held {
            // The first leg in the order starts at 0.
            let first_start = reversed.start.into_iter().fold(f64::MAX, f64::min);
            reversed.start = reversed.start.map(|start| start - first_start);
        }
        reversed
    }

    /// Returns the gait as a table for robot.toml, with numbers rounded to thousandths.
    pub fn to_toml(&self) -> String {
        let format_legs = |values: [f64; 4]| {
            let entries = LEG_NAMES.iter().zip(values);
            let entries =
                entries.map(|(leg, value)| format!("{leg} = {:?}", round_to_thousandths(value)));
            format!("{{ {} }}", entries.collect::<Vec<_>>().join(", "))
        };
        let [period, amplitude] = [self.period, self.amplitude].map(round_to_thousandths);
        let waveform = if self.held {
            let mut order = [0, 1, 2, 3];
            order.sort_by(|a, b| self.start[*a].total_cmp(&self.start[*b]));
            let order = order
                .map(|leg| format!("\"{}\"", LEG_NAMES[leg]))
                .join(", ");
            format!("waveform = \"held\"\namplitude = {amplitude:?}\norder = [{order}]\n")
        } else {
            let duty = round_to_thousandths(self.duty);
            let start = format_legs(self.start.map(|start| round_to_thousandths(start) % 1.0));
            format!(
                "waveform = \"wave\"\nduty = {duty:?}\namplitude = {amplitude:?}\nstart = {start}\n"
            )
        };
        let gain = match self.gain.iter().all(|gain| (gain - 1.0).abs() <= 1e-9) {
            true => String::new(),
            false => format!("gain = {}\n", format_legs(self.gain)),
        };
        let name = to_key(&self.name);
        format!("[gait.{name}]\nperiod = {period:?}\n{waveform}{gain}")
    }
}

/// Rounds a value to thousandths.
fn round_to_thousandths(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}
