//! The parameters of the search, numbers from 0 to 1, and the gaits that they describe.
//!
//! A straight gait is symmetrical in Hildebrand's sense (*Symmetrical gaits of horses*,
//! Science 150, 1965): each leg moves as the opposite leg of its pair did half a cycle earlier, so the
//! body walks straight. In a turn on the spot the diagonally opposite leg takes the place of
//! the leg of the other side, so the body stays where it is. The remaining parameters of a wave gait
//! are its duty factor, the lag of the front foot behind the hind foot of one side, and an
//! amplitude for each pair of legs.

use lizard_robot::Bars;

use crate::goal::Goal;

/// The kinds of gait that the search tries, and their parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// `waveform = "wave"`. Parameters: duty factor, lag of the front feet, amplitude, balance of the two pairs.
    Wave,
    /// `waveform = "held"`. Parameters: order in which the feet swing, amplitude, balance of the two pairs.
    Held,
}

impl Kind {
    /// All kinds, in the order of the search.
    pub const ALL: [Self; 2] = [Self::Wave, Self::Held];

    /// Returns the parameters with which the search starts. The feet swing one after the other, with the largest
    /// amplitude; a wave gait starts with both sequences that animals use, lateral and diagonal.
    pub fn begin(self) -> Vec<Vec<f64>> {
        let share_of_range = |duty: f64| (duty - DUTIES.0) / (DUTIES.1 - DUTIES.0);
        match self {
            Self::Wave => vec![
                vec![share_of_range(0.75), 0.25, 1.0, 0.5],
                vec![share_of_range(0.75), 0.75, 1.0, 0.5],
            ],
            Self::Held => vec![vec![0.0, 1.0, 0.5]],
        }
    }
}

/// Smallest amplitude of the search, deg.
const MIN_AMPLITUDE: f64 = 5.0;
/// Range of duty factors. Below one half, at most two of the four feet are in stance, which is no majority.
const DUTIES: (f64, f64) = (0.5, 0.95);
/// Largest reduction of one pair's amplitude, as a share of the other pair's amplitude.
const BALANCE: f64 = 0.5;
/// The longest cycle that robot.toml accepts, s.
pub const MAX_PERIOD_S: f64 = 60.0;

/// The goal and the largest amplitude of the gaits that the search tries.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Space {
    /// The goal of the gait: straight or a turn, and its direction.
    pub goal: Goal,
    /// Largest amplitude of the search, deg.
    pub widest: f64,
}

/// Returns the gait for parameters from 0 to 1, rounded as in robot.toml. Its period is [`MAX_PERIOD_S`], which the
/// caller replaces. Parameters are limited to their range; a missing parameter counts as 0.
pub fn planned(kind: Kind, space: Space, name: &str, parameters: &[f64]) -> Bars {
    let Space { goal, widest } = space;
    let parameter_at = |i: usize| {
        parameters
            .get(i)
            .copied()
            .unwrap_or_default()
            .clamp(0.0, 1.0)
    };
    let value_between = |i: usize, (low, high): (f64, f64)| low + (high - low) * parameter_at(i);
    let (duty, start, amplitude_index) = match kind {
        Kind::Wave => {
            let lag = round_to(parameter_at(1), 2) % 1.0;
            // The two legs of a pair are half a cycle apart. In a straight gait, the pairs are the hind legs and the
            // front legs.
            let [lf, rf] = match goal {
                Goal::Ahead(_) => [lag, (lag + 0.5) % 1.0],
                Goal::Turn(_) => [(lag + 0.5) % 1.0, lag],
            };
            // In a turn, the pairs are LH and RF, and LF and RH; so RH takes the value `rf`.
            let starts = match goal {
                Goal::Ahead(_) => [lf, rf, 0.5, 0.0],
                Goal::Turn(_) => [lf, 0.5, rf, 0.0],
            };
            let starts = starts.map(|start| round_to(start, 2));
            (round_to(value_between(0, DUTIES), 2), starts, 2)
        }
        Kind::Held => (
            DUTIES.0,
            order_of_turns(parameter_at(0)).map(|turn| turn as f64 / 4.0),
            1,
        ),
    };
    let balance = BALANCE * (2.0 * parameter_at(amplitude_index + 1) - 1.0);
    let pair_gains = [1.0 + balance.min(0.0), 1.0 - balance.max(0.0)].map(|gain| round_to(gain, 2));
    let gain_of = |servo: usize| goal.sign(servo) * pair_gains[goal.pair(servo)];
    Bars {
        name: name.to_string(),
        held: kind == Kind::Held,
        period: MAX_PERIOD_S,
        duty,
        amplitude: round_to(value_between(amplitude_index, (MIN_AMPLITUDE, widest)), 1),
        start,
        gain: std::array::from_fn(gain_of),
    }
}

fn round_to(value: f64, digits: i32) -> f64 {
    let scale = 10f64.powi(digits);
    (value * scale).round() / scale
}

/// Selects one of the 24 orders of four legs by `position`, 0 to 1. Returns each leg's turn, 0 to 3, in servo order.
fn order_of_turns(position: f64) -> [usize; 4] {
    let mut remaining_legs = vec![3, 0, 2, 1];
    let mut number = ((position * 24.0) as usize).min(23);
    let mut turns = [0; 4];
    for (turn, divisor) in [6, 2, 1, 1].into_iter().enumerate() {
        turns[remaining_legs.remove(number / divisor)] = turn;
        number %= divisor;
    }
    turns
}

#[cfg(test)]
mod tests {
    use super::*;

    fn space_of(goal: Goal) -> Space {
        Space { goal, widest: 45.0 }
    }

    #[test]
    fn every_order_comes_up_once() {
        let mut orders: Vec<[usize; 4]> = (0..24)
            .map(|n| order_of_turns((f64::from(n) + 0.5) / 24.0))
            .collect();
        assert_eq!(orders[0], [1, 3, 2, 0]);
        assert_eq!(order_of_turns(1.0), orders[23]);
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
        let table_of = |kind, goal, name: &str, period, parameters: &[f64]| {
            let bars = planned(kind, space_of(goal), name, parameters);
            Bars { period, ..bars }.to_toml()
        };
        assert_eq!(
            table_of(
                Kind::Wave,
                Goal::Ahead(1.0),
                "x",
                1.5,
                &[0.5, 0.25, 0.375, 0.5]
            ),
            "[gait.x]\nperiod = 1.5\nwaveform = \"wave\"\nduty = 0.73\namplitude = 20.0\n\
             start = { LF = 0.25, RF = 0.75, RH = 0.5, LH = 0.0 }\n"
        );
        assert_eq!(
            table_of(Kind::Held, Goal::Turn(1.0), "y", 1.0, &[0.0, 0.5, 1.0]),
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
            let bars = planned(Kind::Wave, space_of(goal), "x", &[0.1, 0.83, 0.5, 0.7]);
            for (leg, partner) in partners.into_iter().enumerate() {
                let start_distance = (bars.start[leg] - bars.start[partner]).abs();
                assert!(
                    (start_distance - 0.5).abs() < 1e-9,
                    "{goal:?} {:?}",
                    bars.start
                );
                assert_eq!(bars.gain[leg].abs(), bars.gain[partner].abs());
            }
        }
    }
}
