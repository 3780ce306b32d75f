//! The simulated UNO against the data sheet, part by part: programs whose result follows
//! by counting cycles.

mod adc;
mod brown_out;
mod disturbed;
mod eeprom;
mod hex;
mod instructions;
mod interrupts;
mod power_cut;
mod resets;
mod say;
mod serial;
mod watchdog;

use simulated_uno::{Fidelity, Pin, ResetCause, Uno};

const BOTH: [Fidelity; 2] = [Fidelity::Stock, Fidelity::DataSheet];
const LED: Pin = Pin::d(13);

/// What the program has written to GPIOR0.
fn marks(uno: &Uno) -> Vec<u8> {
    uno.marks().iter().map(|mark| mark.value).collect()
}

fn causes(uno: &Uno) -> Vec<ResetCause> {
    uno.reset_events().iter().map(|reset| reset.cause).collect()
}
