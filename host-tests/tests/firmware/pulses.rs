//! Tests that the servo pulses are exact to the cycle, whatever happens on the serial line.

use lizard_host::sim::core_run;
use lizard_host::sim::frame::{FRAME_CYCLES, Frame};
use lizard_host_tests::{FirmwareBench, robot};
use lizard_robot::Robot;
use simulated_uno::{Edge, Fidelity, max_pins_high};

use crate::{
    FRAMES_PER_SECOND, Status, boot_to_stand, end_flood, first_moving_gait, for_each_in_parallel,
    run_in_both_simulations,
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
        for (servo, start) in frame.starts.into_iter().enumerate() {
            let start = start.unwrap_or_else(|| panic!("no pulse: {frame:?}"));
            // Each servo has a slot of 4 ms, counted from A1's slot.
            let expected = frame.start + servo as u64 * FRAME_CYCLES / 5;
            assert_eq!(start, expected, "{frame:?}");
        }
    }
    let edges = servo_edges(bench);
    assert_eq!(edges.len(), 8 * frames.len(), "too many or too few edges");
    assert_eq!(max_pins_high(&edges), 1);
}

/// Computes the widths of these frames with the core on the host, which receives only the first `received_count` bytes.
/// `first_rise` is the cycle at which A1's first pulse begins.
pub fn compute_core_widths(
    robot: &Robot,
    bench: &FirmwareBench,
    first_rise: u64,
    received_count: usize,
    frames: &[Frame],
) -> Vec<[u64; 4]> {
    let frames_before = ((frames[0].start - first_rise) / FRAME_CYCLES) as usize;
    let frame_count = frames_before + frames.len();
    let received = &bench.uno.received_by_uno()[..received_count];
    let host_run = core_run::play(*robot.firmware(), received, first_rise, frame_count);
    let widths = host_run.widths[frames_before..].iter();
    widths.map(|widths| widths.map(u64::from)).collect()
}

#[test]
fn every_width_matches_the_core() {
    for_each_in_parallel(&[Fidelity::Stock, Fidelity::DataSheet], |fidelity| {
        for gait in robot().gaits() {
            // The line is sent while the firmware writes nothing. If the line ends so close to a tick that the main
            // loop may read it before or after the tick, a new bench sends the line a millisecond later.
            let boot_and_command_after = |delay_ms| {
                let mut bench = boot_to_stand(*fidelity);
                let first_rise = bench.first_pulse_cycle().expect("the robot stands");
                bench.run_ms(delay_ms);
                bench.say(&gait.command());
                (bench, first_rise)
            };
            let is_away_from_ticks = |(bench, first_rise): &(FirmwareBench, u64)| {
                core_run::find_undetermined_lines(&bench.uno.received_by_uno(), *first_rise)
                    .next()
                    .is_none()
            };
            let (mut bench, first_rise) = (200..220)
                .map(boot_and_command_after)
                .find(is_away_from_ticks)
                .expect("one of the delays keeps the line away from the ticks");
            let frames = bench.run_for_frames(6 * FRAMES_PER_SECOND);
            assert_on_slot_grid(&bench, &frames);
            let received_count = bench.uno.received_by_uno().len();
            let expected_widths =
                compute_core_widths(robot(), &bench, first_rise, received_count, &frames);
            for (frame, expected) in frames.iter().zip(expected_widths) {
                let (widths, name) = (frame.expect_all_widths(), gait.name());
                assert_eq!(widths, expected, "{name}: {frame:?}");
            }
        }
    });
}

#[test]
fn a_serial_line_saturated_in_both_directions_moves_no_edge() {
    // No loss of bytes can make one of these a command that moves a servo.
    const FLOODS: [&str; 4] = ["status\n", "help\n", "?\r", "x"];
    run_in_both_simulations(|fidelity| {
        for flood in FLOODS {
            let mut bench = boot_to_stand(fidelity);
            let first_rise = bench.first_pulse_cycle().expect("the robot stands");
            bench.say("watch 1");
            bench.say(&first_moving_gait());
            let received_count = bench.uno.received_by_uno().len();
            bench.uno.flood(flood.as_bytes());
            let sent_before = bench.bytes().len();
            let frames = bench.run_for_frames(10 * FRAMES_PER_SECOND);
            let sent_count = bench.bytes().len() - sent_before;
            assert_on_slot_grid(&bench, &frames);
            let expected_widths =
                compute_core_widths(robot(), &bench, first_rise, received_count, &frames);
            for (frame, expected) in frames.iter().zip(expected_widths) {
                assert_eq!(frame.expect_all_widths(), expected, "{flood:?}: {frame:?}");
            }
            let changes = frames
                .windows(2)
                .filter(|pair| pair[0].widths != pair[1].widths);
            let can_vary = robot().gaits().iter().any(|gait| gait.has_movement());
            assert!(
                !can_vary || changes.count() as u64 > 2 * FRAMES_PER_SECOND,
                "the widths do not vary"
            );
            // Both directions are saturated: the robot receives 11 520 bytes per second, and its answers fill the other
            // direction, unless the flood is a single overlong line.
            let seconds = frames.len() as f64 / FRAMES_PER_SECOND as f64;
            let received_rate =
                (bench.uno.received_by_uno().len() - received_count) as f64 / seconds;
            assert!(
                received_rate > 11_000.0 || fidelity == Fidelity::Stock && received_rate > 10_000.0,
                "{received_rate} bytes per second received"
            );
            let sent_rate = sent_count as f64 / seconds;
            assert!(
                sent_rate > 9_500.0 || flood == "x",
                "{flood:?}: {sent_rate} bytes per second sent"
            );
            end_flood(&mut bench);
            let status = Status::read(&mut bench);
            assert_eq!(status.number("late"), 0.0, "{flood:?}");
            let overrun_count = bench.uno.overrun_count();
            assert_eq!(overrun_count, 0, "the receiver was not read in time");
        }
    });
}

#[test]
fn every_frame_is_counted_during_a_flood() {
    run_in_both_simulations(|fidelity| {
        let mut bench = boot_to_stand(fidelity);
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
