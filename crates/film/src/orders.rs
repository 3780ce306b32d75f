//! The steps that a servo in the jig is ordered to make; both the sender and the measurement use this list.
//!
//! A servo shows its rate only if its pulse width changes faster than it turns. A move to a pose is too smooth for
//! that, but reversing the servo's direction (console command `dir`) takes the pulse to the other side of neutral at
//! the slew limit. These are the large steps. Then the servo visits the same angles from both sides. At the end, small
//! steps grow until the servo reacts.

use std::ops::Range;

/// Time from one order to the next, s.
pub const ORDER_INTERVAL: f64 = 1.0;
/// Half of a large step, deg from neutral.
const HALF_LARGE_STEP: f64 = 30.0;
/// Number of large steps.
const LARGE_STEP_COUNT: usize = 8;
/// The poses at which the servo's angle is measured: deg from neutral, and true if the direction is reversed. They
/// lead twice from one side to the other and back, in steps of 15 deg. The direction is reversed at neutral, where
/// that moves nothing.
#[rustfmt::skip]
const VISITED_POSES: [(f64, bool); 19] = [
    (15.0, false), (0.0, false),
    (0.0, true), (15.0, true), (30.0, true), (15.0, true), (0.0, true),
    (0.0, false), (15.0, false), (30.0, false), (15.0, false), (0.0, false),
    (0.0, true), (15.0, true), (30.0, true), (15.0, true), (0.0, true),
    (0.0, false), (15.0, false),
];
/// Sizes of the small steps, deg: each goes from the last visited pose toward neutral and back.
const SMALL_STEP_SIZES: [f64; 10] = [0.2, 0.4, 0.6, 0.8, 1.0, 1.25, 1.6, 2.0, 2.5, 3.0];

/// An order to the servo: a pose and a direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Order {
    /// Angle of the pose from neutral, deg, counter-clockwise positive.
    pub sweep: f64,
    /// True while the servo's direction is the opposite of robot.toml's.
    pub is_reversed: bool,
}

impl Order {
    /// The angle that the pulse width means in robot.toml's direction, deg from neutral.
    pub fn pulse_angle(&self) -> f64 {
        match self.is_reversed {
            true => -self.sweep,
            false => self.sweep,
        }
    }
}

/// All orders. The poses are counter-clockwise from neutral if `side` is 1, clockwise if it is -1.
pub fn orders(side: f64) -> Vec<Order> {
    let order = |sweep: f64, is_reversed| Order {
        sweep: side * sweep,
        is_reversed,
    };
    let mut orders = vec![order(0.0, false), order(HALF_LARGE_STEP, false)];
    orders.extend((0..LARGE_STEP_COUNT).map(|i| order(HALF_LARGE_STEP, i % 2 == 0)));
    orders.extend(VISITED_POSES.map(|(sweep, is_reversed)| order(sweep, is_reversed)));
    let (last_sweep, _) = VISITED_POSES[VISITED_POSES.len() - 1];
    for step_size in SMALL_STEP_SIZES {
        orders.extend([
            order(last_sweep - step_size, false),
            order(last_sweep, false),
        ]);
    }
    orders
}

/// The indices of the orders for the large steps.
pub(crate) fn large_step_indices() -> Range<usize> {
    2..2 + LARGE_STEP_COUNT
}

/// The indices of the orders for the visited poses.
pub(crate) fn visit_indices() -> Range<usize> {
    large_step_indices().end..large_step_indices().end + VISITED_POSES.len()
}

/// The indices of the orders for the small steps.
pub(crate) fn small_step_indices() -> Range<usize> {
    let begin = visit_indices().end;
    begin..begin + 2 * SMALL_STEP_SIZES.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_steps_turn_by_60_deg_to_alternating_sides_and_small_steps_return() {
        let orders = orders(-1.0);
        let step_of = |i: usize| orders[i].pulse_angle() - orders[i - 1].pulse_angle();
        for i in large_step_indices() {
            let side = if i % 2 == 0 { 1.0 } else { -1.0 };
            assert_eq!(step_of(i), 2.0 * HALF_LARGE_STEP * side, "{i}");
        }
        assert_eq!(small_step_indices().end, orders.len());
        for i in small_step_indices().step_by(2) {
            assert!(
                (step_of(i) + step_of(i + 1)).abs() < 1e-12 && step_of(i) > 0.0,
                "{i}"
            );
        }
    }

    #[test]
    fn the_first_small_step_reverses_the_direction_of_the_last_visit() {
        let (orders, first_small_step) = (orders(1.0), small_step_indices().start);
        let visit_step =
            orders[first_small_step - 1].pulse_angle() - orders[first_small_step - 2].pulse_angle();
        let small_step =
            orders[first_small_step].pulse_angle() - orders[first_small_step - 1].pulse_angle();
        assert!(visit_step * small_step < 0.0);
    }
}
