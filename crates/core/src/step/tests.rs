//! Tests of the main loop's step on a virtual board.

use std::vec::Vec;

use super::*;
use crate::console::line::GARBLED_BYTE;
use crate::memory::restart::Cause;
use crate::motion::{Activity, Motion};
use crate::sample::Sample;
use crate::virtual_board::{RunningRobot, Transmitter, VirtualBoard};

/// Starts a robot's program on a board that has counted `ticks` ticks and has received the bytes of `input`.
fn start_robot(ticks: u8, input: &str) -> RunningRobot {
    let mut board = VirtualBoard::default();
    for _ in 0..ticks {
        board.tick();
    }
    board.send(input.as_bytes());
    RunningRobot::with_flash(Sample::asymmetric().section(), board)
}

/// Runs a step. Returns true if the main loop did a task.
fn run_step(robot: &mut RunningRobot) -> bool {
    robot.main.step(&mut robot.board) == StepResult::Worked
}

/// Returns a robot that has just received a line of garbled bytes, as from a sender at another baud rate.
fn start_robot_with_garbled_line() -> RunningRobot {
    let mut robot = RunningRobot::power_on(*Sample::asymmetric());
    robot.run_frames(10);
    let bytes = [GARBLED_BYTE, 0x80, GARBLED_BYTE, GARBLED_BYTE, b'\n'];
    robot.board.send(&bytes);
    robot
}

/// Counts the lines written so far.
fn count_written_lines(robot: &RunningRobot) -> usize {
    robot.board.transmitter.text.lines().count()
}

/// Counts the lines that the robot has written, and the bytes that it has not read.
fn count_written_lines_and_unread_bytes(robot: &RunningRobot) -> (usize, usize) {
    (count_written_lines(robot), robot.board.unread_count())
}

#[test]
fn a_tick_has_priority_over_output_and_output_over_input() {
    let mut robot = start_robot(7, "speed 50\r");
    robot.board.tick();
    assert!(run_step(&mut robot));
    assert!(robot.board.is_frame_pending());
    assert_eq!(count_written_lines_and_unread_bytes(&robot), (0, 9));
    assert!(run_step(&mut robot));
    assert!(robot.board.transmitter.text.starts_with("# lizard "));
    assert_eq!(count_written_lines(&robot), 1, "one line at a time");
    while count_written_lines(&robot) < 2 || robot.main.control().is_memory_in_use() {
        assert!(run_step(&mut robot));
    }
    assert_eq!(robot.board.unread_count(), 9);
    robot.board.tick();
    assert!(run_step(&mut robot));
    assert_eq!(robot.motion().frame_count(), 2);
    assert_eq!(robot.board.unread_count(), 9);
    assert!(run_step(&mut robot));
    assert_eq!(robot.board.unread_count(), 8, "one byte at a time");
}

#[test]
fn without_room_for_the_longest_line_nothing_is_written_but_frames_continue() {
    let mut robot = start_robot(0, "speed 50\r");
    let capacity = 255;
    robot.board.transmitter = Transmitter::new(16_000, capacity);
    let queued_bytes = capacity - u64::from(MAX_OUTPUT_LINE_BYTES) + 1;
    robot.board.transmitter.queue_bytes(queued_bytes);
    assert_eq!(robot.main.step(&mut robot.board), StepResult::Idle(0));
    assert_eq!(count_written_lines_and_unread_bytes(&robot), (0, 9));
    robot.board.tick();
    assert!(run_step(&mut robot));
    assert_eq!(robot.main.step(&mut robot.board), StepResult::Idle(1));
    assert_eq!(count_written_lines_and_unread_bytes(&robot), (0, 9));
    robot.board.transmitter = Transmitter::default();
    robot.settle();
    let text = &robot.board.transmitter.text;
    assert!(text.ends_with("\r\nok speed 50\r\n"), "{text}");
    assert_eq!(robot.motion().frame_count(), 1);
}

#[test]
fn the_eeprom_is_written_even_while_a_line_waits_for_room() {
    let mut robot = RunningRobot::power_on(*Sample::asymmetric());
    robot.run_frames(100);
    robot.board.send(b"rest\r");
    robot.run_without_reader(10);
    assert!(robot.has_output());
    assert!(!robot.main.control().is_memory_in_use());
}

#[test]
fn a_line_is_executed_while_a_pose_report_waits_for_room() {
    let mut robot = RunningRobot::power_on(*Sample::asymmetric());
    robot.run_frames(100);
    for line in [&b"watch 1\r"[..], b"sway\r"] {
        robot.board.send(line);
        robot.run_frames(2);
    }
    robot.board.transmitter.is_held = true;
    robot.run_frames(2);
    assert!(robot.has_output());
    robot.board.send(b"stop\r");
    robot.run_frames(1);
    assert_eq!(robot.motion().activity(), Activity::Stop);
}

#[test]
fn several_ticks_at_once_get_one_frame_even_if_their_count_wraps() {
    let mut robot = start_robot(250, "");
    robot.settle();
    for frames in 1..=300 {
        for _ in 0..frames % 11 + 1 {
            robot.board.tick();
        }
        assert!(run_step(&mut robot));
        robot.settle();
        assert_eq!(robot.motion().frame_count(), frames);
    }
}

#[test]
fn a_frame_that_has_not_started_is_replaced_only_at_rest() {
    for is_resting in [false, true] {
        let mut robot = start_robot(0, "");
        robot.run_frames(100);
        // The main loop is late for a tick, so this frame waits until after the next tick.
        robot.board.pass_time(1 + 5);
        robot.settle();
        let late_frame = robot.board.submitted_pulses();
        if is_resting {
            robot.board.send(b"rest\r");
            robot.settle();
        }
        robot.board.pass_time(15);
        robot.settle();
        assert_eq!(robot.motion().frame_count(), 101 + u32::from(is_resting));
        let ms_since_fed = robot.board.ms_since_fed();
        assert!(
            ms_since_fed >= 15,
            "the watchdog was fed although the frame still waits"
        );
        robot.board.pass_time(19);
        let expected_pulses = match is_resting {
            true => Pulses::default(),
            false => late_frame,
        };
        assert_eq!(robot.board.started_pulses(), expected_pulses);
        robot.board.pass_time(1);
        robot.settle();
        assert_eq!(robot.motion().frame_count(), 102 + u32::from(is_resting));
        assert_eq!(robot.board.ms_since_fed(), 0);
    }
}

#[test]
fn submitted_pulses_match_the_motion() {
    let mut robot = start_robot(0, "");
    let mut motion_alone = Motion::new(*Sample::asymmetric());
    for _ in 0..30 {
        robot.run_frame();
        assert_eq!(robot.board.submitted_pulses(), motion_alone.advance_frame());
    }
}

/// Returns the numbers of frames between the changes of the LED.
fn measure_change_intervals(led_states: &[bool]) -> Vec<usize> {
    let changes: Vec<usize> = (1..led_states.len())
        .filter(|n| led_states[*n] != led_states[n - 1])
        .collect();
    changes.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

#[test]
fn the_led_shows_the_heartbeat_and_flashes_while_the_guard_holds_the_robot() {
    let mut robot = start_robot(0, "stray\r");
    let (mut led_states, mut first_held_frame) = (Vec::new(), 0);
    for frame in 1..400 {
        robot.run_frame();
        led_states.push(robot.board.is_lit());
        if first_held_frame == 0 && robot.motion().hazard().is_some() {
            first_held_frame = frame;
        }
    }
    assert_eq!(robot.motion().activity(), Activity::Stop);
    assert!(first_held_frame > 40);
    let (heartbeat_states, flash_states) = led_states.split_at(first_held_frame - 1);
    // The LED is lit for the first 31 frames from power-on, then dark for 32 frames, and so on.
    assert!(heartbeat_states[..31].iter().all(|is_lit| *is_lit) && !heartbeat_states[31]);
    let heartbeat_intervals = measure_change_intervals(heartbeat_states);
    assert!(heartbeat_intervals.iter().all(|frames| *frames == 32));
    let flash_intervals = measure_change_intervals(flash_states);
    assert!(flash_intervals.len() > 6, "{flash_intervals:?}");
    let is_flash = |frames: &usize| matches!(frames, 8 | 56);
    assert!(flash_intervals.iter().all(is_flash), "{flash_intervals:?}");
}

#[test]
fn the_servo_state_is_stored_in_every_frame_even_at_rest() {
    let mut robot = start_robot(0, "sway\r");
    for is_resting in [false, true] {
        if is_resting {
            robot.expect_accepted("rest");
        }
        for _ in 0..100 {
            let pulses = robot.run_frame();
            let servo_state = robot.board.ram.peek_restart(None).servo_state_before;
            let servo_state = servo_state.expect("the board has stored a servo state");
            assert_eq!(servo_state.is_resting, is_resting);
            assert_eq!(servo_state.pose, *robot.motion().pose());
            for (sent, pulse) in servo_state.sent_pulses.0.iter().zip(pulses.0) {
                assert!(pulse.0 == 0 || pulse == *sent);
            }
        }
    }
}

#[test]
fn a_slow_memory_delays_the_input_but_no_frame() {
    let mut robot = RunningRobot::power_on(*Sample::asymmetric());
    robot.run_frames(10);
    robot.board.send(b"save\rstand\r");
    robot.board.memory.write_delay = 50;
    let mut steps = 0;
    while !robot.board.transmitter.text.contains("ok save") {
        assert!(!robot.board.transmitter.text.contains("ok stand"));
        // Every seventh step has a tick.
        steps += 1;
        if steps % 7 == 0 {
            robot.board.tick();
        }
        assert!(run_step(&mut robot));
        assert!(steps < 20_000);
    }
    assert!(robot.board.memory.log.len() > 40 && steps > 40 * 50);
    assert!(robot.motion().frame_count() >= steps / 7 - 1);
    robot.settle();
    assert!(robot.board.transmitter.text.ends_with("ok stand\r\n"));
}

#[test]
fn a_line_that_began_at_another_rate_is_garbled_and_the_next_line_is_executed() {
    let mut robot = start_robot_with_garbled_line();
    robot.board.send(b"bo");
    assert_eq!(robot.board.rate, BaudRate::Fastest);
    robot.run_frames(3);
    let rate = robot.board.rate;
    assert_eq!(rate, BaudRate::Half, "the rate changes after a pause");
    let text = robot.send_line("rest");
    assert_eq!(text, "err 1 the line was garbled; send it again");
    assert!(!robot.motion().is_resting());
    assert_eq!(robot.send_line("rest"), "ok rest");
    for (cause, rate) in [
        (Cause::Watchdog, BaudRate::Half),
        (Cause::External, BaudRate::Fastest),
    ] {
        robot.reset(cause);
        assert_eq!(robot.board.rate, rate, "{cause:?}");
    }
}

#[test]
fn the_rate_does_not_change_while_received_bytes_wait_for_an_answer() {
    let mut robot = start_robot_with_garbled_line();
    robot.run_without_reader(10);
    assert_eq!(robot.board.rate, BaudRate::Fastest);
    robot.run_frames(3);
    assert_eq!(robot.board.rate, BaudRate::Half);
}

#[test]
fn a_report_in_every_frame_does_not_prevent_a_change_of_the_rate() {
    let mut robot = RunningRobot::power_on(*Sample::asymmetric());
    robot.expect_accepted("watch 1");
    robot.board.send(&[GARBLED_BYTE; 32]);
    robot.run_frames(3);
    assert_eq!(robot.board.rate, BaudRate::Half);
}

#[test]
fn a_late_edge_and_a_stack_overflow_are_reported_as_faults() {
    let mut robot = start_robot(0, "");
    robot.run_frames(1);
    robot.board.late_edges = 1;
    assert_eq!(robot.run_frames(1), ["# fault: a pulse was late, stopped"]);
    robot.board.is_stack_intact = false;
    let fault = "# fault: the stack has grown into the data, stopped";
    assert_eq!(robot.run_frames(1), [fault]);
}
