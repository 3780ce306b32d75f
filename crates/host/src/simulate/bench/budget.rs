//! Budgets: the limits of the figures, and the figures of the Arduino Servo library.

use lizard_core::numbers::section::{SPACE, START};
use serde::Serialize;

use super::Figures;

/// The budget of a figure.
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

/// A figure and its budget.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// The name of the figure.
    pub what: &'static str,
    /// The unit of the figure.
    pub unit: &'static str,
    /// The figure; `None` if it could not be measured.
    pub measured: Option<f64>,
    /// The budget of the figure.
    pub budget: Bound,
    /// The figure of the Arduino Servo library, described by `SERVO_LIBRARY`; `None` if it is not known.
    pub servo_library: Option<&'static str>,
    /// True for a figure that depends on the machine that it is measured on.
    pub wall_clock: bool,
}

impl Row {
    /// True if the figure is within its budget; a figure that was not measured passes.
    pub fn is_met(&self) -> bool {
        self.measured.is_none_or(|measured| match self.budget {
            Bound::AtMost(max) => measured <= max,
            Bound::AtLeast(min) => measured >= min,
            Bound::None => true,
        })
    }
}

/// Description of the column with the figures of the Arduino Servo library.
pub const SERVO_LIBRARY: &str = "Arduino Servo 1.3.0 (core 1.8.8, ATmega328P at 16 MHz) with four servos at a constant \
     1500 us; its float solve is theta2 and theta3 of head and tail";

/// Cycles from the control tick to the end of its slot, when the interrupts take the next frame.
const TICK_DEADLINE: f64 = 63_000.0;
/// The share of all cycles that interrupts leave to main while the line is saturated in both directions.
const MAIN_SHARE: f64 = 0.87;
/// Budgets of the control tick, mean and worst, cycles.
const TICK_BUDGET: [f64; 2] = [5_000.0, 10_000.0];
/// Budgets of the control tick, mean and worst, cycles, for a robot whose gaits leave no room for the maps of
/// certified cells, so that the guard measures every pose.
const TICK_BUDGET_WITHOUT_MAPS: [f64; 2] = [20_000.0, 20_000.0];
/// Longest time that another interrupt may take without delaying a servo's edge, cycles: the servo interrupts start
/// 220 cycles early and need 60 of them before they read the timer.
const MAX_OTHER_INTERRUPT: f64 = 160.0;
/// Wall time that ten simulated minutes may take, s.
const MAX_RUN_S: f64 = 60.0;
/// Ten minutes, s.
const LONG_RUN_S: f64 = 600.0;

/// The table of all figures.
pub fn rows(figures: &Figures) -> Vec<Row> {
    use Bound::{AtLeast, AtMost};
    let row = |what, unit, measured, budget, servo_library| Row {
        what,
        unit,
        measured,
        budget,
        servo_library,
        wall_clock: false,
    };
    let wall_row = |what, unit, measured, budget| Row {
        wall_clock: true,
        ..row(what, unit, Some(measured), budget, None)
    };
    let to_f64 = |figure: Option<u64>| figure.map(|figure| figure as f64);
    let count = |figure: u64| Some(figure as f64);
    let [tick_mean, tick_worst] = if figures.has_maps {
        TICK_BUDGET
    } else {
        TICK_BUDGET_WITHOUT_MAPS
    };
    #[rustfmt::skip]
    let table = vec![
        row("pulse jitter, idle line", "cycles", to_f64(figures.jitter_idle), AtMost(0.0), Some("77-113")),
        row("pulse jitter, line saturated", "cycles", to_f64(figures.jitter_flooded), AtMost(0.0), Some("121-135")),
        row("width less command, worst", "cycles", to_f64(figures.width_error), AtMost(0.0), None),
        row("width resolution", "cycles", to_f64(figures.resolution), AtMost(1.0), Some("16")),
        row("period less 20 ms, worst", "cycles", count(figures.period_error), AtMost(0.0), None),
        row("servo pins high at once", "", count(figures.pins_high.into()), AtMost(1.0), None),
        row("late edges counted", "", count(figures.late), AtMost(0.0), None),
        row("bytes lost, sender waits", "bytes", count(figures.lost), AtMost(0.0), None),
        row("control tick, mean in any gait", "cycles", figures.tick_mean, AtMost(tick_mean), None),
        row("  of which the guard", "cycles", figures.guard, Bound::None, Some("35 400, float solve")),
        row("control tick, worst", "cycles", count(figures.tick_worst), AtMost(tick_worst), None),
        row("  in a routine, mean", "cycles", figures.routine_mean, AtMost(tick_mean), None),
        row("  in a routine, worst", "cycles", to_f64(figures.routine_worst), AtMost(tick_worst), None),
        row("tick to frame, line saturated", "cycles", count(figures.tick_latency), AtMost(TICK_DEADLINE), None),
        row("any other step, worst", "cycles", count(figures.step), AtMost(MAIN_SHARE * TICK_DEADLINE - tick_worst), None),
        row("main, mean per frame of a gait", "cycles", figures.main, Bound::None, None),
        row("servo interrupts per frame", "cycles", Some(figures.servo_interrupts), Bound::None, Some("1 513")),
        row("longest serial interrupt", "cycles", count(figures.serial_interrupt), AtMost(MAX_OTHER_INTERRUPT), None),
        row("CPU asleep in a gait", "%", figures.asleep, AtLeast(90.0), Some("0")),
        row("flash, code", "bytes", count(figures.code.into()), AtMost(START.into()), Some("5 994")),
        row("flash, the robot's section", "bytes", count(figures.section.into()), AtMost(SPACE.into()), None),
        row("static RAM", "bytes", count(figures.static_ram.into()), AtMost(900.0), Some("365")),
        row("between stack and static RAM", "bytes", count(figures.stack_spare.into()), AtLeast(400.0), None),
        row("  with the deepest stack", "bytes", Some(figures.stack_margin.into()), AtLeast(400.0), None),
        wall_row("ten simulated minutes", "s", figures.wall, AtMost(MAX_RUN_S)),
        wall_row("  times faster than a board", "", LONG_RUN_S / figures.wall, Bound::None),
    ];
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_on_its_bound_is_met_and_beyond_is_not() {
        let row = |measured: Option<f64>, budget| Row {
            what: "",
            unit: "",
            measured,
            budget,
            servo_library: None,
            wall_clock: false,
        };
        for (measured, budget, is_met) in [
            (Some(3.0), Bound::AtMost(3.0), true),
            (Some(3.1), Bound::AtMost(3.0), false),
            (Some(3.0), Bound::AtLeast(3.0), true),
            (Some(2.9), Bound::AtLeast(3.0), false),
            (Some(1e9), Bound::None, true),
            (None, Bound::AtLeast(3.0), true),
        ] {
            let row = row(measured, budget);
            assert_eq!(row.is_met(), is_met, "{measured:?} {budget:?}");
        }
    }
}
