//! The default supplies and contacts of a simulated UNO.
//!
//! The firmware ends the pulses when a supply is too low. So a simulated board needs,
//! besides its own 5 V, the voltage that it measures according to robot.toml: the servos'
//! rail through its divider.

use lizard_core::control::supply::Reading;
use lizard_core::numbers::supplies::Supplies;
use lizard_robot::{Robot, healthy_rail_mv};
use simulated_uno::{Pin, Uno};

/// The board's supply, mV.
const BOARD_MV: f64 = 5_000.0;
/// ADC counts at full scale.
const FULL_SCALE: f64 = 1_024.0;

/// The analogue pin that measures the servos' rail, and the voltage at that pin, mV. `None` if
/// no pin measures the rail.
pub fn rail_pin(robot: &Robot) -> Option<(Pin, u16)> {
    let mv = healthy_rail_mv(&robot.firmware().supplies())?;
    Some((Pin::arduino(robot.firmware().rail_pin()?), mv as u16))
}

/// Gives the UNO the supplies of a healthy robot, and its contacts, all open.
pub fn connect(uno: &mut Uno, robot: &Robot) {
    uno.set_bandgap_mv(robot.supplies().reference * 1_000.0);
    if let Some((pin, mv)) = rail_pin(robot) {
        uno.set_analog_mv(pin, mv);
    }
    for (_, pin) in robot.inputs().each() {
        uno.set_contact(Pin::arduino(pin), false);
    }
}

/// The analogue-to-digital converter's readings of healthy supplies.
pub(super) fn reading(supplies: &Supplies) -> Reading {
    let counts_of = |mv: f64| (FULL_SCALE * mv / BOARD_MV) as u16;
    Reading {
        reference: counts_of(f64::from(supplies.reference)),
        rail: healthy_rail_mv(supplies).map_or(0, counts_of),
    }
}
