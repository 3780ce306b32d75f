//! The lengths of slots, frames and pulses.

/// Cycles from the compare match until the handler stops waiting; the edge follows a fixed time later. At most 255,
/// because the handler counts the wait in one byte.
pub const LEAD_CYCLES: u8 = 220;

/// CPU cycles in a microsecond: the CPU runs at 16 MHz, and Timer1 counts each cycle.
pub const CYCLES_PER_US: u16 = 16;

/// The shortest possible pulse, in cycles. It equals the margin at either end of a slot.
pub const MIN_WIDTH_CYCLES: u16 = MARGIN_CYCLES;

/// Cycles (62.5 us) after the start and before the end of a slot that are reserved for the engine's two handlers and
/// for interrupts that delay them.
const MARGIN_CYCLES: u16 = 1_000;

/// The period of 20 ms that a servo expects between pulses, in cycles.
const FRAME_CYCLES: u32 = 320_000;

/// The shortest slot, 2.5 ms: its longest pulse, 2.4375 ms, is beyond any servo's travel.
const MIN_SLOT_CYCLES: u32 = 40_000;

/// The longest slot, 4 ms, as with four servos.
const MAX_SLOT_CYCLES: u32 = 64_000;

/// The length of a slot in cycles, with this many servos. The servos' slots and one slot without a pin, which opens
/// with the tick, share 20 ms. A slot takes at least 2.5 ms, so a frame with eight servos takes 22.5 ms; it takes at
/// most 4 ms, so a frame with three servos takes 16 ms.
///
/// # Panics
/// Panics, at compile time, if there are no servos or more than eight.
#[must_use]
pub const fn slot_cycles(servos: usize) -> u16 {
    assert!(
        1 <= servos && servos <= 8,
        "an engine has one to eight servos"
    );
    let even_share = FRAME_CYCLES / (servos as u32 + 1);
    // With fewer than four servos, an even share of the frame does not fit into 16 bits.
    if even_share > MAX_SLOT_CYCLES {
        return MAX_SLOT_CYCLES as u16;
    }
    if even_share < MIN_SLOT_CYCLES {
        return MIN_SLOT_CYCLES as u16;
    }
    even_share as u16
}

/// Cycles from one pulse of a servo to its next.
///
/// # Panics
/// Panics as [`slot_cycles`] does.
#[must_use]
pub const fn frame_cycles(servos: usize) -> u32 {
    (servos as u32 + 1) * slot_cycles(servos) as u32
}

/// The longest possible pulse, in cycles.
///
/// # Panics
/// Panics as [`slot_cycles`] does.
#[must_use]
pub const fn max_width_cycles(servos: usize) -> u16 {
    slot_cycles(servos) - MARGIN_CYCLES
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn with_four_to_seven_servos_a_frame_takes_20_ms_within_half_a_microsecond() {
        assert_eq!(frame_cycles(4), 320_000);
        for servos in 4..=7 {
            assert!(
                frame_cycles(servos).abs_diff(320_000) < 8,
                "{servos} servos"
            );
        }
    }

    #[test]
    fn any_number_of_servos_gets_pulses_of_up_to_2_4_ms_every_8_to_22_5_ms() {
        for servos in 1..=8 {
            assert!(
                max_width_cycles(servos) >= 2_400 * CYCLES_PER_US,
                "{servos} servos"
            );
            // Analogue servos accept a pulse every 8 to 22.5 ms.
            let ms = f64::from(frame_cycles(servos)) / 16_000.0;
            assert!((8.0..=22.5).contains(&ms), "{servos} servos: {ms} ms");
        }
    }

    #[test]
    #[should_panic(expected = "one to eight servos")]
    fn nine_servos_are_refused() {
        let _ = slot_cycles(9);
    }
}
