//! Tests of the simulated UNO against the data sheet, one module for each part of the chip, with programs whose
//! cycles can be counted by hand.

mod adc;
mod brown_out;
mod contacts;
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

use simulated_uno::{CYCLES_PER_MS, Fidelity, Image, Pin, ResetCause, Uno};

const LED: Pin = Pin::d(13);
const BOTH: [Fidelity; 2] = [Fidelity::Stock, Fidelity::DataSheet];

/// Returns a UNO of each fidelity with this program, after a number of cycles.
fn both_after(cycles: u64, image: &Image) -> [Uno; 2] {
    BOTH.map(|fidelity| {
        let mut uno = Uno::with_image(image.clone(), fidelity);
        uno.run_cycles(cycles);
        uno
    })
}

/// Failure message of a test that stock simavr has an error. The test fails if simavr no longer needs the correction.
const FIXED: &str = "stock simavr now follows the data sheet here: drop the correction";

/// Returns a UNO with this program, corrected by the data sheet, at power-on.
fn uno(image: Image) -> Uno {
    Uno::with_image(image, Fidelity::DataSheet)
}

/// Returns a UNO with this program, corrected by the data sheet, after a number of cycles.
fn after(cycles: u64, image: Image) -> Uno {
    let mut uno = uno(image);
    uno.run_cycles(cycles);
    uno
}

/// Returns a UNO with this program, corrected by the data sheet, after a number of milliseconds.
fn after_ms(ms: u64, image: Image) -> Uno {
    after(ms * CYCLES_PER_MS, image)
}

/// Returns the bytes that the program has written to GPIOR0.
fn marks(uno: &Uno) -> Vec<u8> {
    uno.marks().iter().map(|mark| mark.value).collect()
}

/// Returns the cycles at which the program has written to GPIOR0.
fn mark_cycles(uno: &Uno) -> Vec<u64> {
    uno.marks().iter().map(|mark| mark.cycle).collect()
}

/// Returns the number of cycles from each event to the next.
fn distances(cycles: &[u64]) -> Vec<u64> {
    cycles.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

/// Returns the widths of the pulses on the LED's pin, cycles.
fn widths(uno: &Uno) -> Vec<u64> {
    uno.pulses(LED).iter().map(|pulse| pulse.width).collect()
}

/// Returns the edges of all pins: for each edge the pin's Arduino number, and true if the edge is rising.
fn edges(uno: &Uno) -> Vec<(u8, bool)> {
    let edges = uno.edges();
    edges
        .iter()
        .map(|edge| (edge.pin.number(), edge.high))
        .collect()
}

/// Returns the bytes that the program has transmitted on the serial line.
fn text(uno: &Uno) -> Vec<u8> {
    uno.transmitted().iter().map(|byte| byte.byte).collect()
}

/// Returns the causes of all starts of the program, the first power-on included.
fn causes(uno: &Uno) -> Vec<ResetCause> {
    uno.reset_events().iter().map(|reset| reset.cause).collect()
}
