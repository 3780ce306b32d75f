//! The one step that a firmware's main loop repeats.
//!
//! Woken by the tick of the pulses or by a byte, main does one thing at a time
//! and looks for a tick first: a frame waits for one byte or one line at most. It
//! takes input only while the serial line has room for the longest answer, so it
//! never waits for a listener; and it computes a frame for every tick, also for one
//! that it was late for, so the pace is the timer's and not the processor's.

use core::convert::Infallible;

use ufmt::uWrite;

use crate::console::{Console, Counters, LONGEST_LINE};
use crate::motion::Motion;
use crate::pose::Pulses;
use crate::robot::Robot;

/// What main needs of a board.
pub trait Board {
    /// The serial line's other direction.
    type Writer: uWrite<Error = Infallible>;

    /// Ticks since power-on, modulo 256; one every 20 ms.
    fn ticks(&self) -> u8;

    /// Hands over the pulses of the next frame.
    fn submit(&mut self, pulses: Pulses);

    /// Switches the LED on or off.
    fn set_led(&mut self, on: bool);

    /// Bytes that the writer takes at this moment without waiting, at most 255.
    fn room(&self) -> u8;

    /// The serial line's writer.
    fn writer(&mut self) -> &mut Self::Writer;

    /// The next byte received, if any.
    fn receive(&mut self) -> Option<u8>;

    /// Faults counted so far.
    fn counters(&self) -> Counters;
}

/// The robot, and the ticks that it has computed a frame for.
#[derive(Debug)]
pub struct Main<R> {
    console: Console<R>,
    ticks: u8,
}

/// What a step did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Something; there may be more to do.
    Worked,
    /// Nothing, until [`Board::ticks`] is no longer this number or a byte comes.
    Idle(u8),
}

impl<R: Robot> Main<R> {
    /// A robot at power-on; `ticks` is what [`Board::ticks`] says now.
    pub fn new(robot: R, ticks: u8) -> Self {
        Self {
            console: Console::new(robot),
            ticks,
        }
    }

    /// The console.
    pub const fn console(&self) -> &Console<R> {
        &self.console
    }

    /// The most urgent thing that there is to do.
    #[inline(always)]
    pub fn step<B: Board>(&mut self, board: &mut B) -> Step {
        if board.ticks() != self.ticks {
            self.ticks = self.ticks.wrapping_add(1);
            board.submit(self.console.frame());
            board.set_led(beat(self.console.motion()));
        } else if board.room() < LONGEST_LINE {
            return Step::Idle(self.ticks);
        } else if self.console.has_output() {
            let counters = board.counters();
            let Ok(()) = self.console.write_line(board.writer(), counters);
        } else if let Some(byte) = board.receive() {
            self.console.receive(byte);
        } else {
            return Step::Idle(self.ticks);
        }
        Step::Worked
    }
}

/// The LED: a slow heartbeat, on and off for 0.64 s each, and eight times as
/// fast while the guard holds the robot.
fn beat<R: Robot>(motion: &Motion<R>) -> bool {
    let frames = motion.frames() as u8;
    let half = if motion.hazard().is_some() { 4 } else { 32 };
    frames & half == 0
}

#[cfg(test)]
mod tests {
    use std::collections::VecDeque;
    use std::string::String;
    use std::vec::Vec;

    use super::*;
    use crate::motion::Activity;
    use crate::sample::Sample;

    /// A board that does as it is told and keeps what it was given.
    struct Fake {
        ticks: u8,
        room: u8,
        input: VecDeque<u8>,
        output: String,
        pulses: Vec<Pulses>,
        leds: Vec<bool>,
    }

    impl Fake {
        fn new(ticks: u8, input: &str) -> Self {
            Self {
                ticks,
                room: u8::MAX,
                input: input.bytes().collect(),
                output: String::new(),
                pulses: Vec::new(),
                leds: Vec::new(),
            }
        }
    }

    impl Board for Fake {
        type Writer = String;

        fn ticks(&self) -> u8 {
            self.ticks
        }

        fn submit(&mut self, pulses: Pulses) {
            self.pulses.push(pulses);
        }

        fn set_led(&mut self, on: bool) {
            self.leds.push(on);
        }

        fn room(&self) -> u8 {
            self.room
        }

        fn writer(&mut self) -> &mut String {
            &mut self.output
        }

        fn receive(&mut self) -> Option<u8> {
            self.input.pop_front()
        }

        fn counters(&self) -> Counters {
            Counters {
                late: 12,
                rx_lost: 34,
            }
        }
    }

    fn main_at(ticks: u8) -> Main<Sample> {
        Main::new(Sample::odd(), ticks)
    }

    /// Steps until there is nothing to do.
    fn settle(main: &mut Main<Sample>, board: &mut Fake) {
        for _ in 0..10_000 {
            if main.step(board) != Step::Worked {
                return;
            }
        }
        panic!("it never rests");
    }

    #[test]
    fn a_tick_comes_before_output_and_output_before_input() {
        let mut main = main_at(7);
        let mut board = Fake::new(8, "speed 50\r");
        assert_eq!(main.step(&mut board), Step::Worked);
        assert_eq!(
            (board.pulses.len(), board.output.len(), board.input.len()),
            (1, 0, 9)
        );
        assert_eq!(main.step(&mut board), Step::Worked);
        assert!(board.output.starts_with("# lizard "));
        assert_eq!(board.input.len(), 9);
        board.ticks = 9;
        assert_eq!(main.step(&mut board), Step::Worked);
        assert_eq!((board.pulses.len(), board.input.len()), (2, 9));
        assert_eq!(main.step(&mut board), Step::Worked);
        assert_eq!(board.input.len(), 8, "one byte at a time");
    }

    #[test]
    fn nothing_is_written_or_read_without_room_for_the_longest_line_but_frames_go_on() {
        let mut main = main_at(0);
        let mut board = Fake::new(0, "speed 50\r");
        board.room = LONGEST_LINE - 1;
        assert_eq!(main.step(&mut board), Step::Idle(0));
        assert_eq!((board.output.len(), board.input.len()), (0, 9));
        board.ticks = 1;
        assert_eq!(main.step(&mut board), Step::Worked);
        assert_eq!(main.step(&mut board), Step::Idle(1));
        board.room = LONGEST_LINE;
        settle(&mut main, &mut board);
        assert!(
            board.output.ends_with("\r\nok speed 50\r\n"),
            "{}",
            board.output
        );
        assert_eq!(board.pulses.len(), 1);
    }

    #[test]
    fn every_missed_tick_gets_its_frame_also_across_the_end_of_the_count() {
        let mut main = main_at(250);
        let mut board = Fake::new(250, "");
        settle(&mut main, &mut board);
        board.ticks = 4;
        for frame in 1..=10 {
            assert_eq!(main.step(&mut board), Step::Worked);
            assert_eq!(board.pulses.len(), frame);
        }
        assert_eq!(main.step(&mut board), Step::Idle(4));
        assert_eq!(main.console().motion().frames(), 10);
    }

    #[test]
    fn the_pulses_handed_over_are_those_of_the_motion_and_counters_reach_status() {
        let mut main = main_at(0);
        let mut twin = Motion::new(Sample::odd());
        let mut board = Fake::new(30, "status\r");
        settle(&mut main, &mut board);
        let expected: Vec<Pulses> = (0..30).map(|_| twin.tick()).collect();
        assert_eq!(board.pulses, expected);
        assert!(
            board.output.contains(" frames=30 late=12 rx_lost=34 "),
            "{}",
            board.output
        );
    }

    /// After how many frames the LED changes.
    fn beats(leds: &[bool]) -> Vec<usize> {
        let changes: Vec<usize> = (1..leds.len())
            .filter(|n| leds[*n] != leds[n - 1])
            .collect();
        changes.windows(2).map(|pair| pair[1] - pair[0]).collect()
    }

    #[test]
    fn the_led_beats_slowly_and_eight_times_as_fast_while_the_guard_holds_the_robot() {
        let mut main = main_at(0);
        let mut board = Fake::new(0, "stray\r");
        settle(&mut main, &mut board);
        let mut held_since = 0;
        for frame in 1..400 {
            board.ticks = board.ticks.wrapping_add(1);
            settle(&mut main, &mut board);
            if held_since == 0 && main.console().motion().hazard().is_some() {
                held_since = frame;
            }
        }
        assert_eq!(main.console().motion().activity(), Activity::Stop);
        assert!(held_since > 40);
        let (slow, fast) = board.leds.split_at(held_since);
        // Lit from power-on for the first 31 frames; then 32 dark, and so on.
        assert!(slow[..31].iter().all(|led| *led) && !slow[31]);
        assert!(beats(slow).iter().all(|frames| *frames == 32));
        let fast = beats(fast);
        assert!(
            fast.len() > 20 && fast.iter().all(|frames| *frames == 4),
            "{fast:?}"
        );
    }
}
