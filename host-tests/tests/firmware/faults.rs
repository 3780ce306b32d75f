//! Tests of the faults that stop a motion. Each has its own word in `status`, its own message and its own number of LED
//! flashes.

use lizard_host::sim::frame::FRAME_CYCLES;
use lizard_host_tests::FirmwareBench;
use simulated_uno::{CYCLES_PER_MS, Fidelity};

use crate::measurements::{
    assert_flashes, assert_steady, measure_widths, recorded_pulses, run_and_record_pulses,
};
use crate::reference_run::ReferenceRun;
use crate::{Status, boot_to_walk, first_moving_gait};

/// Checks the effects of a fault: nothing moves, `status` and exactly one line name the fault, and the LED flashes
/// `flash_count` times between pauses.
fn assert_stopped(bench: &mut FirmwareBench, word: &str, message: &str, flash_count: usize) {
    Status::read(bench).assert_has(&format!("gait=stop fault={word}"));
    let held_widths = measure_widths(bench);
    assert_steady(&run_and_record_pulses(bench, 1000), held_widths, 49);
    let line = format!("# fault: {message}");
    let printed_lines = bench.lines().iter().filter(|printed| printed.text == line);
    assert_eq!(printed_lines.count(), 1, "{line}");
    assert_flashes(bench, 12, flash_count);
}

#[test]
fn a_gait_ends_if_no_line_arrives_within_the_deadman_time() {
    let mut bench = boot_to_walk(Fidelity::DataSheet);
    bench.say("deadman 800");
    let start = bench.uno.cycle();
    bench.run_ms(700);
    bench.say("speed 90");
    bench.run_ms(700);
    bench.say("speed 100");
    // Bytes without a line end do not count as a line.
    bench.uno.send(b"  ");
    bench.run_ms(1500);
    let message = "no command within the deadman time, stopped";
    let mut lines = bench.lines().iter();
    let stop_line = lines.find(|line| line.text.contains(message));
    let stop_ms = stop_line.map(|line| (line.cycle - start) / CYCLES_PER_MS);
    // 800 ms after the last line, which came at 1400 ms plus the time of an answer; a line takes 5 ms.
    let is_in_time = stop_ms.is_some_and(|ms| (2_190..2_260).contains(&ms));
    assert!(is_in_time, "stopped after {stop_ms:?} ms");
    assert_stopped(&mut bench, "link", message, 3);
    bench.expect_ok(&first_moving_gait());
    Status::read(&mut bench).assert_has("fault=none");
}

#[test]
fn deadman_is_off_unless_set_and_does_not_affect_a_standing_robot() {
    let mut bench = boot_to_walk(Fidelity::DataSheet);
    bench.run_ms(70_000);
    Status::read(&mut bench).assert_has("fault=none");
    bench.say("stand");
    bench.say("deadman 100");
    bench.run_ms(5_000);
    Status::read(&mut bench).assert_has("gait=stand fault=none");
}

#[test]
fn a_late_edge_stops_the_motion_and_its_pulse_is_dropped() {
    let mut run = ReferenceRun::start_walking(Fidelity::DataSheet);
    let rise = run.run_to_next_frame();
    run.run_to(rise - 600);
    run.bench.uno.block_interrupts(700);
    run.run_to(rise + 2 * FRAME_CYCLES);
    let pulses = recorded_pulses(&run.bench);
    let starts: Vec<u64> = pulses[0].iter().map(|pulse| pulse.start).collect();
    assert_eq!(starts, [rise + FRAME_CYCLES]);
    let message = "a pulse was late, stopped";
    assert_stopped(&mut run.bench, "late", message, 5);
    Status::read(&mut run.bench).assert_has("late=1");
}

#[test]
fn a_stack_overflow_stops_the_motion_permanently() {
    for byte in 0..4 {
        let mut run = ReferenceRun::start_walking(Fidelity::DataSheet);
        let guard_address = run.variable_address("lizard_stack_guard") + byte;
        let byte_before = run.bench.uno.peek(guard_address);
        run.bench.uno.poke(guard_address, byte_before ^ 0x10);
        run.bench.run_ms(100);
        let message = "the stack has grown into the data, stopped";
        assert_stopped(&mut run.bench, "stack", message, 6);
        // The data may be corrupt, so the robot must not move again.
        run.bench.say(&first_moving_gait());
        run.bench.run_ms(100);
        let held_widths = measure_widths(&mut run.bench);
        run.bench.run_ms(1000);
        assert_eq!(measure_widths(&mut run.bench), held_widths);
    }
}
