use std::vec::Vec;

use super::*;
use crate::console::line::GARBLED;
use crate::memory::restart::Cause;
use crate::motion::Activity;
use crate::motion::Motion;
use crate::sample::Sample;
use crate::virtual_board::{RunningRobot, Transmitter, VirtualBoard};

/// A robot whose program starts at this tick, with these bytes already received.
fn start_robot(ticks: u8, received: &str) -> RunningRobot {
    let mut board = VirtualBoard::default().at_tick(ticks);
    board.send(received.as_bytes());
    RunningRobot::with_flash(Sample::odd().section(), board)
}

/// True if the main loop did something in this step.
fn run_step(running: &mut RunningRobot) -> bool {
    running.main.step(&mut running.board) == Step::Worked
}

/// A robot that stands and has received a line of garbled bytes, as from a sender at another rate.
fn robot_after_garbled_line() -> RunningRobot {
    let mut running = RunningRobot::power_on(*Sample::odd());
    running.run_frames(10);
    running
        .board
        .send(&[GARBLED, 0x80, GARBLED, GARBLED, b'\n']);
    running
}

/// The lines written so far.
fn count_written_lines(running: &RunningRobot) -> usize {
    running.board.transmitter.text.lines().count()
}

#[test]
fn a_tick_comes_before_output_and_output_before_input() {
    let mut running = start_robot(7, "speed 50\r");
    running.board.tick();
    assert!(run_step(&mut running));
    assert!(running.board.is_frame_pending());
    assert_eq!(
        (count_written_lines(&running), running.board.unread()),
        (0, 9)
    );
    assert!(run_step(&mut running));
    assert!(running.board.transmitter.text.starts_with("# lizard "));
    assert_eq!(count_written_lines(&running), 1, "one line at a time");
    while count_written_lines(&running) < 2 || running.main.control().is_writing() {
        assert!(run_step(&mut running));
    }
    assert_eq!(running.board.unread(), 9);
    running.board.tick();
    assert!(run_step(&mut running));
    assert_eq!(running.motion().frames(), 2);
    assert_eq!(running.board.unread(), 9);
    assert!(run_step(&mut running));
    assert_eq!(running.board.unread(), 8, "one byte at a time");
}

#[test]
fn nothing_is_written_without_room_for_the_longest_line_but_frames_go_on() {
    let mut running = start_robot(0, "speed 50\r");
    running.board.transmitter = Transmitter::new(16_000, 255);
    let queued_bytes = 255 - u64::from(LONGEST_LINE) + 1;
    running.board.transmitter.fill(queued_bytes);
    assert_eq!(running.main.step(&mut running.board), Step::Idle(0));
    assert_eq!(
        (count_written_lines(&running), running.board.unread()),
        (0, 9)
    );
    running.board.tick();
    assert!(run_step(&mut running));
    assert_eq!(running.main.step(&mut running.board), Step::Idle(1));
    assert_eq!(
        (count_written_lines(&running), running.board.unread()),
        (0, 9)
    );
    running.board.transmitter = Transmitter::default();
    running.settle();
    let text = &running.board.transmitter.text;
    assert!(text.ends_with("\r\nok speed 50\r\n"), "{text}");
    assert_eq!(running.motion().frames(), 1);
}

#[test]
fn of_several_ticks_at_once_one_gets_a_frame_even_if_the_count_wraps() {
    let mut running = start_robot(250, "");
    running.settle();
    for frames in 1..=300 {
        for _ in 0..frames % 11 + 1 {
            running.board.tick();
        }
        assert!(run_step(&mut running));
        running.settle();
        assert_eq!(running.motion().frames(), frames);
    }
}

#[test]
fn only_the_end_of_the_pulses_replaces_a_frame_that_waits_to_be_played() {
    for is_resting in [false, true] {
        let mut running = start_robot(0, "");
        running.run_frames(100);
        // The main loop is late for a tick, so its frame waits until after the next tick.
        running.board.pass_time(1 + 5);
        running.settle();
        let late_frame = running.board.submitted();
        if is_resting {
            running.board.send(b"rest\r");
            running.settle();
        }
        running.board.pass_time(15);
        running.settle();
        assert_eq!(running.motion().frames(), 101 + u32::from(is_resting));
        assert!(
            running.board.ms_since_fed() >= 15,
            "nor is the watchdog fed"
        );
        running.board.pass_time(19);
        let expected = if is_resting {
            Pulses::default()
        } else {
            late_frame
        };
        assert_eq!(running.board.started_pulses(), expected);
        running.board.pass_time(1);
        running.settle();
        assert_eq!(running.motion().frames(), 102 + u32::from(is_resting));
        assert_eq!(running.board.ms_since_fed(), 0);
    }
}

#[test]
fn the_pulses_handed_over_are_those_of_the_motion_and_counters_reach_status() {
    let mut running = start_robot(0, "");
    let mut lone_motion = Motion::new(*Sample::odd());
    for _ in 0..30 {
        running.frame();
        assert_eq!(running.board.submitted(), lone_motion.tick());
    }
    running.board.count_lost(34);
    let status = running.send_line("status");
    assert!(status.contains(" frames=30 late=0 rx_lost=34 "), "{status}");
}

/// The numbers of frames between the changes of the LED.
fn frames_between_changes(led_states: &[bool]) -> Vec<usize> {
    let changes: Vec<usize> = (1..led_states.len())
        .filter(|n| led_states[*n] != led_states[n - 1])
        .collect();
    changes.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

#[test]
fn the_led_beats_slowly_and_flashes_while_the_guard_holds_the_robot() {
    let mut running = start_robot(0, "stray\r");
    let (mut led_states, mut held_since) = (Vec::new(), 0);
    for frame in 1..400 {
        running.frame();
        led_states.push(running.board.is_lit());
        if held_since == 0 && running.motion().hazard().is_some() {
            held_since = frame;
        }
    }
    assert_eq!(running.motion().activity(), Activity::Stop);
    assert!(held_since > 40);
    let (slow, fast) = led_states.split_at(held_since - 1);
    // Lit for the first 31 frames from power-on, then dark for 32, and so on.
    assert!(slow[..31].iter().all(|led| *led) && !slow[31]);
    assert!(
        frames_between_changes(slow)
            .iter()
            .all(|frames| *frames == 32)
    );
    let fast = frames_between_changes(fast);
    assert!(
        fast.len() > 6 && fast.iter().all(|frames| matches!(frames, 8 | 56)),
        "{fast:?}"
    );
}

#[test]
fn the_servos_state_is_kept_in_every_frame_even_at_rest() {
    let mut running = start_robot(0, "sway\r");
    for _ in 0..100 {
        let pulses = running.frame();
        let stored = running.board.stored_stance().expect("a stance");
        assert!(!stored.is_resting);
        assert_eq!(stored.pose, *running.motion().pose());
        for (sent, pulse) in stored.sent.0.iter().zip(pulses.0) {
            assert!(pulse.0 == 0 || pulse == *sent);
        }
    }
    running.send_line("rest");
    running.frame();
    let stored = running.board.stored_stance().expect("a stance");
    assert!(stored.is_resting);
    assert_eq!(stored.pose, *running.motion().pose());
}

#[test]
fn a_slow_memory_holds_up_the_input_and_no_frame() {
    let mut running = RunningRobot::power_on(*Sample::odd());
    running.run_frames(10);
    running.board.send(b"save\rstand\r");
    running.board.memory.slowness = 50;
    let mut steps = 0;
    while !running.board.transmitter.text.contains("ok save") {
        assert!(!running.board.transmitter.text.contains("ok stand"));
        // A tick in every seventh step.
        steps += 1;
        if steps % 7 == 0 {
            running.board.tick();
        }
        assert!(run_step(&mut running));
        assert!(steps < 20_000);
    }
    assert!(running.board.memory.log.len() > 40 && steps > 40 * 50);
    assert!(running.motion().frames() >= steps / 7 - 1);
    running.settle();
    assert!(running.board.transmitter.text.ends_with("ok stand\r\n"));
}

#[test]
fn the_rest_of_a_line_begun_at_another_rate_is_not_obeyed_but_the_next_is() {
    let mut running = robot_after_garbled_line();
    running.board.send(b"bo");
    assert_eq!(running.board.rate, Rate::Fastest);
    running.run_frames(3);
    assert_eq!(running.board.rate, Rate::Half, "after a pause");
    let text = running.send_line("rest");
    assert_eq!(text, "err 1 the line came garbled, send it again");
    assert!(!running.motion().is_resting());
    assert_eq!(running.send_line("rest"), "ok rest");
    for (cause, rate) in [
        (Cause::Watchdog, Rate::Half),
        (Cause::External, Rate::Fastest),
    ] {
        running.reset(cause);
        assert_eq!(running.board.rate, rate, "{cause:?}");
    }
}

#[test]
fn the_rate_does_not_change_while_bytes_wait_behind_an_answer() {
    let mut running = robot_after_garbled_line();
    running.run_without_reader(10);
    assert_eq!(running.board.rate, Rate::Fastest);
    running.run_frames(3);
    assert_eq!(running.board.rate, Rate::Half);
}

#[test]
fn a_late_edge_and_a_stack_in_the_data_reach_the_robot() {
    let mut running = start_robot(0, "");
    running.run_frames(1);
    running.board.late_edges = 1;
    let printed = running.run_frames(1);
    assert!(
        printed
            .iter()
            .any(|line| line.starts_with("# fault: a pulse came late")),
        "{printed:?}"
    );
    running.board.is_stack_intact = false;
    let printed = running.run_frames(1);
    assert!(
        printed
            .iter()
            .any(|line| line.starts_with("# fault: the stack")),
        "{printed:?}"
    );
}
