//! The lengths of slots, frames and pulses.

/// Cycles from the compare match until the handler stops waiting; the edge follows a fixed
/// time later. At most 255, because the wait is counted in a byte.
pub const LEAD: u8 = 220;

/// CPU cycles in a microsecond, each counted by Timer1: the CPU runs at 16 MHz.
pub const CYCLES_PER_US: u16 = 16;

/// The shortest pulse that can be made, cycles: 62.5 us at either end of a slot are for
/// the two handlers and whatever they have to wait for.
pub const MIN_WIDTH: u16 = MARGIN;

const MARGIN: u16 = 1_000;

/// The 20 ms that a servo expects from one pulse to the next.
const FRAME_CYCLES: u32 = 320_000;

/// The shortest slot, 2.5 ms: its longest pulse, 2.4375 ms, is beyond any servo's travel.
const MIN_SLOT_CYCLES: u32 = 40_000;

/// The longest slot, 4 ms, as with four servos.
const MAX_SLOT_CYCLES: u32 = 64_000;

/// Cycles of a slot with this many servos: 20 ms shared by their slots and one slot without a
/// pin, which opens with the tick. But 2.5 ms at least, so that with eight servos a frame takes
/// 22.5 ms, and 4 ms at most, so that it takes 16 ms with three.
///
/// # Panics
/// If there is no servo or more than eight, while the program is compiled.
#[must_use]
pub const fn slot_cycles(servos: usize) -> u16 {
    assert!(
        1 <= servos && servos <= 8,
        "an engine has one to eight servos"
    );
    let even = FRAME_CYCLES / (servos as u32 + 1);
    // With fewer than four servos a slot would not fit 16 bits.
    if even > MAX_SLOT_CYCLES {
        return MAX_SLOT_CYCLES as u16;
    }
    if even < MIN_SLOT_CYCLES {
        return MIN_SLOT_CYCLES as u16;
    }
    even as u16
}

/// Cycles from one pulse of a servo to its next.
///
/// # Panics
/// Panics as [`slot_cycles`] does.
#[must_use]
pub const fn frame_cycles(servos: usize) -> u32 {
    (servos as u32 + 1) * slot_cycles(servos) as u32
}

/// The longest pulse that can be made, cycles.
///
/// # Panics
/// Panics as [`slot_cycles`] does.
#[must_use]
pub const fn max_width(servos: usize) -> u16 {
    slot_cycles(servos) - MARGIN
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn with_four_to_seven_servos_a_frame_is_20_ms_to_half_a_microsecond() {
        assert_eq!(frame_cycles(4), 320_000);
        for servos in 4..=7 {
            assert!(
                frame_cycles(servos).abs_diff(320_000) < 8,
                "{servos} servos"
            );
        }
    }

    #[test]
    fn a_slot_has_room_for_2_4_ms_for_any_number_of_servos() {
        for servos in 1..=8 {
            assert!(
                max_width(servos) >= 2_400 * CYCLES_PER_US,
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
