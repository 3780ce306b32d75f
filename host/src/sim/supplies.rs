//! The supplies of a simulated UNO that nobody has told otherwise.
//!
//! The firmware ends the pulses when a supply is too low. So a simulated board
//! needs, besides its own 5 V, whatever voltage robot.toml says it measures: the
//! servos' rail through its divider.

use lizard_core::robot::Robot as _;
use lizard_core::supply::{Rail, Reading, Supplies};
use lizard_robot::Robot;
use simulated_uno::{Pin, Uno};

/// The board's supply, mV.
const BOARD: f64 = 5_000.0;
/// How far above its highest threshold the servos' rail is at least, mV.
const RESERVE: f64 = 500.0;
/// Parts of the supply that the converter tells apart.
const FULL_SCALE: f64 = 1_024.0;

/// The voltage at the divider's output, mV: that of a rail of 5 V, or of one that is
/// well above the voltage at which the robot reacts.
fn divided(supplies: &Supplies, rail: &Rail) -> f64 {
    let ratio = f64::from(rail.reference) / f64::from(supplies.reference);
    let mv = f64::from(rail.thresholds.slow) + RESERVE;
    (mv.max(BOARD) / ratio).min(BOARD - 1.0)
}

/// The analogue pin that measures the servos' rail, and the voltage there, mV. None if
/// none does.
#[must_use]
pub fn at_pin(robot: &Robot) -> Option<(Pin, u16)> {
    let supplies = robot.firmware().supplies();
    let pin = Pin::arduino(robot.firmware().rail_pin()?);
    Some((pin, divided(&supplies, &supplies.rail?) as u16))
}

/// Gives the UNO the supplies of a robot in good order.
pub fn connect(uno: &mut Uno, robot: &Robot) {
    uno.set_bandgap_mv(robot.supplies().reference * 1_000.0);
    if let Some((pin, mv)) = at_pin(robot) {
        uno.set_analog_mv(pin, mv);
    }
}

/// What the converter reads of them.
pub(super) fn reading(supplies: &Supplies) -> Reading {
    let part = |mv: f64| (FULL_SCALE * mv / BOARD) as u16;
    Reading {
        reference: part(f64::from(supplies.reference)),
        rail: supplies
            .rail
            .map_or(0, |rail| part(divided(supplies, &rail).floor())),
    }
}
