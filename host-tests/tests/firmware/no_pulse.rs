//! Tests that no pulse is sent if its width does not fit into a slot, or after the firmware has cleared
//! `pulses::ALLOWED_PINS`, which disallows pulses permanently.

use lizard_host::sim::frame::FRAME_CYCLES;

use crate::measurements::peek_word;
use crate::pulses::servo_edges;
use crate::reference_run::{ReferenceRun, SLOT_CYCLES};
use crate::{Status, neutral_widths, run_in_both_simulations, start_in_both_simulations};

/// Pulse widths that fit into a slot, cycles.
const ALLOWED_WIDTHS: std::ops::RangeInclusive<u16> = 1_000..=63_000;

#[test]
fn a_width_that_does_not_fit_into_a_slot_gives_no_pulse() {
    start_in_both_simulations(ReferenceRun::start_standing, |mut run| {
        // `FRAMES` holds two sets of four widths, two bytes each. A3's width is the third of each set.
        let frames_address = run.variable_address("pulses::FRAMES");
        let a3_width_addresses = [frames_address + 4, frames_address + 12];
        let a3_neutral_width = neutral_widths()[2] as u16;
        let widths = [
            1, 219, 220, 221, 999, 1_000, 1_001, 30_000, 62_999, 63_000, 63_001, 63_780, 63_781,
            63_999, 64_000, 65_315, 65_535,
        ];
        for width in widths {
            let start = run.run_to_next_frame();
            // By now, the frame's widths have been handed over, and A3's slot is not yet scheduled.
            run.run_to(start + 2_000);
            let [low, high] = u16::to_le_bytes(width);
            for address in a3_width_addresses {
                let width_before = peek_word(&run.bench.uno, address);
                assert_eq!(
                    width_before, a3_neutral_width,
                    "the address of A3's width is wrong"
                );
                run.bench.uno.poke(address, low);
                run.bench.uno.poke(address + 1, high);
            }
            run.run_to(start + FRAME_CYCLES - SLOT_CYCLES / 2);
            let (frame, expected_widths) = run.frames_since(start)[0];
            let mut expected = expected_widths.map(Some);
            expected[2] = ALLOWED_WIDTHS.contains(&width).then_some(u64::from(width));
            assert_eq!(frame.widths, expected, "A3's width is {width}");
            run.bench.run_ms(40);
        }
        assert_eq!(run.late_edge_count(), 0);
    });
}

#[test]
fn disallowing_pulses_lets_the_current_pulse_end_and_the_ticks_continue() {
    run_in_both_simulations(|fidelity| {
        // Disallows pulses at 40 times in a frame: before, during and after each pulse.
        for moment in 0..40 {
            let mut run = ReferenceRun::start_standing(fidelity);
            let start = run.run_to_next_frame();
            run.run_to(start + moment * FRAME_CYCLES / 40 + 777);
            let clear_cycle = run.bench.uno.cycle();
            let allowed_address = run.variable_address("pulses::ALLOWED_PINS");
            run.bench.uno.poke(allowed_address, 0);
            let frames_before = Status::read(&mut run.bench).number("frames");
            run.bench.run_ms(1000);
            for edge in servo_edges(&run.bench) {
                // Allows one cycle for a store instruction that is already executing.
                let is_allowed = !edge.is_rising || edge.cycle <= clear_cycle + 1;
                assert!(is_allowed, "{moment}: {edge:?}");
            }
            let expected_widths = run.bench.pins().into_iter().zip(neutral_widths());
            for (slot, (pin, neutral)) in (0..).zip(expected_widths) {
                let pulses = run.bench.uno.pulses(pin);
                let has_begun = start + slot * SLOT_CYCLES <= clear_cycle;
                assert_eq!(pulses.len(), usize::from(has_begun), "{moment}: {pin}");
                for pulse in pulses {
                    assert_eq!(pulse.width, neutral, "{moment}: {pin}");
                }
                assert!(!run.bench.uno.is_high(pin), "{moment}: {pin}");
            }
            let ticks = Status::read(&mut run.bench).number("frames") - frames_before;
            assert!((50.0..=52.0).contains(&ticks), "{ticks} ticks in a second");
        }
    });
}
