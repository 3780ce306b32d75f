//! Supply voltages and contacts of a simulated UNO on a healthy robot.
//!
//! The firmware stops the pulses when a supply voltage is too low. A simulated board therefore needs the divided
//! voltage of the servo rail at the pin that robot.toml names, in addition to its own 5 V.

use lizard_core::control::supply::Reading;
use lizard_core::numbers::supplies::Supplies;
use lizard_robot::{Robot, healthy_rail_pin_mv};
use simulated_uno::{Pin, Uno};

/// The board's supply, mV.
const BOARD_MV: f64 = 5_000.0;
/// Counts of the analogue-to-digital converter at full scale.
const FULL_SCALE_COUNTS: f64 = 1_024.0;

/// Returns the analogue pin that measures the servo rail, and the voltage at this pin with a healthy rail, mV. `None`
/// if no pin measures the rail.
pub fn find_healthy_rail_input(robot: &Robot) -> Option<(Pin, u16)> {
    let mv = healthy_rail_pin_mv(&robot.firmware().supplies())?;
    Some((Pin::arduino(robot.firmware().rail_pin()?), mv as u16))
}

/// Sets the UNO's reference voltage, and connects the healthy servo rail and the open contacts.
pub fn connect_healthy_robot(uno: &mut Uno, robot: &Robot) {
    uno.set_bandgap_mv(robot.supplies().reference_volts * 1_000.0);
    if let Some((pin, mv)) = find_healthy_rail_input(robot) {
        uno.set_analog_mv(pin, mv);
    }
    for (_, pin) in robot.inputs().named_pins() {
        uno.set_contact(Pin::arduino(pin), false);
    }
}

/// Returns the analogue-to-digital converter's readings of healthy supplies.
pub(super) fn healthy_reading(supplies: &Supplies) -> Reading {
    let to_counts = |mv: f64| (FULL_SCALE_COUNTS * mv / BOARD_MV) as u16;
    Reading {
        reference: to_counts(f64::from(supplies.reference_mv)),
        rail: healthy_rail_pin_mv(supplies).map_or(0, to_counts),
    }
}
