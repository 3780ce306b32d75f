//! The simulated UNO against the data sheet, part by part, and against the core.

mod adc;
mod bench;
mod brown_out;
mod core_run;
mod disturbed;
mod eeprom;
mod instructions;
mod interrupts;
mod power_cut;
mod resets;
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
