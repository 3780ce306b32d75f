//! Converts search parameters, which are numbers from 0 to 1, to gaits.
//!
//! A straight gait is symmetrical in Hildebrand's sense (*Symmetrical gaits of horses*, Science 150, 1965): the two
//! legs of a pair make the same movement half a cycle apart, so the body walks straight. The pairs of a straight gait
//! are the hind legs and the front legs. The pairs of a turn on the spot are diagonally opposite legs, so the body
//! stays in place. The parameters of a wave gait are the duty factor, the lag of the front foot behind the hind foot of
//! one side, the amplitude, and its balance between the two pairs of legs.

use lizard_robot::Bars;

use crate::goal::Goal;

/// A kind of gait in the search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GaitKind {
    /// `waveform = "wave"`. Parameters: duty factor, lag of the front feet, amplitude, balance of the two pairs.
    Wave,
    /// `waveform = "held"`. Parameters: order in which the feet swing, amplitude, balance of the two pairs.
    Held,
}

impl GaitKind {
    /// All kinds, in the order of the search.
    pub const ALL: [Self; 2] = [Self::Wave, Self::Held];

    /// Returns the start parameter sets of the search. The feet swing one at a time, with the largest amplitude. A wave
    /// gait starts with both footfall sequences of animals, lateral and diagonal.
    pub fn start_parameters(self) -> Vec<Vec<f64>> {
        let duty = (0.75 - DUTY_RANGE.0) / (DUTY_RANGE.1 - DUTY_RANGE.0);
        match self {
            Self::Wave => vec![vec![duty, 0.25, 1.0, 0.5], vec![duty, 0.75, 1.0, 0.5]],
            Self::Held => vec![vec![0.0, 1.0, 0.5]],
        }
    }

    /// Plans the gait for parameters from 0 to 1, with values rounded as in robot.toml and the period [`MAX_PERIOD_S`],
    /// which the caller replaces. Parameters are clamped to their range; a missing parameter counts as 0.
    pub(crate) fn plan_gait(
        self,
        goal: Goal,
        max_amplitude: f64,
        name: &str,
        parameters: &[f64],
    ) -> Bars {
        let parameter = |i: usize| parameters.get(i).map_or(0.0, |value| value.clamp(0.0, 1.0));
        let scale = |i: usize, (low, high): (f64, f64)| low + (high - low) * parameter(i);
        let (duty, start, amplitude_index) = match self {
            Self::Wave => {
                let lag = round_to_decimals(parameter(1), 2) % 1.0;
                // The two legs of a pair are half a cycle apart.
                let opposite = (lag + 0.5) % 1.0;
                let starts = match goal {
                    // The pairs are the hind legs and the front legs.
                    Goal::Straight(_) => [lag, opposite, 0.5, 0.0],
                    // The pairs are LH and RF, and LF and RH.
                    Goal::Turn(_) => [opposite, 0.5, lag, 0.0],
                };
                let starts = starts.map(|start| round_to_decimals(start, 2));
                (round_to_decimals(scale(0, DUTY_RANGE), 2), starts, 2)
            }
            Self::Held => (
                DUTY_RANGE.0,
                swing_ranks_at(parameter(0)).map(|rank| rank as f64 / 4.0),
                1,
            ),
        };
        let balance = MAX_PAIR_REDUCTION * (2.0 * parameter(amplitude_index + 1) - 1.0);
        let pair_gains = [1.0 + balance.min(0.0), 1.0 - balance.max(0.0)];
        let pair_gains = pair_gains.map(|gain| round_to_decimals(gain, 2));
        let amplitude = scale(amplitude_index, (MIN_AMPLITUDE, max_amplitude));
        Bars {
            name: name.to_string(),
            held: self == Self::Held,
            period: MAX_PERIOD_S,
            duty,
            amplitude: round_to_decimals(amplitude, 1),
            start,
            gain: std::array::from_fn(|i| goal.stroke_sign(i) * pair_gains[goal.pair_index(i)]),
        }
    }
}

/// Smallest amplitude of the search, deg.
const MIN_AMPLITUDE: f64 = 5.0;
/// Range of duty factors. Below one half, at most two of the four feet are in stance, so there is no majority.
const DUTY_RANGE: (f64, f64) = (0.5, 0.95);
/// Largest reduction of one pair's amplitude, as a fraction of the other pair's amplitude.
const MAX_PAIR_REDUCTION: f64 = 0.5;
/// Longest cycle that robot.toml allows, s.
pub const MAX_PERIOD_S: f64 = 60.0;

fn round_to_decimals(value: f64, decimals: i32) -> f64 {
    let scale = 10f64.powi(decimals);
    (value * scale).round() / scale
}

/// Selects one of the 24 orders in which four legs can swing by `position`, 0 to 1. Returns each leg's rank in it, 0 to
/// 3, in servo order.
fn swing_ranks_at(position: f64) -> [usize; 4] {
    let mut remaining_legs = vec![3, 0, 2, 1];
    let mut order_index = ((position * 24.0) as usize).min(23);
    let mut ranks = [0; 4];
    for (rank, divisor) in [6, 2, 1, 1].into_iter().enumerate() {
        ranks[remaining_legs.remove(order_index / divisor)] = rank;
        order_index %= divisor;
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_of_the_24_swing_orders_has_its_own_parameter_range() {
        let mut orders: Vec<[usize; 4]> = (0..24)
            .map(|n| swing_ranks_at((f64::from(n) + 0.5) / 24.0))
            .collect();
        assert_eq!(orders[0], [1, 3, 2, 0]);
        assert_eq!(swing_ranks_at(1.0), orders[23]);
        orders.sort_unstable();
        orders.dedup();
        assert_eq!(orders.len(), 24);
        for mut order in orders {
            order.sort_unstable();
            assert_eq!(order, [0, 1, 2, 3]);
        }
    }

    #[test]
    fn a_planned_gait_has_the_format_of_robot_toml() {
        let format_table = |kind: GaitKind, goal, name: &str, period, parameters: &[f64]| {
            let bars = kind.plan_gait(goal, 45.0, name, parameters);
            Bars { period, ..bars }.to_toml()
        };
        let parameters = [0.5, 0.25, 0.375, 0.5];
        assert_eq!(
            format_table(GaitKind::Wave, Goal::Straight(1.0), "x", 1.5, &parameters),
            "[gait.x]\nperiod = 1.5\nwaveform = \"wave\"\nduty = 0.73\namplitude = 20.0\n\
             start = { LF = 0.25, RF = 0.75, RH = 0.5, LH = 0.0 }\n"
        );
        assert_eq!(
            format_table(GaitKind::Held, Goal::Turn(1.0), "y", 1.0, &[0.0, 0.5, 1.0]),
            "[gait.y]\nperiod = 1.0\nwaveform = \"held\"\namplitude = 25.0\n\
             order = [\"LH\", \"LF\", \"RH\", \"RF\"]\ngain = { LF = -0.5, RF = 1.0, RH = 0.5, LH = -1.0 }\n"
        );
    }

    #[test]
    fn the_two_legs_of_a_pair_are_half_a_cycle_apart() {
        for (goal, partners) in [
            (Goal::Straight(1.0), [1, 0, 3, 2]),
            (Goal::Turn(-1.0), [2, 3, 0, 1]),
        ] {
            let bars = GaitKind::Wave.plan_gait(goal, 45.0, "x", &[0.1, 0.83, 0.5, 0.7]);
            for (leg, partner) in partners.into_iter().enumerate() {
                let (start, gain) = (bars.start, bars.gain);
                let start_distance = (start[leg] - start[partner]).abs();
                assert!((start_distance - 0.5).abs() < 1e-9, "{goal:?} {start:?}");
                assert_eq!(gain[leg].abs(), gain[partner].abs());
            }
        }
    }
}
