//! Small functions that many tests need.

use simulated_uno::{Pin, SerialByte, Uno};

/// Checks that a text contains a part.
///
/// # Panics
/// If the part is missing. The message contains the whole text.
#[track_caller]
pub fn assert_contains(text: &str, part: &str) {
    assert!(text.contains(part), "no {part:?} in {text}");
}

/// Returns bytes from the serial line as a text.
pub fn decode_text(bytes: &[SerialByte]) -> String {
    let bytes: Vec<u8> = bytes.iter().map(|byte| byte.value).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Returns the widths of a pin's recorded pulses, in cycles.
pub fn pulse_widths(uno: &Uno, pin: Pin) -> Vec<u64> {
    uno.pulses(pin).iter().map(|pulse| pulse.width).collect()
}

/// Returns the cycles that the handlers of Timer1's compare matches have taken since power-on.
pub fn timer1_handler_cycles(uno: &Uno) -> u64 {
    let handlers = uno.interrupt_stats().into_iter();
    // TIMER1_COMPA and TIMER1_COMPB.
    let handlers = handlers.filter(|handler| [11, 12].contains(&handler.vector));
    handlers.map(|handler| handler.cycles).sum()
}
