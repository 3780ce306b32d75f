//! A measurement with its budget and the Arduino Servo library's value, and those budgets that need an explanation.

use serde::Serialize;

/// The budget of a measurement.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Bound {
    /// The largest allowed value.
    AtMost(f64),
    /// The smallest allowed value.
    AtLeast(f64),
    /// There is no budget.
    None,
}

/// A measurement and its budget; the serialized field names are the JSON keys.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BudgetRow {
    /// The measurement's name.
    #[serde(rename = "what")]
    pub name: &'static str,
    /// The measurement's unit.
    pub unit: &'static str,
    /// The measured value; `None` if it could not be measured.
    pub measured: Option<f64>,
    /// The measurement's budget.
    pub budget: Bound,
    /// The same value for the Arduino Servo library, measured as in `SERVO_LIBRARY_SETUP`; `None` if it is not known.
    pub servo_library: Option<&'static str>,
    /// True if the value depends on the machine that runs the measurement.
    #[serde(rename = "wall_clock")]
    pub is_machine_dependent: bool,
    /// False if the value was measured and is beyond its budget.
    #[serde(rename = "met")]
    pub is_within_budget: bool,
}

impl BudgetRow {
    /// Creates the row of a value that does not depend on the machine.
    pub fn new(
        name: &'static str,
        unit: &'static str,
        measured: Option<f64>,
        budget: Bound,
        servo_library: Option<&'static str>,
    ) -> Self {
        let is_within_budget = measured.is_none_or(|measured| match budget {
            Bound::AtMost(max) => measured <= max,
            Bound::AtLeast(min) => measured >= min,
            Bound::None => true,
        });
        Self {
            name,
            unit,
            measured,
            budget,
            servo_library,
            is_machine_dependent: false,
            is_within_budget,
        }
    }
}

/// The setup for measuring the Arduino Servo library.
pub const SERVO_LIBRARY_SETUP: &str = "Arduino Servo 1.3.0 (core 1.8.8, ATmega328P at 16 MHz) with four servos at a constant \
     1500 us; its float solve is theta2 and theta3 of head and tail";

/// Cycles from the control tick to the end of its slot, where the interrupts take over the next frame.
pub(super) const TICK_DEADLINE_CYCLES: f64 = 63_000.0;
/// The fraction of all cycles that interrupts leave to main in the worst case, in which the serial line is saturated in
/// both directions.
pub(super) const MIN_MAIN_FRACTION: f64 = 0.87;
/// Budgets of the mean and longest control tick, cycles.
pub(super) const TICK_BUDGET_CYCLES: [f64; 2] = [5_000.0, 10_000.0];
/// Budgets of the mean and longest control tick, cycles, for a robot without maps of certified cells, so that the guard
/// checks every pose.
pub(super) const TICK_BUDGET_WITHOUT_MAPS_CYCLES: [f64; 2] = [20_000.0, 20_000.0];
/// Longest interrupt that does not delay a servo's edge, cycles: the servo interrupts start 220 cycles early and need
/// 60 cycles before they read the timer.
pub(super) const MAX_OTHER_INTERRUPT_CYCLES: f64 = 160.0;
/// Longest wall time for ten simulated minutes, s.
pub(super) const MAX_LONG_RUN_WALL_S: f64 = 60.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_over_budget_only_beyond_its_bound() {
        for (measured, budget, expected) in [
            (Some(3.0), Bound::AtMost(3.0), true),
            (Some(3.1), Bound::AtMost(3.0), false),
            (Some(3.0), Bound::AtLeast(3.0), true),
            (Some(2.9), Bound::AtLeast(3.0), false),
            (Some(1e9), Bound::None, true),
            (None, Bound::AtLeast(3.0), true),
        ] {
            let row = BudgetRow::new("", "", measured, budget, None);
            assert_eq!(row.is_within_budget, expected, "{measured:?} {budget:?}");
        }
    }
}
