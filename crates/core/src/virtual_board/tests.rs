//! Tests that the virtual board behaves like the UNO.

use super::*;
use std::format;

use crate::memory::record::{ERASED, Memory};
use crate::sample::Sample;
use crate::step::{Main, Step};

/// A robot that stands.
fn standing_robot() -> RunningRobot {
    let mut running = RunningRobot::power_on(*Sample::odd());
    running.run_frames(30);
    running
}

const NO_PULSES: Pulses = Pulses([Width(0); 4]);

#[test]
fn a_frame_is_played_once_handed_over_and_repeats_while_main_is_late() {
    let mut board = VirtualBoard::default();
    board.connect([9, 10, 5, 6], None);
    let pulses = Pulses([1_000, 20_000, 30_000, 63_000].map(Width));
    board.submit(pulses);
    assert_eq!(board.started_pulses(), NO_PULSES);
    board.pass_time(1 + 3);
    assert_eq!(
        board.started_pulses(),
        NO_PULSES,
        "the tick, and not yet the hand-over"
    );
    board.pass_time(1);
    assert_eq!(
        board.started_pulses().0.map(|width| width.0),
        [1_000, 0, 0, 0]
    );
    for _ in 0..4 {
        board.pass_time(19);
        assert_eq!(board.started_pulses(), pulses);
        board.pass_time(1);
    }
    board.submit(Pulses([0, 999, 63_001, 1_000].map(Width)));
    board.pass_time(20 + 19);
    assert_eq!(
        board.started_pulses().0.map(|width| width.0),
        [0, 0, 0, 1_000]
    );
}

#[test]
fn a_stall_below_125_ms_changes_nothing_and_a_longer_one_restarts_the_program() {
    let mut running = standing_robot();
    assert!(!running.stall(WATCHDOG_MS - 20));
    assert!(!running.board.are_pulses_ended());
    assert_ne!(running.frame(), NO_PULSES);
    let mut hung = standing_robot();
    assert!(!hung.board.pass_time(WATCHDOG_MS + 20));
    assert!(hung.board.are_pulses_ended());
    assert_eq!(
        hung.board.started_pulses(),
        NO_PULSES,
        "no pulse begins any more"
    );
    let (pose, frames) = (*hung.motion().pose(), hung.motion().frames());
    hung.settle();
    assert_eq!(hung.motion().frames(), frames, "main does not go on");
    assert!(hung.stall(1), "and the reset comes");
    assert!(!hung.board.are_pulses_ended());
    assert_eq!(hung.board.restart().cause, Cause::Watchdog);
    assert_eq!(hung.board.restart().count, 1);
    assert_eq!(
        hung.board.restart().stance_before.map(|stance| stance.pose),
        Some(pose)
    );
}

#[test]
fn a_reset_leaves_the_pose_and_power_takes_it() {
    let mut running = standing_robot();
    running.send_line("sway");
    running.run_frames(60);
    let pose = *running.motion().pose();
    running.board.send(b"stand\r");
    running.reset(Cause::External);
    assert_eq!(
        running
            .board
            .restart()
            .stance_before
            .map(|stance| stance.pose),
        Some(pose)
    );
    assert_eq!(running.board.unread(), 0, "what main had not read is lost");
    running.lose_power(None);
    assert_eq!(running.board.restart(), &Restart::NONE);
}

#[test]
fn power_lost_in_a_write_leaves_anything_in_that_byte_and_nowhere_else() {
    let mut board = VirtualBoard::default();
    board.memory.write(17, 0x35);
    assert_eq!(board.memory.address_in_write(), Some(17));
    let mut board_after_write = board.clone();
    board.lose_power(Some(0xb7));
    assert_eq!(board.memory.bytes()[17], 0xb7);
    board_after_write.pass_time(4);
    board_after_write.lose_power(Some(0xb7));
    assert_eq!(
        board_after_write.memory.bytes()[17],
        0x35,
        "it had time to end"
    );
    let is_other = |address: &usize| *address != 17;
    let is_erased = |address: usize| board.memory.bytes()[address] == ERASED;
    assert!((0..1024).filter(is_other).all(is_erased));
}

#[test]
fn a_slow_listener_leaves_less_room_until_time_passes() {
    let mut transmitter = Transmitter::new(16_000, 255);
    transmitter.fill(200);
    assert_eq!(transmitter.room(), 55);
    transmitter.pass_time(10);
    assert_eq!(transmitter.room(), 65);
    transmitter.is_held = true;
    assert_eq!(transmitter.room(), 0);
    assert_eq!(Transmitter::default().room(), 255);
}

#[test]
fn nothing_is_measured_before_a_whole_measurement_and_each_part_in_its_turn() {
    let truth = Reading {
        reference: 221,
        rail: 393,
    };
    for (has_rail, first_frame) in [(false, 2), (true, 4)] {
        let mut converter = Converter::new(truth, has_rail);
        for frame in 1..40 {
            let reading = converter.next();
            assert_eq!(
                reading.reference == 221,
                frame >= first_frame,
                "{has_rail} {frame}"
            );
            assert_eq!(
                reading.rail == 393,
                has_rail && frame >= first_frame,
                "{has_rail} {frame}"
            );
        }
    }
}

#[test]
fn bytes_beyond_what_the_receiver_holds_are_lost_and_counted() {
    let mut board = VirtualBoard::default();
    board.send(&[b'x'; RECEIVE_CAPACITY + 5]);
    assert_eq!(
        (board.unread(), board.counters().rx_lost),
        (RECEIVE_CAPACITY, 5)
    );
    let mut main = Main::new();
    main.begin(Sample::odd().section(), &mut board);
    while main.step(&mut board) == Step::Worked {}
    assert_eq!(board.unread(), 0);
}

#[test]
fn the_first_pulse_after_a_reset_is_at_most_the_frame_on_its_way_then() {
    // Settings that change before the servos wake must not move them beyond the last submitted frame: the first
    // pulses repeat it, and the slew limit counts from there.
    let mut running = RunningRobot::power_on(*Sample::odd());
    running.run_frames(200);
    running.send_line("sway");
    running.run_frames(60);
    let started = running.board.started_pulses();
    running.board.pass_time(running.board.ms_until_tick());
    running.settle();
    running.reset(Cause::External);
    let submitted = *running.motion().sent();
    assert_ne!(started, submitted, "a frame was on its way");
    for servo in 1..=4 {
        running.send_line(&format!("scale {servo} 9.3"));
    }
    let mut first_widths = [None; 4];
    while first_widths.contains(&None) {
        let pulses = running.frame();
        for (first, width) in first_widths.iter_mut().zip(pulses.0) {
            if width.0 > 0 {
                first.get_or_insert(width);
            }
        }
    }
    assert_eq!(first_widths, submitted.0.map(Some));
}

/// The largest change of each servo's pulse width from one frame to the next, cycles.
fn largest_leaps(running: &mut RunningRobot, frames: usize) -> [u16; 4] {
    let mut last_widths = *running.motion().sent();
    let mut leaps = [0; 4];
    for _ in 0..frames {
        let pulses = running.frame();
        for (servo, width) in pulses.0.iter().enumerate() {
            if width.0 > 0 {
                leaps[servo] = leaps[servo].max(width.0.abs_diff(last_widths.0[servo].0));
                last_widths.0[servo] = *width;
            }
        }
    }
    leaps
}

#[test]
fn settings_changed_at_rest_turn_no_servo_faster_than_the_slew_limit() {
    let robot = Sample::odd();
    let per_frame = robot.slew().per_frame;
    let max_leaps = robot.calibration().map(|servo| servo.slew(per_frame));
    for reset_cause in [None, Some(Cause::External), Some(Cause::Watchdog)] {
        let mut running = standing_robot();
        running.send_line("sway");
        running.run_frames(60);
        running.send_line("rest");
        running.run_frames(60);
        let sent_at_rest = *running.motion().sent();
        for servo in 1..=4 {
            assert!(
                running
                    .send_line(&format!("trim {servo} 6"))
                    .starts_with("ok")
            );
        }
        if let Some(cause) = reset_cause {
            running.reset(cause);
            running.run_frames(60);
        }
        running.send_line("stand");
        let leaps = largest_leaps(&mut running, 200);
        for servo in 0..4 {
            assert!(leaps[servo] <= max_leaps[servo], "{leaps:?}, {max_leaps:?}");
            assert!(leaps[servo] > 0, "it stands elsewhere than it rested");
        }
        assert_ne!(*running.motion().sent(), sent_at_rest);
    }
}
