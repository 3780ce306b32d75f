//! The one step that a firmware's main loop repeats.
//!
//! Woken by the tick of the pulses or by a byte, main does one thing at a time
//! and looks for a tick first: a frame waits for one byte or one line at most. While
//! it writes its memory, which takes 3.4 ms a byte, it takes no input, and neither
//! while an answer waits for the serial line to have room for all of it; so it
//! never waits for a listener; and it computes a frame for every tick, also for one
//! that it was late for, so the pace is the timer's and not the processor's.

use core::convert::Infallible;

use ufmt::uWrite;

use crate::console::{Console, Counters, LONGEST_LINE};
use crate::control::Control;
use crate::memory::Memory;
use crate::pose::Pulses;
use crate::restart::{Restart, Stance};
use crate::robot::Robot;
use crate::safety::Health;
use crate::supply::Reading;
use crate::units::CYCLES_PER_US;

/// What main needs of a board.
pub trait Board {
    /// The serial line's other direction.
    type Writer: uWrite<Error = Infallible>;

    /// What outlasts power.
    type Memory: Memory;

    /// Bytes that the writer takes without waiting when the line has taken all before;
    /// at least [`LONGEST_LINE`], for a line is written when there is room for all of
    /// it.
    const ROOM: u8;

    /// Steps of a pulse's width in a microsecond; the core counts in 1/16 us.
    const CYCLES_PER_US: u16;

    /// Ticks since power-on, modulo 256; one every 20 ms.
    fn ticks(&self) -> u8;

    /// Hands over the pulses of the next frame. Says whether those of the call before
    /// have been taken over, true at the first call: then the clock and all that makes
    /// pulses are alive.
    fn submit(&mut self, pulses: Pulses) -> bool;

    /// Puts off the watchdog, which begins the program anew when it hangs. Once it has
    /// ended the pulses, nothing may put it off, and main must not go on.
    fn feed(&mut self);

    /// Keeps what the servos do where a reset of the processor cannot take it away.
    fn keep(&mut self, stance: &Stance);

    /// Why the program began, and what was kept until then.
    fn restart(&self) -> &Restart;

    /// The supplies as measured last; begins the next measurement.
    fn supply(&mut self) -> Reading;

    /// Whether the stack has kept off the data.
    fn stack_is_intact(&self) -> bool;

    /// What outlasts power.
    fn memory(&mut self) -> &mut Self::Memory;

    /// Switches the LED on or off.
    fn set_led(&mut self, on: bool);

    /// Bytes that the writer takes at this moment without waiting.
    fn room(&self) -> u8;

    /// The serial line's writer.
    fn writer(&mut self) -> &mut Self::Writer;

    /// The next byte received, if any; [`crate::line::GARBLED`] for one that came
    /// garbled.
    fn receive(&mut self) -> Option<u8>;

    /// Faults counted so far.
    fn counters(&self) -> Counters;
}

/// The robot, somebody at its serial line, and the ticks that it has computed a frame
/// for.
#[derive(Debug)]
pub struct Main<R> {
    control: Control<R>,
    console: Console,
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
    /// A robot; [`Main::begin`] has to follow.
    pub const fn new(robot: R) -> Self {
        Self {
            control: Control::new(robot),
            console: Console::new(),
            ticks: 0,
        }
    }

    /// Begins on a board. Once, before the first step.
    #[inline(always)]
    pub fn begin<B: Board>(&mut self, board: &mut B) {
        const {
            assert!(B::ROOM >= LONGEST_LINE);
            assert!(B::CYCLES_PER_US == CYCLES_PER_US);
        }
        self.ticks = board.ticks();
        let restart = *board.restart();
        self.control.begin(board.memory(), &restart);
    }

    /// The robot.
    pub const fn control(&self) -> &Control<R> {
        &self.control
    }

    /// The most urgent thing that there is to do.
    #[inline(always)]
    pub fn step<B: Board>(&mut self, board: &mut B) -> Step {
        if board.ticks() != self.ticks {
            self.ticks = self.ticks.wrapping_add(1);
            let health = Health {
                supply: board.supply(),
                late: board.counters().late,
                stack_is_intact: board.stack_is_intact(),
            };
            if board.submit(self.control.frame(&health)) {
                board.feed();
            }
            board.keep(&self.control.stance());
            board.set_led(self.control.is_lit());
            self.console.frame();
        } else if self.console.has_output(&self.control) {
            if board.room() < LONGEST_LINE {
                return Step::Idle(self.ticks);
            }
            let counters = board.counters();
            let out = board.writer();
            let Ok(()) = self.console.write_line(&mut self.control, out, counters);
        } else if self.control.is_writing() {
            if let Some(outcome) = self.control.write_memory(board.memory()) {
                self.console.done(outcome);
            }
        } else if let Some(byte) = board.receive() {
            self.console.receive(byte, &mut self.control);
        } else {
            return Step::Idle(self.ticks);
        }
        Step::Worked
    }
}

#[cfg(test)]
mod tests {
    use std::collections::VecDeque;
    use std::string::String;
    use std::vec::Vec;

    use super::*;
    use crate::motion::Activity;
    use crate::motion::Motion;
    use crate::sample::{Chip, Sample, WELL};

    /// A board that does as it is told and keeps what it was given.
    struct Fake {
        late: u16,
        chip: Chip,
        kept: Vec<Option<Pose>>,
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
                late: 0,
                chip: Chip::blank(),
                kept: Vec::new(),
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
        type Memory = Chip;

        fn keep(&mut self, pose: Option<&Pose>) {
            self.kept.push(pose.copied());
        }

        fn restart(&self) -> Restart {
            Restart::default()
        }

        fn supply(&mut self) -> Reading {
            WELL.supply
        }

        fn stack_is_intact(&self) -> bool {
            true
        }

        fn memory(&mut self) -> &mut Chip {
            &mut self.chip
        }

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
                late: self.late,
                rx_lost: 34,
            }
        }
    }

    fn main_at(ticks: u8) -> Main<Sample> {
        let mut main = Main::new(Sample::odd());
        main.begin(&mut Fake::new(ticks, ""));
        main
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
        assert_eq!(board.output.lines().count(), 1, "one line at a time");
        while board.output.lines().count() < 2 || main.console().is_writing() {
            assert_eq!(main.step(&mut board), Step::Worked);
        }
        assert_eq!(board.input.len(), 9);
        board.ticks = 9;
        assert_eq!(main.step(&mut board), Step::Worked);
        assert_eq!((board.pulses.len(), board.input.len()), (2, 9));
        assert_eq!(main.step(&mut board), Step::Worked);
        assert_eq!(board.input.len(), 8, "one byte at a time");
    }

    #[test]
    fn nothing_is_written_without_room_for_the_longest_line_but_frames_go_on() {
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
            board.output.contains(" frames=30 late=0 rx_lost=34 "),
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
    fn the_led_beats_slowly_and_flashes_once_a_while_when_the_guard_holds_the_robot() {
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
        let (slow, fast) = board.leds.split_at(held_since - 1);
        // Lit from power-on for the first 31 frames; then 32 dark, and so on.
        assert!(slow[..31].iter().all(|led| *led) && !slow[31]);
        assert!(beats(slow).iter().all(|frames| *frames == 32));
        let fast = beats(fast);
        assert!(
            fast.len() > 6 && fast.iter().all(|frames| matches!(frames, 8 | 56)),
            "{fast:?}"
        );
    }

    #[test]
    fn the_pose_is_kept_with_every_frame_but_not_while_the_servos_rest() {
        let mut main = main_at(0);
        let mut board = Fake::new(0, "sway\r");
        for _ in 0..100 {
            settle(&mut main, &mut board);
            board.ticks = board.ticks.wrapping_add(1);
            assert_eq!(main.step(&mut board), Step::Worked);
            let held = main.console().motion().pose();
            assert_eq!(board.kept.last(), Some(&Some(*held)));
        }
        board.input.extend(b"rest\r");
        settle(&mut main, &mut board);
        board.ticks = board.ticks.wrapping_add(1);
        settle(&mut main, &mut board);
        assert_eq!(board.kept.last(), Some(&None));
    }

    #[test]
    fn a_slow_memory_holds_up_the_input_and_no_frame() {
        let mut main = main_at(0);
        let mut board = Fake::new(0, "save\rstand\r");
        board.chip.slowness = 50;
        let mut steps = 0;
        while !board.output.contains("ok save") {
            assert!(!board.output.contains("ok stand"));
            // A tick in every seventh step.
            steps += 1;
            if steps % 7 == 0 {
                board.ticks = board.ticks.wrapping_add(1);
            }
            assert_eq!(main.step(&mut board), Step::Worked);
            assert!(steps < 20_000);
        }
        assert!(board.chip.log.len() > 40 && steps > 40 * 50);
        assert!(board.pulses.len() >= steps / 7 - 1);
        settle(&mut main, &mut board);
        assert!(board.output.ends_with("ok stand\r\n"));
    }

    #[test]
    fn a_late_edge_and_a_stack_in_the_data_reach_the_robot() {
        let mut main = main_at(0);
        let mut board = Fake::new(0, "");
        settle(&mut main, &mut board);
        board.late = 1;
        board.ticks = 1;
        settle(&mut main, &mut board);
        assert!(
            board.output.contains("# fault: a pulse came late"),
            "{}",
            board.output
        );
    }
}
