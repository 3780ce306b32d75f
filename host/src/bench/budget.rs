//! Budgets: what the figures may be, and what the Arduino Servo library's are.

use serde::Serialize;

use super::Figures;

/// What a figure must keep to.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Bound {
    /// It may be this large.
    AtMost(f64),
    /// It may be this small.
    AtLeast(f64),
    /// There is no budget for it.
    None,
}

/// A figure and its budget.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// What was measured.
    pub what: &'static str,
    /// In which unit.
    pub unit: &'static str,
    /// The figure.
    pub measured: f64,
    /// Its budget.
    pub budget: Bound,
    /// The same figure of Arduino Servo 1.3.0 with four servos at a constant
    /// 1500 us, where there is one; see [`SERVO_LIBRARY`].
    pub servo_library: Option<&'static str>,
    /// True for a figure that depends on the machine that it is measured on.
    pub wall_clock: bool,
}

impl Row {
    /// Whether the figure keeps to its budget.
    #[must_use]
    pub fn is_met(&self) -> bool {
        match self.budget {
            Bound::AtMost(most) => self.measured <= most,
            Bound::AtLeast(least) => self.measured >= least,
            Bound::None => true,
        }
    }
}

/// What the right-hand column is about.
pub const SERVO_LIBRARY: &str = "Arduino Servo 1.3.0 (core 1.8.8, ATmega328P at 16 MHz) with four servos at a constant \
     1500 us; its float solve is theta2 and theta3 of head and tail";

/// Cycles from the tick to the end of its slot, where the next frame is taken.
const IN_TIME: f64 = 63_000.0;
/// What the servo interrupts leave to the others: their lead of 220 cycles, less
/// the 60 that they need themselves before they read the timer.
const BESIDE_SERVOS: f64 = 160.0;
/// Wall time that ten simulated minutes may take, s.
const PATIENCE: f64 = 60.0;
/// Ten minutes, s.
const LONG: f64 = 600.0;

/// The table.
#[must_use]
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
    let wall = |what, unit, measured, budget| Row {
        wall_clock: true,
        ..row(what, unit, measured, budget, None)
    };
    let f = figures;
    #[rustfmt::skip]
    let table = vec![
        row("pulse jitter, idle line", "cycles", f.jitter_idle as f64, AtMost(0.0), Some("77-113")),
        row("pulse jitter, line saturated", "cycles", f.jitter_flooded as f64, AtMost(0.0), Some("121-135")),
        row("width less command, worst", "cycles", f.width_error as f64, AtMost(0.0), None),
        row("width resolution", "cycles", f.resolution as f64, AtMost(1.0), Some("16")),
        row("period less 20 ms, worst", "cycles", f.period_error as f64, AtMost(0.0), None),
        row("servo pins high at once", "", f64::from(f.pins_high), AtMost(1.0), None),
        row("late edges counted", "", f.late as f64, AtMost(0.0), None),
        row("bytes lost, sender waits", "bytes", f.lost as f64, AtMost(0.0), None),
        row("control tick, mean in walk", "cycles", f.tick_mean, AtMost(8_000.0), None),
        row("  of which the guard", "cycles", f.guard, Bound::None, Some("35 400, float solve")),
        row("control tick, worst", "cycles", f.tick_worst as f64, AtMost(12_000.0), None),
        row("tick to frame, line saturated", "cycles", f.tick_latency as f64, AtMost(IN_TIME), None),
        row("main, mean per frame of walk", "cycles", f.main, Bound::None, None),
        row("servo interrupts per frame", "cycles", f.servo_interrupts, Bound::None, Some("1 513")),
        row("longest serial interrupt", "cycles", f.serial_interrupt as f64, AtMost(BESIDE_SERVOS), None),
        row("CPU asleep in walk", "%", f.asleep, AtLeast(90.0), Some("0")),
        row("flash", "bytes", f64::from(f.flash), AtMost(16_384.0), Some("5 994")),
        row("static RAM", "bytes", f64::from(f.static_ram), AtMost(640.0), Some("365")),
        row("between stack and static RAM", "bytes", f64::from(f.stack_spare), AtLeast(512.0), None),
        wall("ten simulated minutes", "s", f.wall, AtMost(PATIENCE)),
        wall("  times faster than a board", "", LONG / f.wall, Bound::None),
    ];
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_on_its_bound_is_met_and_beyond_is_not() {
        let row = |measured, budget| Row {
            what: "",
            unit: "",
            measured,
            budget,
            servo_library: None,
            wall_clock: false,
        };
        for (measured, budget, met) in [
            (3.0, Bound::AtMost(3.0), true),
            (3.1, Bound::AtMost(3.0), false),
            (3.0, Bound::AtLeast(3.0), true),
            (2.9, Bound::AtLeast(3.0), false),
            (1e9, Bound::None, true),
        ] {
            assert_eq!(row(measured, budget).is_met(), met, "{measured} {budget:?}");
        }
    }
}
