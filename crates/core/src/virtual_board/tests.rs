//! Tests that the virtual board behaves like the UNO.

use super::*;
use std::format;

use crate::memory::record::{ERASED, Memory};
use crate::sample::{HEALTHY_BOARD, Sample};
use crate::step::{Main, StepResult};

/// Runs a robot until it stands.
fn run_standing_robot() -> RunningRobot {
    let mut robot = RunningRobot::power_on(*Sample::asymmetric());
    robot.run_frames(30);
    robot
}

const NO_PULSES: Pulses = Pulses([PulseWidth(0); 4]);

#[test]
fn a_frame_is_played_after_it_is_taken_over_and_repeats_while_the_main_loop_is_late() {
    let mut board = VirtualBoard::default();
    board.connect([9, 10, 5, 6], None);
    let pulses = Pulses([1_000, 20_000, 30_000, 63_000].map(PulseWidth));
    board.submit(pulses);
    assert_eq!(board.started_pulses(), NO_PULSES);
    board.pass_time(1 + 3);
    let claim = "the frame has not been taken over yet";
    assert_eq!(board.started_pulses(), NO_PULSES, "{claim}");
    board.pass_time(1);
    let widths = board.started_pulses().0.map(|width| width.0);
    assert_eq!(widths, [1_000, 0, 0, 0]);
    for _ in 0..4 {
        board.pass_time(19);
        assert_eq!(board.started_pulses(), pulses);
        board.pass_time(1);
    }
    board.submit(Pulses([0, 999, 63_001, 1_000].map(PulseWidth)));
    board.pass_time(20 + 19);
    let widths = board.started_pulses().0.map(|width| width.0);
    assert_eq!(widths, [0, 0, 0, 1_000]);
}

#[test]
fn a_stall_below_125_ms_changes_nothing_and_a_longer_stall_restarts_the_program() {
    let mut robot = run_standing_robot();
    assert!(!robot.stall(WATCHDOG_MS - 20));
    assert!(!robot.board.are_pulses_ended());
    assert_ne!(robot.run_frame(), NO_PULSES);
    let mut hung_robot = run_standing_robot();
    assert!(!hung_robot.board.pass_time(WATCHDOG_MS + 20));
    assert!(hung_robot.board.are_pulses_ended());
    let started_pulses = hung_robot.board.started_pulses();
    assert_eq!(started_pulses, NO_PULSES, "no further pulse begins");
    let pose = *hung_robot.motion().pose();
    let frames = hung_robot.motion().frame_count();
    hung_robot.settle();
    let new_frames = hung_robot.motion().frame_count();
    assert_eq!(new_frames, frames, "the main loop does not continue");
    assert!(hung_robot.stall(1), "the watchdog resets the processor");
    assert!(!hung_robot.board.are_pulses_ended());
    let restart = hung_robot.board.last_restart();
    assert_eq!((restart.cause, restart.reset_count), (Cause::Watchdog, 1));
    let servo_state = restart.servo_state_before.expect("the RAM has kept it");
    assert_eq!(servo_state.pose, pose);
}

#[test]
fn a_reset_keeps_the_pose_and_a_loss_of_power_does_not() {
    let mut robot = run_standing_robot();
    robot.send_and_run("sway", 60);
    let pose = *robot.motion().pose();
    robot.board.send(b"stand\r");
    robot.reset(Cause::External);
    let servo_state_before = robot.board.last_restart().servo_state_before;
    assert_eq!(servo_state_before.expect("the RAM has kept it").pose, pose);
    let claim = "bytes that the main loop has not read are lost";
    assert_eq!(robot.board.unread_count(), 0, "{claim}");
    robot.cycle_power(None);
    assert_eq!(robot.board.last_restart(), &Restart::NONE);
}

#[test]
fn power_lost_during_a_write_changes_only_the_byte_that_is_being_written() {
    let mut board = VirtualBoard::default();
    board.memory.write(17, 0x35);
    assert_eq!(board.memory.address_in_write(), Some(17));
    let mut board_after_write = board.clone();
    board.cycle_power(Some(0xb7));
    assert_eq!(board.memory.bytes()[17], 0xb7);
    board_after_write.pass_time(4);
    board_after_write.cycle_power(Some(0xb7));
    let byte = board_after_write.memory.bytes()[17];
    assert_eq!(byte, 0x35, "the write had time to end");
    let is_unwritten = |address: &usize| *address != 17;
    let is_erased = |address: usize| board.memory.bytes()[address] == ERASED;
    assert!((0..1024).filter(is_unwritten).all(is_erased));
}

#[test]
fn a_slow_transmitter_has_less_room_until_time_passes() {
    let mut transmitter = Transmitter::new(16_000, 255);
    transmitter.queue_bytes(200);
    assert_eq!(transmitter.room(), 55);
    transmitter.pass_time(10);
    assert_eq!(transmitter.room(), 65);
    transmitter.is_held = true;
    assert_eq!(transmitter.room(), 0);
    assert_eq!(Transmitter::default().room(), 255);
}

#[test]
fn the_reading_is_zero_until_every_voltage_has_been_measured() {
    for (measures_rail, first_frame) in [(false, 2), (true, 4)] {
        let mut adc = Adc::new(HEALTHY_BOARD.supply, measures_rail);
        for frame in 1..40 {
            let reading = adc.advance_frame();
            let is_given = frame >= first_frame;
            let is_read = [reading.reference == 221, reading.rail == 393];
            let expected = [is_given, measures_rail && is_given];
            assert_eq!(is_read, expected, "{measures_rail} {frame}");
        }
    }
}

#[test]
fn bytes_beyond_the_receivers_capacity_are_lost_and_counted() {
    let mut board = VirtualBoard::default();
    board.send(&[b'x'; RECEIVE_CAPACITY + 5]);
    assert_eq!(board.unread_count(), RECEIVE_CAPACITY);
    assert_eq!(board.counters().rx_lost, 5);
    let mut main = Main::new();
    main.begin(Sample::asymmetric().section(), &mut board);
    while main.step(&mut board) == StepResult::Worked {}
    assert_eq!(board.unread_count(), 0);
}

#[test]
fn the_first_pulses_after_a_reset_repeat_the_last_submitted_frame() {
    // Settings that change before the servos wake must not make them jump: the first pulses repeat the last submitted
    // frame, and from then on the slew limit applies.
    let mut robot = RunningRobot::power_on(*Sample::asymmetric());
    robot.run_frames(200);
    robot.send_and_run("sway", 60);
    let started_pulses = robot.board.started_pulses();
    robot.board.pass_time(robot.board.ms_until_tick());
    robot.settle();
    robot.reset(Cause::External);
    let submitted_pulses = *robot.motion().sent_pulses();
    let claim = "the submitted frame has not been played";
    assert_ne!(started_pulses, submitted_pulses, "{claim}");
    for servo in 1..=4 {
        robot.send_line(&format!("scale {servo} 9.3"));
    }
    let mut first_widths = [None; 4];
    while first_widths.contains(&None) {
        let pulses = robot.run_frame();
        for (first_width, width) in first_widths.iter_mut().zip(pulses.0) {
            if width.0 > 0 {
                first_width.get_or_insert(width);
            }
        }
    }
    assert_eq!(first_widths, submitted_pulses.0.map(Some));
}

/// Runs frames. Returns the largest change of each servo's pulse width from one frame to the next, cycles.
fn measure_max_changes(robot: &mut RunningRobot, frames: usize) -> [u16; 4] {
    let mut last_widths = *robot.motion().sent_pulses();
    let mut changes = [0; 4];
    for _ in 0..frames {
        let pulses = robot.run_frame();
        for (servo, width) in pulses.0.iter().enumerate() {
            if width.0 > 0 {
                changes[servo] = changes[servo].max(width.0.abs_diff(last_widths.0[servo].0));
                last_widths.0[servo] = *width;
            }
        }
    }
    changes
}

#[test]
fn settings_changed_at_rest_turn_no_servo_faster_than_the_slew_limit() {
    let robot = Sample::asymmetric();
    let sweep_per_frame = robot.slew().per_frame;
    let calibration = robot.calibration();
    let max_changes = calibration.map(|servo| servo.max_width_change(sweep_per_frame));
    for reset_cause in [None, Some(Cause::External), Some(Cause::Watchdog)] {
        let mut running_robot = run_standing_robot();
        running_robot.send_and_run("sway", 60);
        running_robot.send_and_run("rest", 60);
        let pulses_before_rest = *running_robot.motion().sent_pulses();
        for servo in 1..=4 {
            running_robot.expect_accepted(&format!("trim {servo} 6"));
        }
        if let Some(cause) = reset_cause {
            running_robot.reset(cause);
            running_robot.run_frames(60);
        }
        running_robot.send_line("stand");
        let changes = measure_max_changes(&mut running_robot, 200);
        for (change, max_change) in changes.into_iter().zip(max_changes) {
            assert!(change <= max_change, "{changes:?}, {max_changes:?}");
            assert!(change > 0, "the neutral pose differs from the rest pose");
        }
        assert_ne!(*running_robot.motion().sent_pulses(), pulses_before_rest);
    }
}
