//! Tests that some pulses never occur: pulses too wide or too narrow for a slot, and any rising edge
//! after `pulses::ALLOWED` is cleared, which ends the pulses for good.

use lizard_host::sim::frame::FRAME;

use crate::walk::{ReferenceRun, SLOT_CYCLES};
use crate::{Status, neutral_widths, run_in_both_simulations};

/// Widths that fit into a slot, cycles.
const WIDTHS: std::ops::RangeInclusive<u16> = 1_000..=63_000;

#[test]
fn a_width_that_a_slot_has_no_room_for_gives_no_pulse() {
    run_in_both_simulations(|fidelity| {
        let mut walk = ReferenceRun::start_standing(fidelity);
        // `FRAMES` holds two sets of four widths, two bytes each. A3's width is the third of each set.
        let frames_address = walk.address("pulses::FRAMES");
        let a3_addresses = [frames_address + 4, frames_address + 12];
        let widths = [
            1, 219, 220, 221, 999, 1_000, 1_001, 30_000, 62_999, 63_000, 63_001, 63_780, 63_781,
            63_999, 64_000, 65_315, 65_535,
        ];
        for width in widths {
            let start = walk.next_frame();
            // This is after the frame's widths are handed over and before A3's slot is planned.
            walk.run_to(start + 2_000);
            for (address, index) in a3_addresses.into_iter().flat_map(|a| [(a, 0), (a + 1, 1)]) {
                let byte_before = u16::from(walk.bench.uno.peek(address));
                let neutral_byte = (neutral_widths()[2] as u16).to_le_bytes()[index];
                assert_eq!(byte_before, u16::from(neutral_byte), "where A3's width is");
                walk.bench.uno.poke(address, u16::to_le_bytes(width)[index]);
            }
            walk.run_to(start + FRAME - SLOT_CYCLES / 2);
            let (frame, expected_widths) = walk.frames_since(start)[0];
            let expected = WIDTHS.contains(&width).then_some(u64::from(width));
            assert_eq!(frame.widths[2], expected, "{width}");
            for servo in [0, 1, 3] {
                assert_eq!(frame.widths[servo], Some(expected_widths[servo]), "{width}");
            }
            walk.bench.run_ms(40);
        }
        assert_eq!(walk.late_edge_count(), 0);
    });
}

#[test]
fn after_the_switch_only_the_pulse_under_way_ends_and_the_tick_goes_on() {
    run_in_both_simulations(|fidelity| {
        // Moments in every part of a frame: before, in and after each pulse.
        for n in 0..40 {
            let mut walk = ReferenceRun::start_standing(fidelity);
            let start = walk.next_frame();
            walk.run_to(start + n * FRAME / 40 + 777);
            let switch_cycle = walk.bench.uno.cycle();
            let switch_address = walk.address("pulses::ALLOWED");
            walk.bench.uno.poke(switch_address, 0);
            let frames_before = Status::of(&mut walk.bench).number("frames");
            walk.bench.run_ms(1000);
            for edge in crate::pulses::servo_edges(&walk.bench) {
                // One cycle of tolerance, for a store that is already executing.
                assert!(
                    !edge.high || edge.cycle <= switch_cycle + 1,
                    "{n}: {edge:?}"
                );
            }
            for (pin, neutral) in walk.bench.pins().into_iter().zip(neutral_widths()) {
                for pulse in walk.bench.uno.pulses(pin) {
                    assert_eq!(pulse.width, neutral, "{n}: {pin}");
                }
                assert!(!walk.bench.uno.is_high(pin), "{n}: {pin}");
            }
            let ticks = Status::of(&mut walk.bench).number("frames") - frames_before;
            assert!((50.0..=52.0).contains(&ticks), "{ticks} ticks in a second");
        }
    });
}
