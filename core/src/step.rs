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
