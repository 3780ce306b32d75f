//! Tests of the simulated UNO against the data sheet, with programs whose cycles can be counted by hand. Each module
//! tests a part of the chip.

mod adc;
mod brown_out;
mod contacts;
mod disturbance;
mod eeprom;
mod hex;
mod instructions;
mod interrupts;
mod power_cut;
mod resets;
mod say;
mod serial;
mod watchdog;

use simulated_uno::ResetCause::{self, BrownOut, External, PowerOn, Watchdog};
use simulated_uno::avr_gcc::{assemble, assemble_at, compile_c};
use simulated_uno::{
    CYCLES_PER_MS, CYCLES_PER_US, Call, EEPROM_SIZE, EepromMode, Fidelity, Image, Pin, PowerCut,
    Pulse, SRAM_END, SRAM_START, State, Uno, max_pins_high,
};

/// The pin of the LED on the board.
const LED: Pin = Pin::d(13);
const FIDELITIES: [Fidelity; 2] = [Fidelity::Stock, Fidelity::DataSheet];

/// Returns a UNO of each fidelity with this program, after a number of cycles.
fn unos_after(cycles: u64, image: &Image) -> [Uno; 2] {
    FIDELITIES.map(|fidelity| {
        let mut uno = Uno::with_image(image.clone(), fidelity);
        uno.run_cycles(cycles);
        uno
    })
}

/// Failure message of an assertion that stock simavr deviates from the data sheet. The assertion fails when simavr no
/// longer needs the correction.
const CORRECTION_IS_OBSOLETE: &str =
    "stock simavr now follows the data sheet here: drop the correction";

/// Returns a UNO of the data-sheet fidelity with this program, at power-on.
fn new_uno(image: Image) -> Uno {
    Uno::with_image(image, Fidelity::DataSheet)
}

/// Returns a UNO of the data-sheet fidelity with this program, after a number of cycles.
fn uno_after(cycles: u64, image: Image) -> Uno {
    let mut uno = new_uno(image);
    uno.run_cycles(cycles);
    uno
}

/// Returns a UNO of the data-sheet fidelity with this program, after a number of milliseconds.
fn uno_after_ms(ms: u64, image: Image) -> Uno {
    uno_after(ms * CYCLES_PER_MS, image)
}

/// Sets the supply voltage, mV, and runs for a number of milliseconds.
fn run_at_supply(uno: &mut Uno, mv: f64, ms: u64) {
    uno.set_supply_mv(mv);
    uno.run_ms(ms);
}

/// Returns the bytes that the program has written to GPIOR0.
fn mark_values(uno: &Uno) -> Vec<u8> {
    uno.marks().iter().map(|mark| mark.value).collect()
}

/// Returns the cycles at which the program has written to GPIOR0.
fn mark_cycles(uno: &Uno) -> Vec<u64> {
    uno.marks().iter().map(|mark| mark.cycle).collect()
}

/// Returns the number of cycles from each event to the next.
fn intervals(cycles: &[u64]) -> Vec<u64> {
    cycles.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

/// Returns the widths of the pulses on the LED's pin, in cycles.
fn pulse_widths(uno: &Uno) -> Vec<u64> {
    uno.pulses(LED).iter().map(|pulse| pulse.width).collect()
}

/// Returns the edges of all pins: for each edge the pin's Arduino number, and true if the edge is rising.
fn numbered_edges(uno: &Uno) -> Vec<(u8, bool)> {
    let edges = uno.edges().into_iter();
    let numbered_edges = edges.map(|edge| (edge.pin.number(), edge.is_rising));
    numbered_edges.collect()
}

/// Returns the cycles at which the bytes that the program has sent on the serial line end.
fn transmission_cycles(uno: &Uno) -> Vec<u64> {
    uno.transmitted().iter().map(|byte| byte.cycle).collect()
}

/// Returns the bytes that the program has sent on the serial line.
fn transmitted_bytes(uno: &Uno) -> Vec<u8> {
    uno.transmitted().iter().map(|byte| byte.value).collect()
}

/// Returns the causes of all starts of the program, the first power-on included.
fn reset_causes(uno: &Uno) -> Vec<ResetCause> {
    uno.reset_events().iter().map(|reset| reset.cause).collect()
}

/// Compiles C source with the headers of registers, interrupts, the watchdog and delays.
fn compile_with_headers(source: &str) -> Image {
    let names = ["avr/io.h", "avr/interrupt.h", "avr/wdt.h", "util/delay.h"];
    let headers = names.map(|name| format!("#include <{name}>\n"));
    compile_c(&(headers.concat() + source))
}

/// Assembles these instructions, followed by an endless loop.
fn assemble_loop(instructions: &str) -> Image {
    assemble(&format!("{instructions}\nend: rjmp end"))
}

/// Compiles a program whose main function runs these statements once.
fn compile_statements(body: &str) -> Image {
    compile_with_headers(&format!("int main(void) {{ {body} for (;;) {{}} }}"))
}

/// Compiles a program that receives at 115 200 baud and runs these statements in the interrupt of each byte.
fn compile_receiver(body: &str) -> Image {
    compile_with_headers(&format!(
        "ISR(USART_RX_vect) {{ {body} }}
        int main(void) {{ UCSR0A = 2; UBRR0 = 16; UCSR0B = 0x90; sei(); for (;;) {{}} }}"
    ))
}

#[track_caller]
fn assert_within(range: std::ops::Range<u64>, cycles: u64) {
    let is_within = range.contains(&cycles);
    assert!(is_within, "{cycles} cycles, expected {range:?}");
}
