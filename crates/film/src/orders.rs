//! The steps that a servo in the jig is ordered to make; both the sender and the measurement use this list.
//!
//! A servo shows its rate only if its pulse width jumps faster than it turns. A move to a pose is too smooth for
//! that, but reversing the direction (`dir`) takes the pulse to the other side of neutral at the slew limit. Then the
//! same angle is approached from both sides. At the end, small steps grow until the servo reacts.

use std::ops::Range;

/// Time from one order to the next, s.
pub const PAUSE: f64 = 1.0;
/// Half of a large step, deg from neutral.
const HALF_STEP: f64 = 30.0;
/// Number of large steps.
const FLIPS: usize = 8;
/// The poses for measuring the servo's angle: deg from neutral, and true if the direction is reversed. They go from
/// one side to the other and back twice, in steps of 15 deg. The direction changes at neutral, where the change
/// moves nothing.
#[rustfmt::skip]
const VISITS: [(f64, bool); 19] = [
    (15.0, false), (0.0, false),
    (0.0, true), (15.0, true), (30.0, true), (15.0, true), (0.0, true),
    (0.0, false), (15.0, false), (30.0, false), (15.0, false), (0.0, false),
    (0.0, true), (15.0, true), (30.0, true), (15.0, true), (0.0, true),
    (0.0, false), (15.0, false),
];
/// Sizes of the small steps, deg: each goes from the last visited pose toward neutral and back.
const SWINGS: [f64; 10] = [0.2, 0.4, 0.6, 0.8, 1.0, 1.25, 1.6, 2.0, 2.5, 3.0];

/// An order to the servo.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Order {
    /// Angle of the pose from neutral, deg, counter-clockwise positive.
    pub sweep: f64,
    /// True while the servo's direction is the opposite of robot.toml's.
    pub is_reversed: bool,
}

impl Order {
    /// The angle of the pulse by robot.toml's direction, deg from neutral.
    pub fn pulse_angle(&self) -> f64 {
        match self.is_reversed {
            true => -self.sweep,
            false => self.sweep,
        }
    }
}

/// Makes all orders. The poses are counter-clockwise from neutral if `side` is 1, clockwise if it is -1.
pub fn orders(side: f64) -> Vec<Order> {
    let order = |sweep: f64, is_reversed| Order {
        sweep: side * sweep,
        is_reversed,
    };
    let mut orders = vec![order(0.0, false), order(HALF_STEP, false)];
    orders.extend((0..FLIPS).map(|i| order(HALF_STEP, i % 2 == 0)));
    orders.extend(VISITS.map(|(sweep, is_reversed)| order(sweep, is_reversed)));
    let (last_sweep, _) = VISITS[VISITS.len() - 1];
    for swing in SWINGS {
        orders.extend([order(last_sweep - swing, false), order(last_sweep, false)]);
    }
    orders
}

/// The indices of the orders for the large steps.
pub(crate) fn large_step_indices() -> Range<usize> {
    2..2 + FLIPS
}

/// The indices of the orders for the visits.
pub(crate) fn visits() -> Range<usize> {
    large_step_indices().end..large_step_indices().end + VISITS.len()
}

/// The indices of the orders for the small steps.
pub(crate) fn swings() -> Range<usize> {
    let begin = visits().end;
    begin..begin + 2 * SWINGS.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_steps_are_of_60_deg_to_both_sides_and_small_ones_go_there_and_back() {
        let orders = orders(-1.0);
        let step_of = |i: usize| orders[i].pulse_angle() - orders[i - 1].pulse_angle();
        for i in large_step_indices() {
            let side = if i % 2 == 0 { 1.0 } else { -1.0 };
            assert_eq!(step_of(i), 2.0 * HALF_STEP * side, "{i}");
        }
        assert_eq!(swings().end, orders.len());
        for i in swings().step_by(2) {
            assert!(
                (step_of(i) + step_of(i + 1)).abs() < 1e-12 && step_of(i) > 0.0,
                "{i}"
            );
        }
    }

    #[test]
    fn the_last_visit_comes_from_the_side_from_which_small_steps_turn_back() {
        let (orders, first_swing) = (orders(1.0), swings().start);
        let visit_step =
            orders[first_swing - 1].pulse_angle() - orders[first_swing - 2].pulse_angle();
        let swing_step = orders[first_swing].pulse_angle() - orders[first_swing - 1].pulse_angle();
        assert!(visit_step * swing_step < 0.0);
    }
}
