//! Tests that the servo pulses are exact to the cycle, whatever happens on the serial line.

use lizard_host::sim::core_run::find_undetermined_lines;
use lizard_host::sim::frame::{FRAME_CYCLES, Frame};
use lizard_host_tests::{FirmwareBench, robot};
use simulated_uno::{Edge, Fidelity, max_pins_high};

use crate::reference_run::{ReferenceRun, SLOT_CYCLES};
use crate::{
    FRAMES_PER_SECOND, Status, boot_to_stand, end_flood, first_moving_gait,
    run_in_both_simulations, start_in_both_simulations,
};

/// Returns the recorded edges of the servos' pins.
pub fn servo_edges(bench: &FirmwareBench) -> Vec<Edge> {
    let pins = bench.pins();
    let edges = bench.uno.edges().into_iter();
    edges.filter(|edge| pins.contains(&edge.pin)).collect()
}

/// Asserts that each servo has one pulse in each frame, exactly 20 ms apart, and that only one pin is high at a time.
fn assert_on_slot_grid(bench: &FirmwareBench, frames: &[Frame]) {
    for frame in frames {
        // Each servo has a slot of 4 ms, counted from A1's slot.
        let slot_starts = [0, 1, 2, 3].map(|slot| Some(frame.start + slot * SLOT_CYCLES));
        assert_eq!(frame.pulse_starts, slot_starts, "{frame:?}");
    }
    let edges = servo_edges(bench);
    assert_eq!(edges.len(), 8 * frames.len(), "too many or too few edges");
    assert_eq!(max_pins_high(&edges), 1);
}

#[test]
fn every_width_matches_the_core() {
    run_in_both_simulations(|fidelity| {
        for gait in robot().gaits() {
            // The line is sent while the firmware writes nothing. If the line ends so close to a tick that the main
            // loop may read it before or after the tick, a new bench sends the line a millisecond later.
            let boot_and_command_after = |delay_ms| {
                let mut bench = boot_to_stand(fidelity);
                bench.run_ms(delay_ms);
                ReferenceRun::with_lines(bench, robot(), &[&gait.command()])
            };
            let is_away_from_ticks = |run: &ReferenceRun| {
                let received = run.bench.uno.received_by_uno();
                let mut lines = find_undetermined_lines(&received, run.first_pulse_cycle);
                lines.next().is_none()
            };
            let mut run = (200..220)
                .map(boot_and_command_after)
                .find(is_away_from_ticks)
                .expect("one of the delays keeps the line away from the ticks");
            let frames = run.bench.run_for_frames(6 * FRAMES_PER_SECOND);
            assert_on_slot_grid(&run.bench, &frames);
            let exact_count = run.assert_exact_since(frames[0].start, gait.name());
            assert_eq!(exact_count, frames.len(), "{}", gait.name());
        }
    });
}

#[test]
fn a_serial_line_saturated_in_both_directions_moves_no_edge() {
    // No loss of bytes can make one of these a command that moves a servo.
    const FLOODS: [&str; 4] = ["status\n", "help\n", "?\r", "x"];
    run_in_both_simulations(|fidelity| {
        for flood in FLOODS {
            let lines = ["watch 1", &first_moving_gait()];
            let mut run = ReferenceRun::with_lines(boot_to_stand(fidelity), robot(), &lines);
            let bench = &mut run.bench;
            bench.uno.flood(flood.as_bytes());
            let sent_before = bench.bytes().len();
            let frames = bench.run_for_frames(10 * FRAMES_PER_SECOND);
            let sent_count = bench.bytes().len() - sent_before;
            assert_on_slot_grid(bench, &frames);
            let received_count = bench.uno.received_by_uno().len() - run.received_byte_count;
            let exact_count = run.assert_exact_since(frames[0].start, flood);
            assert_eq!(exact_count, frames.len(), "{flood:?}");
            let is_change = |pair: &&[Frame]| pair[0].widths != pair[1].widths;
            let change_count = frames.windows(2).filter(is_change).count() as u64;
            let are_varied = change_count > 2 * FRAMES_PER_SECOND;
            let can_vary = robot().gaits().iter().any(|gait| gait.has_movement());
            assert!(are_varied || !can_vary, "the widths do not vary");
            // Both directions are saturated: the robot receives 11 520 bytes per second, and its answers fill the other
            // direction, unless the flood is a single overlong line.
            let seconds = frames.len() as f64 / FRAMES_PER_SECOND as f64;
            let received_rate = received_count as f64 / seconds;
            assert!(
                received_rate > 11_000.0 || fidelity == Fidelity::Stock && received_rate > 10_000.0,
                "{received_rate} bytes per second received"
            );
            let sent_rate = sent_count as f64 / seconds;
            let is_saturated = sent_rate > 9_500.0 || flood == "x";
            assert!(is_saturated, "{flood:?}: {sent_rate} bytes per second sent");
            end_flood(&mut run.bench);
            let status = Status::read(&mut run.bench);
            assert_eq!(status.number("late"), 0.0, "{flood:?}");
            let overrun_count = run.bench.uno.overrun_count();
            assert_eq!(overrun_count, 0, "the receiver was not read in time");
        }
    });
}

#[test]
fn every_frame_is_counted_during_a_flood() {
    start_in_both_simulations(boot_to_stand, |mut bench| {
        bench.run_for_frames(0);
        let (cycle, status_before) = (bench.uno.cycle(), Status::read(&mut bench));
        bench.uno.flood(b"status\nhelp\n");
        bench.run_ms(20_000);
        end_flood(&mut bench);
        bench.run_for_frames(0);
        let passed_frames = (bench.uno.cycle() - cycle) / FRAME_CYCLES;
        let counted_frames =
            Status::read(&mut bench).number("frames") - status_before.number("frames");
        assert_eq!(counted_frames, passed_frames as f64);
    });
}
