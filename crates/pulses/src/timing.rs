//! The lengths of slots, frames and pulses.

/// Cycles from the compare match until the handler stops waiting; the edge follows after a fixed time. At most 255,
/// because the handler counts the wait in one byte.
pub const LEAD_CYCLES: u8 = 220;

/// CPU cycles in a microsecond at 16 MHz; Timer1 counts each cycle.
pub const CYCLES_PER_US: u16 = 16;

/// The shortest possible pulse, in cycles, which equals the margin at either end of a slot.
pub const MIN_WIDTH_CYCLES: u16 = MARGIN_CYCLES;

/// Cycles after the start and before the end of a slot (62.5 us each) that are reserved for the engine's two handlers
/// and for interrupts that delay them.
const MARGIN_CYCLES: u16 = 1_000;

/// The nominal period of a servo's pulses, 20 ms, in cycles.
const NOMINAL_FRAME_CYCLES: u32 = 320_000;

/// The shortest slot, 2.5 ms, in cycles. Its longest pulse, 2.4375 ms, is beyond any servo's travel.
const MIN_SLOT_CYCLES: u32 = 40_000;

/// The longest slot, 4 ms as with four servos, in cycles.
const MAX_SLOT_CYCLES: u32 = 64_000;

/// Returns the length of a slot in cycles for a number of servos. A frame of 20 ms consists of a slot for each servo
/// and one slot without a pin, at whose start the tick occurs. A slot lasts at least 2.5 ms, so a frame with eight
/// servos lasts 22.5 ms, and at most 4 ms, so a frame with three servos lasts 16 ms.
///
/// # Panics
/// Panics, at compile time, if there are no servos or more than eight.
#[must_use]
pub const fn slot_cycles(servo_count: usize) -> u16 {
    assert!(
        1 <= servo_count && servo_count <= 8,
        "an engine has one to eight servos"
    );
    let equal_slot_cycles = NOMINAL_FRAME_CYCLES / (servo_count as u32 + 1);
    // With fewer than four servos, an equal part of the frame does not fit into 16 bits.
    if equal_slot_cycles > MAX_SLOT_CYCLES {
        return MAX_SLOT_CYCLES as u16;
    }
    if equal_slot_cycles < MIN_SLOT_CYCLES {
        return MIN_SLOT_CYCLES as u16;
    }
    equal_slot_cycles as u16
}

/// Returns the number of cycles from a servo's pulse to its next pulse.
///
/// # Panics
/// Panics as [`slot_cycles`] does.
#[must_use]
pub const fn frame_cycles(servo_count: usize) -> u32 {
    (servo_count as u32 + 1) * slot_cycles(servo_count) as u32
}

/// Returns the longest possible pulse, in cycles.
///
/// # Panics
/// Panics as [`slot_cycles`] does.
#[must_use]
pub const fn max_width_cycles(servo_count: usize) -> u16 {
    slot_cycles(servo_count) - MARGIN_CYCLES
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_of_four_to_seven_servos_takes_20_ms_within_half_a_microsecond() {
        assert_eq!(frame_cycles(4), 320_000);
        for servo_count in 4..=7 {
            let error = frame_cycles(servo_count).abs_diff(320_000);
            assert!(error < 8, "{servo_count} servos");
        }
    }

    #[test]
    fn any_servo_count_allows_pulses_of_2_4_ms_every_8_to_22_5_ms() {
        for servo_count in 1..=8 {
            let max_cycles = max_width_cycles(servo_count);
            assert!(max_cycles >= 2_400 * CYCLES_PER_US, "{servo_count} servos");
            // Analogue servos accept a pulse every 8 to 22.5 ms.
            let ms = f64::from(frame_cycles(servo_count)) / 16_000.0;
            assert!((8.0..=22.5).contains(&ms), "{servo_count} servos: {ms} ms");
        }
    }

    #[test]
    #[should_panic(expected = "one to eight servos")]
    fn nine_servos_are_refused() {
        let _ = slot_cycles(9);
    }
}
