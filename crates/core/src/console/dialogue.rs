//! The console: one line in, one answer out.
//!
//! While the console has nothing to write, the caller passes bytes to it. When the serial
//! line has room for a whole line, the caller lets it write one. So nothing waits: a long
//! list comes line by line between the frames, and a slow listener never delays a frame.

use crate::console::answer::{Answer, Counters};
use crate::console::command::{self, Command, Misread};
use crate::console::digits;
use crate::console::finder::RateFinder;
use crate::console::line::{GARBLED, Line, LineEnd};
use crate::console::output::Output;
use crate::console::print;
use crate::console::refusal;
use crate::console::text::Text;
use crate::console::watch::Watch;
use crate::control::Control;
use crate::control::order::Acceptance;
use crate::control::refusal::Refusal;
use crate::control::safety::Notice;
use crate::numbers::gaits::GaitId;
use crate::numbers::rate::Rate;
use crate::numbers::units::FRAME_MS;

/// The longest line that [`Console::write_line`] writes, with its line end: a
/// `status` whose every number has all its digits.
pub const LONGEST_LINE: u8 = 250;

/// A line that waits to be written, in order of priority.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Pending {
    /// The firmware's version and the robot's name, once after power-on.
    Banner,
    /// The answer to the last line received, or a part of it.
    Answer(Answer),
    /// A notice that comes without a command.
    Notice(Notice),
    /// The reason why the guard holds the robot.
    HoldReason,
    /// The pose report that `watch` asked for.
    PoseReport,
}

/// The console at one serial line: the line being received, and the answer being written.
#[derive(Clone, Debug)]
pub struct Console {
    line: Line,
    /// Time since the last byte, ms.
    silence: u16,
    rate_finder: RateFinder,
    has_greeted: bool,
    answer: Option<Answer>,
    watch: Watch,
}

impl Default for Console {
    fn default() -> Self {
        Self::new()
    }
}

impl Console {
    /// A console that has received nothing; it writes the banner first.
    pub const fn new() -> Self {
        Self {
            line: Line::new(),
            silence: 0,
            rate_finder: RateFinder::new(Rate::Fastest),
            has_greeted: false,
            answer: None,
            watch: Watch::new(0),
        }
    }

    /// Sets the rate with which the serial line starts.
    pub const fn begin(&mut self, rate: Rate) {
        self.rate_finder = RateFinder::new(rate);
    }

    /// Advances the timer of `watch` and the time since the last byte by a frame. Returns the new
    /// rate of the serial line; `None` if the rate stays.
    pub fn frame(&mut self, control: &Control) -> Option<Rate> {
        self.watch.count_frame();
        self.silence = self.silence.saturating_add(FRAME_MS);
        let deadman = control.deadman();
        if deadman != 0 && self.silence >= deadman {
            // If the link breaks within `walk 12`, noise that comes later must not complete the line as
            // `walk 1`.
            self.line.garble_unfinished();
        }
        if self.has_output(control) {
            self.rate_finder.note_unread();
        }
        let rate = self.rate_finder.end_frame()?;
        // The next line end may end a line that began at the previous rate.
        self.line.push(GARBLED);
        Some(rate)
    }

    /// True while a line waits to be written. Meanwhile the caller passes no byte on, since the answer may
    /// still need the line that it answers.
    pub const fn has_output(&self, control: &Control) -> bool {
        self.next_pending(control).is_some()
    }

    /// Takes a byte from the serial line; if the byte ends a line of text, executes that line.
    // Not inlined, like the next function: that saves half a kilobyte of flash.
    #[inline(never)]
    pub fn receive(&mut self, byte: u8, control: &mut Control) {
        control.note_byte();
        self.silence = 0;
        self.rate_finder.note_byte(byte);
        let Some(line_end) = self.line.push(byte) else {
            return;
        };
        let answer = match line_end {
            LineEnd::Line => self.execute_line(control),
            LineEnd::TooLong => Err(Answer::Misread(Misread::TooLong)),
            LineEnd::Garbled => Err(Answer::Misread(Misread::Garbled)),
        };
        self.answer = answer.unwrap_or_else(Some);
    }

    /// Executes the received line. Returns `Ok(None)` if the order has to wait for the EEPROM; then
    /// [`Console::finish_order`] has to follow.
    #[inline(never)]
    fn execute_line(&mut self, control: &mut Control) -> Result<Option<Answer>, Answer> {
        let robot = control.motion().robot();
        let text = self.line.text();
        let mut command = command::parse(text, robot);
        if command.is_ok() && !self.rate_finder.note_command(text.len()) {
            command = Err(Misread::Garbled);
        }
        let needs_no_robot = matches!(
            command,
            Ok(Command::Help | Command::Status | Command::Watch(_))
        );
        if robot.is_none() && !needs_no_robot {
            return Err(Answer::Refused(Refusal::NoRobot));
        }
        let command = command.map_err(Answer::Misread)?;
        // Only a valid command shows that somebody is at the other end, so `deadman` ignores noise and parts of
        // lines.
        control.note_command();
        Ok(match command {
            Command::Help => Some(Answer::HelpGaits(GaitId::STAND)),
            Command::Status => Some(Answer::Status),
            Command::Cal => Some(Answer::Settings(0)),
            Command::Watch(frames) => {
                self.watch = Watch::new(frames);
                Some(Answer::Done)
            }
            Command::Order(order) => match control.execute(&order).map_err(Answer::Refused)? {
                Acceptance::Done => Some(Answer::Done),
                Acceptance::Later => None,
            },
        })
    }

    /// Reports the outcome of an order that had to wait for the EEPROM.
    pub fn finish_order(&mut self, outcome: Result<(), Refusal>) {
        self.answer = Some(match outcome {
            Ok(()) => Answer::Done,
            Err(refusal) => Answer::Refused(refusal),
        });
    }

    /// Writes one waiting line, if any, at most [`LONGEST_LINE`] bytes: the banner, once after power-on; an
    /// answer or a part of it; a notice; the reason why the guard holds the robot; or the pose report of
    /// `watch`. The longest line, `status`, is written in parts, one per call.
    #[inline(never)]
    pub fn write_line(&mut self, control: &mut Control, out: &mut impl Output, counters: Counters) {
        match self.next_pending(control) {
            None => return,
            Some(Pending::Banner) => {
                self.has_greeted = true;
                print::banner(out, control.motion().robot());
            }
            Some(Pending::Answer(answer)) => {
                self.answer = print::answer(out, answer, &self.line, control, counters);
                if matches!(answer, Answer::Status | Answer::StatusMargin) {
                    return;
                }
            }
            Some(Pending::Notice(notice)) => {
                control.note_printed(notice);
                print::notice(out, notice, control);
            }
            Some(Pending::HoldReason) => {
                if let Some(hazard) = control.take_hold_reason() {
                    Text::Held.print(out);
                    refusal::print_hazard(hazard, control.motion(), out);
                }
            }
            Some(Pending::PoseReport) => {
                self.watch.is_due = false;
                Text::WatchTime.print(out);
                digits::print_number(out, control.motion().frames(), 0);
                print::pose(out, control.motion());
            }
        }
        out.byte(b'\r');
        out.byte(b'\n');
    }

    /// The output to write next, in a fixed order of priority; `None` if nothing waits.
    const fn next_pending(&self, control: &Control) -> Option<Pending> {
        if !self.has_greeted {
            Some(Pending::Banner)
        } else if let Some(answer) = self.answer {
            Some(Pending::Answer(answer))
        } else if let Some(notice) = control.safety().notice() {
            Some(Pending::Notice(notice))
        } else if control.has_hold_reason() {
            Some(Pending::HoldReason)
        } else if self.watch.is_due {
            Some(Pending::PoseReport)
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests;
