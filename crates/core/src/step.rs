//! The one step that a firmware's main loop repeats.
//!
//! The tick of the pulses or a byte wakes main. It does one thing at a time and looks for
//! a tick first, so a frame waits for one byte or one line at most. It takes no input
//! while it writes its memory (3.4 ms a byte), or while an answer waits for room in the
//! serial line; so it never waits for a listener. It computes one frame for a tick. If it
//! is too late for a tick, it leaves that tick out: several frames at once would be
//! played as one, and the servos would leap. It also leaves a tick out while a late frame
//! still waits to be played.

use lizard_avr::Region;

use crate::console::answer::Counters;
use crate::console::output::Output;
use crate::console::{Console, LONGEST_LINE};
use crate::control::Control;
use crate::control::safety::Health;
use crate::control::supply::Reading;
use crate::memory::record::Memory;
use crate::memory::restart::{Restart, Stance};
use crate::numbers::pose::Pulses;
use crate::numbers::rate::Rate;
use crate::numbers::units::CYCLES_PER_US;

/// The hardware that the main loop needs.
pub trait Board {
    /// The serial line's other direction.
    type Writer: Output;

    /// The memory that keeps its bytes without power.
    type Memory: Memory;

    /// Bytes that an idle writer takes without waiting; at least [`LONGEST_LINE`], since a
    /// line is written only when there is room for all of it.
    const ROOM: u8;

    /// Steps of a pulse's width in a microsecond; the core counts in 1/16 us.
    const CYCLES_PER_US: u16;

    /// Connects the servos A1 to A4 to these pins, and the measured rail, if there is
    /// one, by their Arduino numbers; 14 to 19 are A0 to A5. Called once, before the first
    /// pulses.
    fn connect(&mut self, servos: [u8; 4], rail: Option<u8>);

    /// Ticks since power-on, modulo 256; one every 20 ms.
    fn ticks(&self) -> u8;

    /// True if the pulses handed over last, if any, have been taken over: then the clock
    /// and all that makes pulses are alive.
    fn is_taken(&self) -> bool;

    /// Hands over the pulses of the next frame, in place of any that have not been taken
    /// over.
    fn submit(&mut self, pulses: Pulses);

    /// Feeds the watchdog, which restarts the program when it hangs. Once it has
    /// ended the pulses, nothing may put it off, and main must not go on.
    fn feed(&mut self);

    /// Stores the servos' state and the consecutive resets that a weak supply may have
    /// caused, where they survive a reset of the processor.
    fn store_stance(&mut self, stance: &Stance, brown_outs: u8);

    /// The cause of the last reset, and the state from before it.
    fn restart(&self) -> &Restart;

    /// The supplies as measured last; begins the next measurement.
    fn supply(&mut self) -> Reading;

    /// True while the stack has not grown into the data.
    fn is_stack_intact(&self) -> bool;

    /// True while the contact between this pin, by its Arduino number, and ground is closed.
    /// Switches the pin's pull-up on.
    fn is_closed(&mut self, pin: u8) -> bool;

    /// The memory that keeps its bytes without power.
    fn memory(&mut self) -> &mut Self::Memory;

    /// Switches the LED on or off.
    fn set_led(&mut self, is_on: bool);

    /// Bytes that the writer takes at this moment without waiting.
    fn room(&self) -> u8;

    /// The serial line's writer.
    fn writer(&mut self) -> &mut Self::Writer;

    /// The next byte received, if any; [`crate::console::line::GARBLED`] for one that came
    /// garbled.
    fn receive(&mut self) -> Option<u8>;

    /// Changes the rate of the serial line, and stores it where it survives a reset.
    fn set_rate(&mut self, rate: Rate);

    /// Faults counted so far.
    fn counters(&self) -> Counters;
}

/// The robot, its console at the serial line, and the tick of its last frame.
#[derive(Clone, Debug)]
pub struct Main {
    control: Control,
    console: Console,
    ticks: u8,
}

/// The result of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// The step did something; there may be more to do.
    Worked,
    /// Nothing to do until [`Board::ticks`] differs from this number or a byte is received.
    Idle(u8),
}

impl Default for Main {
    fn default() -> Self {
        Self::new()
    }
}

impl Main {
    /// A main without a robot; [`Main::begin`] has to follow.
    ///
    /// Every bit of it is zero, so that a firmware's `Main` needs no copy in flash; its linker
    /// script refuses one that does.
    pub const fn new() -> Self {
        Self {
            control: Control::new(),
            console: Console::new(),
            ticks: 0,
        }
    }

    /// Begins on a board, with the robot at the beginning of `flash`. To be called once, before
    /// the first step.
    #[inline(always)]
    pub fn begin<B: Board>(&mut self, flash: Region<'static>, board: &mut B) {
        const {
            assert!(B::ROOM >= LONGEST_LINE);
            assert!(B::CYCLES_PER_US == CYCLES_PER_US);
        }
        let restart = *board.restart();
        self.control.begin(flash, board.memory(), &restart);
        self.console.begin(restart.rate);
        let robot = self.control.motion().robot();
        if !robot.is_none() {
            board.connect(robot.pins(), robot.rail_pin());
        }
        self.ticks = board.ticks();
    }

    /// The robot's control.
    pub const fn control(&self) -> &Control {
        &self.control
    }

    /// The console at its serial line.
    pub const fn console(&self) -> &Console {
        &self.console
    }

    /// Does the most urgent task.
    #[inline(always)]
    pub fn step<B: Board>(&mut self, board: &mut B) -> Step {
        let ticks = board.ticks();
        if ticks != self.ticks {
            self.ticks = ticks;
            if board.is_taken() {
                board.feed();
            } else if !self.control.motion().is_resting() {
                return Step::Worked;
            }
            let health = Health {
                supply: board.supply(),
                late: board.counters().late,
                is_stack_intact: board.is_stack_intact(),
                is_closed: match self.control.input().pin() {
                    0 => false,
                    pin => board.is_closed(pin),
                },
            };
            board.submit(self.control.frame(&health));
            self.store_stance(board);
            board.set_led(self.control.is_lit());
            if let Some(rate) = self.console.frame(&self.control) {
                board.set_rate(rate);
            }
        } else if self.console.has_output(&self.control) {
            if board.room() < LONGEST_LINE {
                return Step::Idle(self.ticks);
            }
            let counters = board.counters();
            let out = board.writer();
            self.console.write_line(&mut self.control, out, counters);
        } else if self.control.waits_for_supply() {
            return Step::Idle(self.ticks);
        } else if self.control.is_writing() {
            if let Some(outcome) = self.control.write_memory(board.memory()) {
                self.console.done(outcome);
            }
        } else if let Some(byte) = board.receive() {
            let rested = self.control.motion().is_resting();
            self.console.receive(byte, &mut self.control);
            // Before the answer: a reset may come right after it.
            if self.control.motion().is_resting() != rested {
                self.store_stance(board);
            }
        } else {
            return Step::Idle(self.ticks);
        }
        Step::Worked
    }

    fn store_stance<B: Board>(&self, board: &mut B) {
        board.store_stance(self.control.motion().stance(), self.control.brown_outs());
    }
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::*;
    use crate::console::line::GARBLED;
    use crate::memory::restart::Cause;
    use crate::motion::Activity;
    use crate::motion::Motion;
    use crate::sample::Sample;
    use crate::virtual_board::{Running, Transmitter, VirtualBoard};

    /// A robot whose program begins at this tick, with these bytes already received.
    fn begun(ticks: u8, received: &str) -> Running {
        let mut board = VirtualBoard::default().at_tick(ticks);
        board.send(received.as_bytes());
        Running::on(Sample::odd().section(), board)
    }

    /// True if main does something in a step.
    fn works(running: &mut Running) -> bool {
        running.main.step(&mut running.board) == Step::Worked
    }

    /// The lines written so far.
    fn written(running: &Running) -> usize {
        running.board.transmitter.text.lines().count()
    }

    #[test]
    fn a_tick_comes_before_output_and_output_before_input() {
        let mut running = begun(7, "speed 50\r");
        running.board.tick();
        assert!(works(&mut running));
        assert!(running.board.is_fresh());
        assert_eq!((written(&running), running.board.unread()), (0, 9));
        assert!(works(&mut running));
        assert!(running.board.transmitter.text.starts_with("# lizard "));
        assert_eq!(written(&running), 1, "one line at a time");
        while written(&running) < 2 || running.main.control().is_writing() {
            assert!(works(&mut running));
        }
        assert_eq!(running.board.unread(), 9);
        running.board.tick();
        assert!(works(&mut running));
        assert_eq!(running.motion().frames(), 2);
        assert_eq!(running.board.unread(), 9);
        assert!(works(&mut running));
        assert_eq!(running.board.unread(), 8, "one byte at a time");
    }

    #[test]
    fn nothing_is_written_without_room_for_the_longest_line_but_frames_go_on() {
        let mut running = begun(0, "speed 50\r");
        running.board.transmitter = Transmitter::new(16_000, 255);
        let full = 255 - u64::from(LONGEST_LINE) + 1;
        running.board.transmitter.fill(full);
        assert_eq!(running.main.step(&mut running.board), Step::Idle(0));
        assert_eq!((written(&running), running.board.unread()), (0, 9));
        running.board.tick();
        assert!(works(&mut running));
        assert_eq!(running.main.step(&mut running.board), Step::Idle(1));
        assert_eq!((written(&running), running.board.unread()), (0, 9));
        running.board.transmitter = Transmitter::default();
        running.settle();
        let text = &running.board.transmitter.text;
        assert!(text.ends_with("\r\nok speed 50\r\n"), "{text}");
        assert_eq!(running.motion().frames(), 1);
    }

    #[test]
    fn of_several_ticks_at_once_one_gets_a_frame_even_if_the_count_wraps() {
        let mut running = begun(250, "");
        running.settle();
        for frames in 1..=300 {
            for _ in 0..frames % 11 + 1 {
                running.board.tick();
            }
            assert!(works(&mut running));
            running.settle();
            assert_eq!(running.motion().frames(), frames);
        }
    }

    #[test]
    fn only_the_end_of_the_pulses_replaces_a_frame_that_waits_to_be_played() {
        for rests in [false, true] {
            let mut running = begun(0, "");
            running.run(100);
            // Main is late for a tick: its frame waits until after the next one.
            running.board.pass_time(1 + 5);
            running.settle();
            let late = running.board.submitted();
            if rests {
                running.board.send(b"rest\r");
                running.settle();
            }
            running.board.pass_time(15);
            running.settle();
            assert_eq!(running.motion().frames(), 101 + u32::from(rests));
            assert!(
                running.board.ms_since_fed() >= 15,
                "nor is the watchdog fed"
            );
            running.board.pass_time(19);
            let played = if rests { Pulses::default() } else { late };
            assert_eq!(running.board.started_pulses(), played);
            running.board.pass_time(1);
            running.settle();
            assert_eq!(running.motion().frames(), 102 + u32::from(rests));
            assert_eq!(running.board.ms_since_fed(), 0);
        }
    }

    #[test]
    fn the_pulses_handed_over_are_those_of_the_motion_and_counters_reach_status() {
        let mut running = begun(0, "");
        let mut alone = Motion::new(*Sample::odd());
        for _ in 0..30 {
            running.frame();
            assert_eq!(running.board.submitted(), alone.tick());
        }
        running.board.count_lost(34);
        let status = running.say("status");
        assert!(status.contains(" frames=30 late=0 rx_lost=34 "), "{status}");
    }

    /// The numbers of the frames at which the LED changes.
    fn beats(leds: &[bool]) -> Vec<usize> {
        let changes: Vec<usize> = (1..leds.len())
            .filter(|n| leds[*n] != leds[n - 1])
            .collect();
        changes.windows(2).map(|pair| pair[1] - pair[0]).collect()
    }

    #[test]
    fn the_led_beats_slowly_and_flashes_while_the_guard_holds_the_robot() {
        let mut running = begun(0, "stray\r");
        let (mut leds, mut held_since) = (Vec::new(), 0);
        for frame in 1..400 {
            running.frame();
            leds.push(running.board.is_lit());
            if held_since == 0 && running.motion().hazard().is_some() {
                held_since = frame;
            }
        }
        assert_eq!(running.motion().activity(), Activity::Stop);
        assert!(held_since > 40);
        let (slow, fast) = leds.split_at(held_since - 1);
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
    fn the_servos_state_is_kept_in_every_frame_even_at_rest() {
        let mut running = begun(0, "sway\r");
        for _ in 0..100 {
            let pulses = running.frame();
            let kept = running.board.stored_stance().expect("a stance");
            assert!(!kept.is_resting);
            assert_eq!(kept.pose, *running.motion().pose());
            for (sent, pulse) in kept.sent.0.iter().zip(pulses.0) {
                assert!(pulse.0 == 0 || pulse == *sent);
            }
        }
        running.say("rest");
        running.frame();
        let kept = running.board.stored_stance().expect("a stance");
        assert!(kept.is_resting);
        assert_eq!(kept.pose, *running.motion().pose());
    }

    #[test]
    fn a_slow_memory_holds_up_the_input_and_no_frame() {
        let mut running = Running::power_on(*Sample::odd());
        running.run(10);
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
            assert!(works(&mut running));
            assert!(steps < 20_000);
        }
        assert!(running.board.memory.log.len() > 40 && steps > 40 * 50);
        assert!(running.motion().frames() >= steps / 7 - 1);
        running.settle();
        assert!(running.board.transmitter.text.ends_with("ok stand\r\n"));
    }

    #[test]
    fn the_rest_of_a_line_begun_at_another_rate_is_not_obeyed_but_the_next_is() {
        let mut running = Running::power_on(*Sample::odd());
        running.run(10);
        running
            .board
            .send(&[GARBLED, 0x80, GARBLED, GARBLED, b'\n']);
        running.board.send(b"bo");
        assert_eq!(running.board.rate, Rate::Fastest);
        running.run(3);
        assert_eq!(running.board.rate, Rate::Half, "after a pause");
        let text = running.say("rest");
        assert_eq!(text, "err 1 the line came garbled, send it again");
        assert!(!running.motion().is_resting());
        assert_eq!(running.say("rest"), "ok rest");
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
        let mut running = Running::power_on(*Sample::odd());
        running.run(10);
        running
            .board
            .send(&[GARBLED, 0x80, GARBLED, GARBLED, b'\n']);
        running.run_without_reader(10);
        assert_eq!(running.board.rate, Rate::Fastest);
        running.run(3);
        assert_eq!(running.board.rate, Rate::Half);
    }

    #[test]
    fn a_late_edge_and_a_stack_in_the_data_reach_the_robot() {
        let mut running = begun(0, "");
        running.run(1);
        running.board.late = 1;
        let printed = running.run(1);
        assert!(
            printed
                .iter()
                .any(|line| line.starts_with("# fault: a pulse came late")),
            "{printed:?}"
        );
        running.board.is_stack_intact = false;
        let printed = running.run(1);
        assert!(
            printed
                .iter()
                .any(|line| line.starts_with("# fault: the stack")),
            "{printed:?}"
        );
    }
}
