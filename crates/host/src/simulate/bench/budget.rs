//! The budget of each measurement, and the values of the Arduino Servo library for comparison.

use lizard_core::numbers::section::{REGION_BYTES, START_ADDRESS};
use serde::Serialize;

use super::Measurements;

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
    /// The same value for the Arduino Servo library, measured as in `SERVO_LIBRARY`; `None` if it is not known.
    pub servo_library: Option<&'static str>,
    /// True if the value depends on the machine that runs the measurement.
    #[serde(rename = "wall_clock")]
    pub is_machine_dependent: bool,
}

impl BudgetRow {
    /// True if the value is within its budget; a missing value passes.
    pub fn is_within_budget(&self) -> bool {
        self.measured.is_none_or(|measured| match self.budget {
            Bound::AtMost(max) => measured <= max,
            Bound::AtLeast(min) => measured >= min,
            Bound::None => true,
        })
    }
}

/// The setup for measuring the Arduino Servo library.
pub const SERVO_LIBRARY: &str = "Arduino Servo 1.3.0 (core 1.8.8, ATmega328P at 16 MHz) with four servos at a constant \
     1500 us; its float solve is theta2 and theta3 of head and tail";

/// Cycles from the control tick to the end of its slot, where the interrupts take over the next frame.
const TICK_DEADLINE_CYCLES: f64 = 63_000.0;
/// The fraction of all cycles that interrupts leave to main while the serial line is saturated in both directions.
const MAIN_FRACTION: f64 = 0.87;
/// Budgets of the mean and longest control tick, cycles.
const TICK_BUDGET_CYCLES: [f64; 2] = [5_000.0, 10_000.0];
/// Budgets of the mean and longest control tick, cycles, for a robot without maps of certified cells, so that the guard
/// checks every pose.
const TICK_BUDGET_WITHOUT_MAPS_CYCLES: [f64; 2] = [20_000.0, 20_000.0];
/// Longest interrupt that does not delay a servo's edge, cycles: the servo interrupts start 220 cycles early and need
/// 60 cycles before they read the timer.
const MAX_OTHER_INTERRUPT_CYCLES: f64 = 160.0;
/// Longest wall time for ten simulated minutes, s.
const MAX_WALL_S: f64 = 60.0;
/// Simulated time of the long run, s: ten minutes.
const LONG_RUN_S: f64 = 600.0;

/// Lists all measurements with their budgets.
pub fn list_rows(measurements: &Measurements) -> Vec<BudgetRow> {
    use Bound::{AtLeast, AtMost};
    let row = |name, unit, measured, budget, servo_library| BudgetRow {
        name,
        unit,
        measured,
        budget,
        servo_library,
        is_machine_dependent: false,
    };
    let wall_row = |name, unit, measured, budget| BudgetRow {
        is_machine_dependent: true,
        ..row(name, unit, Some(measured), budget, None)
    };
    let measured_if_known = |value: Option<u64>| value.map(|value| value as f64);
    let always_measured = |value: u64| Some(value as f64);
    let [mean_tick_budget, max_tick_budget] = if measurements.has_maps {
        TICK_BUDGET_CYCLES
    } else {
        TICK_BUDGET_WITHOUT_MAPS_CYCLES
    };
    #[rustfmt::skip]
    let table = vec![
        row("pulse jitter, idle line", "cycles", measured_if_known(measurements.jitter_idle), AtMost(0.0), Some("77-113")),
        row("pulse jitter, line saturated", "cycles", measured_if_known(measurements.jitter_saturated), AtMost(0.0), Some("121-135")),
        row("width minus command, worst", "cycles", measured_if_known(measurements.max_width_error), AtMost(0.0), None),
        row("width resolution", "cycles", measured_if_known(measurements.width_resolution), AtMost(1.0), Some("16")),
        row("period minus 20 ms, worst", "cycles", always_measured(measurements.max_period_error), AtMost(0.0), None),
        row("servo pins high at once", "", always_measured(measurements.max_pins_high.into()), AtMost(1.0), None),
        row("late edges counted", "", always_measured(measurements.late_edges), AtMost(0.0), None),
        row("bytes lost, sender waits", "bytes", always_measured(measurements.lost_bytes), AtMost(0.0), None),
        row("control tick, mean in any gait", "cycles", measurements.mean_tick_cycles, AtMost(mean_tick_budget), None),
        row("  of which the guard", "cycles", measurements.mean_guard_cycles, Bound::None, Some("35 400, float solve")),
        row("control tick, worst", "cycles", always_measured(measurements.max_tick_cycles), AtMost(max_tick_budget), None),
        row("  in a routine, mean", "cycles", measurements.mean_routine_tick_cycles, AtMost(mean_tick_budget), None),
        row("  in a routine, worst", "cycles", measured_if_known(measurements.max_routine_tick_cycles), AtMost(max_tick_budget), None),
        row("tick to frame, line saturated", "cycles", always_measured(measurements.max_tick_latency), AtMost(TICK_DEADLINE_CYCLES), None),
        row("any other step, worst", "cycles", always_measured(measurements.max_step_cycles), AtMost(MAIN_FRACTION * TICK_DEADLINE_CYCLES - max_tick_budget), None),
        row("main, mean per frame of a gait", "cycles", measurements.mean_main_cycles, Bound::None, None),
        row("servo interrupts per frame", "cycles", Some(measurements.mean_servo_interrupt_cycles), Bound::None, Some("1 513")),
        row("longest serial interrupt", "cycles", always_measured(measurements.max_serial_interrupt_cycles), AtMost(MAX_OTHER_INTERRUPT_CYCLES), None),
        row("CPU asleep in a gait", "%", measurements.asleep_percent, AtLeast(90.0), Some("0")),
        row("flash, code", "bytes", always_measured(measurements.code_bytes.into()), AtMost(START_ADDRESS.into()), Some("5 994")),
        row("flash, the robot's section", "bytes", always_measured(measurements.section_bytes.into()), AtMost(REGION_BYTES.into()), None),
        row("static RAM", "bytes", always_measured(measurements.static_ram.into()), AtMost(900.0), Some("365")),
        row("between stack and static RAM", "bytes", always_measured(measurements.measured_stack_margin.into()), AtLeast(400.0), None),
        row("  with the deepest stack", "bytes", Some(measurements.predicted_stack_margin.into()), AtLeast(400.0), None),
        wall_row("ten simulated minutes", "s", measurements.wall_s, AtMost(MAX_WALL_S)),
        wall_row("  times faster than a board", "", LONG_RUN_S / measurements.wall_s, Bound::None),
    ];
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_over_budget_only_beyond_its_bound() {
        let row = |measured: Option<f64>, budget| BudgetRow {
            name: "",
            unit: "",
            measured,
            budget,
            servo_library: None,
            is_machine_dependent: false,
        };
        for (measured, budget, is_within_budget) in [
            (Some(3.0), Bound::AtMost(3.0), true),
            (Some(3.1), Bound::AtMost(3.0), false),
            (Some(3.0), Bound::AtLeast(3.0), true),
            (Some(2.9), Bound::AtLeast(3.0), false),
            (Some(1e9), Bound::None, true),
            (None, Bound::AtLeast(3.0), true),
        ] {
            let row = row(measured, budget);
            assert_eq!(
                row.is_within_budget(),
                is_within_budget,
                "{measured:?} {budget:?}"
            );
        }
    }
}
