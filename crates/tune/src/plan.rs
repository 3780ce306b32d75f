//! A gait's parameters for the search: numbers from 0 to 1, and what they mean.
//!
//! A straight gait is symmetrical in Hildebrand's sense (*Symmetrical gaits of horses*,
//! Science 150, 1965): what a leg does, its mirror image does half a cycle later, so the
//! body goes straight. In a turn on the spot the leg diagonally across takes the place of
//! the mirror image, so the body stays where it is. The remaining parameters of a wave
//! are its duty, the time from the hind foot to the front foot of one side, and two
//! amplitudes.

use std::fmt::Write;

use lizard_robot::servo::LEGS;

use crate::goal::Goal;

/// The kinds of gait that are searched, and their parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// `waveform = "wave"`: duty, lag of the front feet, amplitude, balance of the two pairs.
    Wave,
    /// `waveform = "held"`: order of the returns, amplitude, balance.
    Held,
}

impl Kind {
    /// All.
    pub const ALL: [Self; 2] = [Self::Wave, Self::Held];

    /// Parameters to begin with: feet that return one after the other, as wide as they may; of a
    /// wave in either of the two sequences that animals have, lateral and diagonal.
    pub fn begin(self) -> Vec<Vec<f64>> {
        let share = |duty: f64| (duty - DUTIES.0) / (DUTIES.1 - DUTIES.0);
        match self {
            Self::Wave => vec![
                vec![share(0.75), 0.25, 1.0, 0.5],
                vec![share(0.75), 0.75, 1.0, 0.5],
            ],
            Self::Held => vec![vec![0.0, 1.0, 0.5]],
        }
    }
}

/// The smallest amplitude that is tried, deg.
const NARROWEST: f64 = 5.0;
/// Duties that are tried: below one half two feet never out-vote the others.
const DUTIES: (f64, f64) = (0.5, 0.95);
/// How much smaller one pair's amplitude may be than the other's.
const BALANCE: f64 = 0.5;
/// The longest cycle that robot.toml takes, s.
pub const LONGEST: f64 = 60.0;

/// What is searched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Space {
    /// Where the gait is to lead.
    pub goal: Goal,
    /// The largest amplitude that is tried, deg.
    pub widest: f64,
}

/// A gait's parameters, rounded as they are written.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    wave: Wave,
    amplitude: f64,
    /// Factor of each leg's sweep, servo order: LF, RF, RH, LH.
    gains: [f64; 4],
}

#[derive(Debug, Clone, PartialEq)]
enum Wave {
    /// Duty, and where each leg's stance begins, servo order.
    Wave(f64, [f64; 4]),
    /// The order of the returns: numbers of servos.
    Held([usize; 4]),
}

impl Plan {
    /// What parameters from 0 to 1 mean. A value outside is taken for the nearest.
    pub fn of(kind: Kind, space: Space, parameters: &[f64]) -> Self {
        let Space { goal, widest } = space;
        let at = |i: usize| {
            parameters
                .get(i)
                .copied()
                .unwrap_or_default()
                .clamp(0.0, 1.0)
        };
        let between = |i: usize, (low, high): (f64, f64)| low + (high - low) * at(i);
        let (wave, amplitude, balance) = match kind {
            Kind::Wave => {
                let lag = rounded(at(1), 2) % 1.0;
                // The hind legs half a cycle apart, the partners of the front legs as well.
                let [lf, rf] = match goal {
                    Goal::Ahead(_) => [lag, (lag + 0.5) % 1.0],
                    Goal::Turn(_) => [(lag + 0.5) % 1.0, lag],
                };
                // Across from LH is RF in a turn, so RH is the other pair's.
                let starts = match goal {
                    Goal::Ahead(_) => [lf, rf, 0.5, 0.0],
                    Goal::Turn(_) => [lf, 0.5, rf, 0.0],
                };
                (
                    Wave::Wave(
                        rounded(between(0, DUTIES), 2),
                        starts.map(|start| rounded(start, 2)),
                    ),
                    2,
                    3,
                )
            }
            Kind::Held => (Wave::Held(order(at(0))), 1, 2),
        };
        let balance = BALANCE * (2.0 * at(balance) - 1.0);
        let pairs = [1.0 + balance.min(0.0), 1.0 - balance.max(0.0)].map(|gain| rounded(gain, 2));
        let gain = |servo: usize| goal.sign(servo) * pairs[goal.pair(servo)];
        Self {
            wave,
            amplitude: rounded(between(amplitude, (NARROWEST, widest)), 1),
            gains: std::array::from_fn(gain),
        }
    }

    /// The plan as a table of robot.toml.
    pub fn fragment(&self, name: &str, period: f64) -> String {
        let mut text = format!("[gait.{name}]\nperiod = {}\n", decimal(period));
        // Writing to a String never fails.
        let _ = match &self.wave {
            Wave::Wave(duty, starts) => writeln!(
                text,
                "waveform = \"wave\"\nduty = {}\namplitude = {}\nstart = {}",
                decimal(*duty),
                decimal(self.amplitude),
                table(starts)
            ),
            Wave::Held(order) => writeln!(
                text,
                "waveform = \"held\"\namplitude = {}\norder = [{}]",
                decimal(self.amplitude),
                order.map(|servo| format!("{:?}", LEGS[servo])).join(", ")
            ),
        };
        if self.gains != [1.0; 4] {
            let _ = writeln!(text, "gain = {}", table(&self.gains));
        }
        text
    }
}

/// A number for each leg as an inline table.
fn table(values: &[f64; 4]) -> String {
    let entry = |i: usize| format!("{} = {}", LEGS[i], decimal(values[i]));
    format!("{{ {} }}", [0, 1, 2, 3].map(entry).join(", "))
}

/// As TOML has a float: with a point.
fn decimal(value: f64) -> String {
    format!("{value:?}")
}

fn rounded(value: f64, digits: i32) -> f64 {
    let scale = 10f64.powi(digits);
    (value * scale).round() / scale
}

/// One of the 24 orders of four legs.
fn order(at: f64) -> [usize; 4] {
    let mut left = vec![3, 0, 2, 1];
    let mut number = ((at * 24.0) as usize).min(23);
    std::array::from_fn(|i| {
        let of = [6, 2, 1, 1][i];
        let leg = left.remove(number / of);
        number %= of;
        leg
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn space(goal: Goal) -> Space {
        Space { goal, widest: 45.0 }
    }

    #[test]
    fn every_order_comes_up_once() {
        let mut orders: Vec<[usize; 4]> = (0..24)
            .map(|n| order((f64::from(n) + 0.5) / 24.0))
            .collect();
        assert_eq!(orders[0], [3, 0, 2, 1]);
        assert_eq!(order(1.0), orders[23]);
        orders.sort_unstable();
        orders.dedup();
        assert_eq!(orders.len(), 24);
        for mut order in orders {
            order.sort_unstable();
            assert_eq!(order, [0, 1, 2, 3]);
        }
    }

    #[test]
    fn a_plan_is_written_as_robot_toml_reads_it() {
        let walk = Plan::of(
            Kind::Wave,
            space(Goal::Ahead(1.0)),
            &[0.5, 0.25, 0.375, 0.5],
        );
        assert_eq!(
            walk.fragment("x", 1.5),
            "[gait.x]\nperiod = 1.5\nwaveform = \"wave\"\nduty = 0.73\namplitude = 20.0\n\
             start = { LF = 0.25, RF = 0.75, RH = 0.5, LH = 0.0 }\n"
        );
        let turn = Plan::of(Kind::Held, space(Goal::Turn(1.0)), &[0.0, 0.5, 1.0]);
        assert_eq!(
            turn.fragment("y", 1.0),
            "[gait.y]\nperiod = 1.0\nwaveform = \"held\"\namplitude = 25.0\n\
             order = [\"LH\", \"LF\", \"RH\", \"RF\"]\ngain = { LF = -0.5, RF = 1.0, RH = 0.5, LH = -1.0 }\n"
        );
    }

    #[test]
    fn partners_are_half_a_cycle_apart() {
        for (goal, partners) in [
            (Goal::Ahead(1.0), [1, 0, 3, 2]),
            (Goal::Turn(-1.0), [2, 3, 0, 1]),
        ] {
            let plan = Plan::of(Kind::Wave, space(goal), &[0.1, 0.83, 0.5, 0.7]);
            let Wave::Wave(_, starts) = plan.wave else {
                panic!("a wave")
            };
            for (leg, partner) in partners.into_iter().enumerate() {
                let apart = (starts[leg] - starts[partner]).abs();
                assert!((apart - 0.5).abs() < 1e-9, "{goal:?} {starts:?}");
                assert_eq!(plan.gains[leg].abs(), plan.gains[partner].abs());
            }
        }
    }
}
