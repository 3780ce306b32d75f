//! A gait that is being made: four bars on a circle, tried on a robot before it is in any file.
//!
//! Of a robot's gaits only the one that is tried is checked, so that an answer comes while a
//! person drags. What is refused comes with the nearest amplitude and the nearest period that
//! would do.

use std::fmt::Write;

use lizard_robot::servo::{LEGS, NAMES};
use lizard_robot::{CheckedGait, Robot, Waveform};
use lizard_twin::Twin;
use serde::{Deserialize, Serialize};

use crate::description::Outlook;
use crate::refused::Refused;

/// Amplitudes that are offered, in tenths of a deg.
const LEAST_AMPLITUDE: i64 = 5;
/// The longest period that is offered, in hundredths of a second.
pub(crate) const LONGEST: i64 = 1000;

/// What every robot.toml begins its gaits with.
const STAND: &str = "[gait.stand]\nperiod = 1.0\nwaveform = \"still\"\n";

/// A gait as four bars.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bars {
    /// Its name in robot.toml.
    pub name: String,
    /// Whether legs move one after the other and hold in between; else all the time.
    pub held: bool,
    /// Time of a cycle at full speed, s.
    pub period: f64,
    /// The stance's share of the cycle; of no meaning where legs hold.
    pub duty: f64,
    /// Sweep of a leg, deg.
    pub amplitude: f64,
    /// Where in the cycle each stance begins, 0 to 1, servo order: LF, RF, RH, LH. Of legs that
    /// hold only their order counts.
    pub start: [f64; 4],
    /// Each leg's share of the amplitude; negative against the others.
    pub gain: [f64; 4],
}

impl Bars {
    /// Of a gait; none of one along a path and of one that stands. One that is turned round
    /// comes as the bars that walk so.
    #[must_use]
    pub fn of(gait: &CheckedGait) -> Option<Self> {
        let strides = gait.strides();
        if !gait.moves() {
            return None;
        }
        let amplitude = strides
            .iter()
            .map(|leg| leg.amplitude.abs())
            .fold(0.0, f64::max);
        let mut bars = Self {
            name: gait.name().to_string(),
            held: false,
            period: gait.period(),
            duty: 0.75,
            amplitude,
            start: [0.0; 4],
            gain: [0.0; 4],
        };
        for (leg, stride) in strides.iter().enumerate() {
            bars.gain[leg] = stride.amplitude / amplitude;
            match stride.waveform {
                Waveform::Wave { duty } => {
                    bars.duty = duty;
                    bars.start[leg] = stride.start;
                }
                Waveform::Held { turn } => {
                    bars.held = true;
                    bars.start[leg] = turn as f64 / 4.0;
                }
                _ => return None,
            }
        }
        Some(match gait.is_reversed() {
            true => bars.turned_round(),
            false => bars,
        })
    }

    /// The gait whose time runs backwards, so that it walks back where this walks ahead.
    ///
    /// A wave's slow and fast part are each odd about their middle. So in reverse it is its own
    /// negative, which begins where this one's stance ends. A held wave in reverse is the
    /// negative of that in the opposite order; that all four begin at another time does
    /// not matter.
    #[must_use]
    pub fn turned_round(&self) -> Self {
        let start = |leg: usize| match self.held {
            true => 1.0 - self.start[leg],
            false => (-self.start[leg] - self.duty).rem_euclid(1.0),
        };
        let mut turned = Self {
            start: std::array::from_fn(start),
            gain: self.gain.map(|gain| -gain),
            ..self.clone()
        };
        if self.held {
            // As places in the order, which are quarters from 0.
            let first = turned.start.into_iter().fold(f64::MAX, f64::min);
            turned.start = turned.start.map(|start| start - first);
        }
        turned
    }

    /// The text with this gait: in place of the one of its name, or below all.
    #[must_use]
    pub fn put_into(&self, text: &str) -> String {
        put_into(text, &self.name, &self.table())
    }

    /// Its table for robot.toml.
    #[must_use]
    pub fn table(&self) -> String {
        let number = |value: f64| format!("{:?}", (value * 1000.0).round() / 1000.0);
        let legs = |values: [f64; 4]| {
            let each = LEGS.iter().zip(values);
            let each: Vec<_> = each
                .map(|(leg, value)| format!("{leg} = {}", number(value)))
                .collect();
            format!("{{ {} }}", each.join(", "))
        };
        let mut text = format!("[gait.{}]\nperiod = {}\n", self.name, number(self.period));
        if self.held {
            let mut order = [0, 1, 2, 3];
            order.sort_by(|a, b| self.start[*a].total_cmp(&self.start[*b]));
            let order = order.map(|leg| format!("\"{}\"", LEGS[leg])).join(", ");
            let _ = writeln!(
                text,
                "waveform = \"held\"\namplitude = {}\norder = [{order}]",
                number(self.amplitude)
            );
        } else {
            let _ = writeln!(
                text,
                "waveform = \"wave\"\nduty = {}\namplitude = {}\nstart = {}",
                number(self.duty),
                number(self.amplitude),
                legs(
                    self.start
                        .map(|start| (start * 1000.0).round() / 1000.0 % 1.0)
                )
            );
        }
        if self.gain.iter().any(|gain| (gain - 1.0).abs() > 1e-9) {
            let _ = writeln!(text, "gain = {}", legs(self.gain));
        }
        text
    }
}

/// What becomes of a gait.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Trial {
    /// Where it leads.
    #[serde(flatten)]
    pub outlook: Outlook,
    /// Its table for robot.toml.
    pub table: String,
    /// The margin that is nearest to its limit, in words.
    pub margin: &'static str,
    /// Its least value, a sine.
    pub least: f64,
    /// The least that is safe.
    pub limit: f64,
    /// The servo that turns fastest.
    pub servo: &'static str,
    /// How fast, deg/s.
    pub speed: f64,
    /// Its cycle, s.
    pub period: f64,
}

/// A value that would do in place of the one that was wanted.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Instead {
    /// `amplitude`, `size` or `period`.
    pub what: &'static str,
    /// deg, a share or s.
    pub value: f64,
}

/// Why a gait will not do, and what would.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NoTrial {
    /// The refusal.
    #[serde(flatten)]
    pub refused: Refused,
    /// The nearest values that would do, each alone.
    pub instead: Vec<Instead>,
}

/// A robot.toml with the table of a gait: in place of the one of its name, or below all.
pub(crate) fn put_into(text: &str, name: &str, table: &str) -> String {
    let (own, below) = (format!("[gait.{name}]"), format!("[gait.{name}."));
    let (mut kept, mut is_own, mut done) = (String::new(), false, false);
    for line in text.lines() {
        let head = line.trim_start();
        if head.starts_with('[') {
            is_own = head.starts_with(&own) || head.starts_with(&below);
            if is_own && !done {
                done = true;
                kept += table;
                kept.push('\n');
            }
        }
        // What is said of a table stands above its head, or of the next one below this.
        if !is_own || head.starts_with('#') {
            kept += line;
            kept.push('\n');
        }
    }
    if !done {
        kept.push('\n');
        kept += table;
    }
    kept
}

/// A robot.toml without its gaits.
pub(crate) fn without_gaits(text: &str) -> String {
    let mut is_gait = false;
    let mut kept = String::new();
    for line in text.lines() {
        let head = line.trim_start();
        if head.starts_with('[') {
            is_gait = head.starts_with("[gait.") || head.starts_with("[gait]");
        }
        if !is_gait {
            kept += line;
            kept.push('\n');
        }
    }
    kept
}

/// The robot of a text without gaits, with the gait of this table alone.
pub(crate) fn with(rest: &str, table: &str) -> Result<Robot, lizard_robot::Error> {
    Robot::parse(&format!("{rest}\n{STAND}\n{table}"))
}

/// Tries a gait on the robot of a text, which stands on this twin's floor with its servos.
///
/// # Errors
/// What the gait would break, with the nearest values that would not.
pub fn trial(text: &str, bars: &Bars, twin: &Twin) -> Result<Trial, NoTrial> {
    let rest = without_gaits(text);
    tried(&rest, &bars.table(), twin).map_err(|refused| NoTrial {
        refused,
        instead: instead(&rest, bars),
    })
}

/// Tries the gait of a table on the robot of a text without gaits.
pub(crate) fn tried(rest: &str, table: &str, twin: &Twin) -> Result<Trial, Refused> {
    // Its line is that of a text which nobody sees.
    let robot = with(rest, table).map_err(|error| Refused {
        refused: format!("{}: {}", error.key, error.problem),
        line: None,
        key: error.key.clone(),
    })?;
    let mut there = Twin::new(&robot, twin.servos());
    there.set_ground(*twin.ground());
    let gait = &robot.gaits()[1];
    let (audit, limits) = (gait.audit(), robot.limits());
    let margins = [
        (audit.type2, limits.type2),
        (audit.type1, limits.type1),
        (audit.leg, limits.leg),
    ];
    let (least, limit) = margins
        .into_iter()
        .min_by(|a, b| (a.0.value - a.1).total_cmp(&(b.0.value - b.1)))
        .expect("three margins");
    Ok(Trial {
        outlook: Outlook::of(&there, gait),
        table: table.to_string(),
        margin: least.what.name(),
        least: least.value,
        limit,
        servo: NAMES[audit.peak.servo],
        speed: audit.peak.speed,
        period: gait.period(),
    })
}

/// The nearest smaller amplitude and the nearest longer period that would do.
fn instead(rest: &str, bars: &Bars) -> Vec<Instead> {
    let amplitude = |tenths: i64| Bars {
        amplitude: tenths as f64 / 10.0,
        ..bars.clone()
    };
    let period = |hundredths: i64| Bars {
        period: hundredths as f64 / 100.0,
        ..bars.clone()
    };
    let does = |bars: &Bars| with(rest, &bars.table()).is_ok();
    let wanted = (bars.amplitude * 10.0).ceil() as i64 - 1;
    let smaller = nearest(wanted, LEAST_AMPLITUDE, |tenths| does(&amplitude(tenths)));
    let wanted = (bars.period * 100.0).floor() as i64 + 1;
    let longer = nearest(wanted, LONGEST, |hundredths| does(&period(hundredths)));
    let smaller = smaller.map(|tenths| Instead {
        what: "amplitude",
        value: tenths as f64 / 10.0,
    });
    let longer = longer.map(|hundredths| Instead {
        what: "period",
        value: hundredths as f64 / 100.0,
    });
    smaller.into_iter().chain(longer).collect()
}

/// The first of the numbers from one to another that does, where what is farther does as well.
pub(crate) fn nearest(from: i64, to: i64, does: impl Fn(i64) -> bool) -> Option<i64> {
    let way = (to - from).signum();
    if from == to || way == 0 || !does(to) {
        return None;
    }
    let (mut not, mut done) = (from - way, to);
    while (done - not).abs() > 1 {
        let middle = i64::midpoint(not, done);
        if does(middle) {
            done = middle
        } else {
            not = middle
        }
    }
    Some(done)
}

#[cfg(test)]
mod tests;
