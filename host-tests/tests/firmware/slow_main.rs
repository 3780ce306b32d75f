//! Tests that stop the main loop at every instruction that shares data with an interrupt: during a frame's hand-over,
//! at the LED, in an answer, and before the loop sleeps.

use lizard_host::sim::frame::{FRAME_CYCLES, group_frames};
use lizard_host_tests::gait_commands;
use simulated_uno::{CYCLES_PER_MS, Fidelity, Uno};

use crate::measurements::{assert_gait_within_slew_limits, peek_word, recorded_pulses};
use crate::reference_run::{ReferenceRun, SLOT_CYCLES};
use crate::{
    Status, boot_and_command, boot_to_stand, for_each_in_parallel, start_in_both_simulations,
};

/// Upper bound of the cycles that the main loop takes to hand over a computed frame and to set the LED. The test tries
/// each delay up to this number twice, with three frames per delay. One pass over all delays has 57 * 32 frames, and
/// the LED changes every 32 frames, so its state in the second pass is the opposite of its state in the first.
const MAX_HAND_OVER_CYCLES: u64 = 608;

/// Waits until `Controller::compute_frame` has returned the frame whose A1 pulse begins at `rise_cycle`, waits another
/// `delay_cycles`, and then stalls the main loop until this pulse has begun.
fn stall_in_hand_over(run: &mut ReferenceRun, rise_cycle: u64, delay_cycles: u64) {
    run.run_to(rise_cycle - SLOT_CYCLES - 400);
    let uno = &mut run.bench.uno;
    let frame_function = uno.image().function("Controller::compute_frame");
    let entry_address = frame_function.expect("the ELF has the function").address as u32;
    assert!(uno.run_until(FRAME_CYCLES, 1, |uno| uno.pc() == entry_address));
    // The stack pointer is at 0x5d. The return address counts words, and its high byte comes first.
    let return_word = peek_word(uno, peek_word(uno, 0x5d) + 1).swap_bytes();
    let return_address = 2 * u32::from(return_word);
    assert!(uno.run_until(FRAME_CYCLES, 1, |uno| uno.pc() == return_address));
    uno.run_cycles(delay_cycles);
    uno.stall_main(rise_cycle + 2_000 - uno.cycle());
}

#[test]
fn a_frame_is_sent_completely_or_not_at_all_wherever_main_stops_in_the_hand_over() {
    // The main loop stops until A1's pulse has begun. Meanwhile the timer interrupt takes over the next frame, and A1's
    // pin, which may share its port with the LED, rises. The test stops the main loop only in every third frame,
    // because a frame that comes too late is sent at the next tick and therefore affects two frames.
    start_in_both_simulations(ReferenceRun::start_walking, |mut run| {
        let start = run.run_to_next_frame();
        let frame_count = 2 * 3 * MAX_HAND_OVER_CYCLES;
        for frame_index in (1..frame_count).step_by(3) {
            let frame_start = start + frame_index * FRAME_CYCLES;
            let delay_cycles = frame_index / 3 % MAX_HAND_OVER_CYCLES;
            stall_in_hand_over(&mut run, frame_start, delay_cycles);
            run.run_to(frame_start + 2_000);
        }
        run.run_to(start + frame_count * FRAME_CYCLES - SLOT_CYCLES / 2);
        let frames = run.frames_since(start);
        assert_eq!(frames.len() as u64, frame_count);
        // No frame is skipped: each sent frame is the previous frame or the next computed frame.
        let mut next_index = 0;
        for (frame_index, (sent, _)) in frames.iter().enumerate() {
            let is_computed_at = |index: usize| sent.all_widths() == Some(frames[index].1);
            let is_next = is_computed_at(next_index);
            let is_repeated = next_index > 0 && is_computed_at(next_index - 1);
            assert!(
                is_next || is_repeated,
                "stopped after {} cycles: {sent:?}",
                frame_index / 3
            );
            next_index += usize::from(is_next);
        }
        // Not all frames are repeated: at the end of the sweep, the main loop has handed over the frame before it
        // stops.
        let repeated_count = frames.len() - next_index;
        let is_expected_count = (40..frames.len() / 3 - 40).contains(&repeated_count);
        assert!(is_expected_count, "{repeated_count} frames repeated");
        assert_eq!(run.late_edge_count(), 0);
    });
}

#[test]
fn a_rest_that_replaces_a_pending_frame_ends_all_pulses_or_none() {
    let mut run = ReferenceRun::start_walking(Fidelity::DataSheet);
    for delay_cycles in 0..160 {
        // The tick of the next frame may have passed, so the test stalls the main loop at the tick of the one after it.
        let frame_start = run.run_to_next_frame() + FRAME_CYCLES;
        run.run_to(frame_start - SLOT_CYCLES - 400);
        run.bench.uno.stall_main(SLOT_CYCLES + 2_400);
        run.run_to(frame_start + 3_000);
        run.bench.uno.send(b"rest\n");
        stall_in_hand_over(&mut run, frame_start + FRAME_CYCLES, delay_cycles);
        run.run_to(frame_start + 4 * FRAME_CYCLES - SLOT_CYCLES / 2);
        let edges = run.bench.uno.edges();
        let sent_frames = group_frames(&edges, run.bench.pins(), frame_start, 4);
        let case = format!("stopped after {delay_cycles} cycles");
        for frame in &sent_frames {
            let has_all_or_none = frame.is_silent() || frame.all_widths().is_some();
            assert!(has_all_or_none, "{case}: {frame:?}");
        }
        assert!(sent_frames[2].is_silent(), "{case}");
        run.bench.say("stand");
        run.bench.run_ms(700);
    }
}

#[test]
fn an_answer_is_the_same_wherever_main_stops_while_writing_it() {
    // Longer than the duration of two bytes, so the USART sends everything in its buffer.
    const STOP_CYCLES: u64 = 3_000;
    start_in_both_simulations(boot_to_stand, |mut bench| {
        // From here on, the robot prints only answers.
        assert_eq!(bench.say("stop"), "ok stop");
        for delay_cycles in 0..4_500 {
            bench.send("stop");
            bench.uno.run_cycles(6_700);
            let has_received_all = |uno: &Uno| uno.unsent_byte_count() == 0;
            assert!(bench.uno.run_until(1_000, 1, has_received_all));
            bench.uno.run_cycles(delay_cycles);
            bench.uno.stall_main(STOP_CYCLES);
            let answer = bench.next_line(20);
            assert_eq!(
                answer.as_deref(),
                Some("ok stop"),
                "stopped after {delay_cycles} cycles"
            );
        }
        assert_eq!(Status::read(&mut bench).number("rx_lost"), 0.0);
    });
}

#[test]
fn a_byte_at_any_cycle_of_falling_asleep_wakes_main_at_once() {
    start_in_both_simulations(ReferenceRun::start_standing, |mut run| {
        let start = run.run_to_next_frame();
        // The main loop wakes for each pulse's rise, finds nothing and falls asleep again.
        for byte_index in 0..700 {
            let rise = start + byte_index / 4 * FRAME_CYCLES + byte_index % 4 * SLOT_CYCLES;
            run.run_to(rise - 20_000);
            run.bench.uno.send(b"stop");
            let bytes_before = run.bench.bytes().len();
            // The receiver delivers a byte 9.5 bit times after its start.
            let arrival_cycle = rise - 200 + byte_index;
            run.run_to(arrival_cycle - 1_320);
            run.bench.uno.send(b"\n");
            run.run_to(arrival_cycle + 20_000);
            let answer_delay = run.bench.bytes()[bytes_before].cycle - arrival_cycle;
            assert!(
                answer_delay < 12_000,
                "byte {byte_index}: answered after {answer_delay} cycles"
            );
        }
    });
}

#[test]
fn missed_ticks_are_skipped_and_make_no_servo_jump() {
    start_in_both_simulations(ReferenceRun::start_walking, |mut run| {
        run.run_to_next_frame();
        let frames_before = Status::read(&mut run.bench).number("frames");
        let start_cycle = run.bench.uno.cycle();
        run.bench.uno.take_edges();
        // Each stall is shorter than the watchdog's timeout. The main loop computes one frame for all ticks of a stall,
        // and skips the next tick, because that late frame still waits.
        for stalled_frames in [2, 3, 4, 5].into_iter().cycle().take(20) {
            run.bench.uno.stall_main(stalled_frames * FRAME_CYCLES);
            run.bench.run_ms(300);
        }
        let pulses = recorded_pulses(&run.bench);
        assert!(pulses.iter().all(|pulses| pulses.len() > 250));
        assert_gait_within_slew_limits(&pulses);
        let frames = Status::read(&mut run.bench).number("frames") - frames_before;
        let passed_frames = (run.bench.uno.cycle() - start_cycle) as f64 / FRAME_CYCLES as f64;
        let missed_frames = passed_frames - frames;
        let is_expected_count = (missed_frames - 70.0).abs() < 1.0;
        assert!(is_expected_count, "{missed_frames} of {passed_frames}");
    });
}

#[test]
fn the_last_widths_repeat_while_main_is_stalled() {
    let mut run = ReferenceRun::start_walking(Fidelity::DataSheet);
    let start = run.run_to_next_frame();
    run.bench.uno.stall_main(5 * FRAME_CYCLES);
    run.run_to(start + 4 * FRAME_CYCLES + FRAME_CYCLES / 2);
    let frames = run.frames_since(start);
    let last_widths = frames[1].0.expect_all_widths();
    for (frame, _) in &frames[1..] {
        assert_eq!(frame.expect_all_widths(), last_widths);
    }
}

#[test]
fn pulses_stay_within_the_slew_limit_after_any_stall_in_any_gait() {
    // The watchdog has two stages of 125 ms each, and main last resets it at most one frame before a stall. A stall
    // shorter than POSSIBLE_RESET_MS never causes a reset, and a stall of at least CERTAIN_RESET_MS always does.
    const POSSIBLE_RESET_MS: u64 = 105;
    const CERTAIN_RESET_MS: u64 = 250;
    for_each_in_parallel(&gait_commands(), |gait| {
        let mut bench = boot_and_command(gait, Fidelity::DataSheet);
        // Short stalls are tried at more times, because only short stalls end near the next tick.
        let lengths_ms = (0..6).flat_map(|_| 1..=25).chain(1..=300);
        for (stall_index, length_ms) in lengths_ms.enumerate() {
            // Spreads the stalls evenly over the frame, because 7 919 is prime.
            let delay_cycles = stall_index as u64 * 7_919 % FRAME_CYCLES;
            bench.uno.run_cycles(FRAME_CYCLES + delay_cycles);
            let resets_before = bench.uno.watchdog_reset_count();
            bench.uno.stall_main(length_ms * CYCLES_PER_MS);
            // Once the watchdog's first stage has ended the pulses, the reset is certain.
            let may_reset = length_ms >= POSSIBLE_RESET_MS;
            let wait_ms = if may_reset { 350 } else { length_ms };
            bench.uno.run_ms(wait_ms + 60);
            let was_reset = bench.uno.watchdog_reset_count() > resets_before;
            assert!(length_ms < CERTAIN_RESET_MS || was_reset, "{length_ms} ms");
            assert!(may_reset || !was_reset, "{length_ms} ms");
            println!("{gait}, stalled for {length_ms} ms");
            assert_gait_within_slew_limits(&recorded_pulses(&bench));
            if was_reset {
                bench.say(gait);
                bench.run_ms(900);
            }
            bench.uno.take_edges();
        }
    });
}
