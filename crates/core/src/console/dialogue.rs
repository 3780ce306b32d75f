//! The console: one line in, one answer out.
//!
//! While the console has nothing to write, the caller passes bytes to it. When the serial
//! line has room for a whole line of text, the caller lets the console write one. So nothing blocks: a long
//! list is written line by line between the frames, and a slow listener never delays a frame.

use crate::console::answer::{Answer, Counters};
use crate::console::command::{self, Command, LineError};
use crate::console::digits;
use crate::console::finder::RateFinder;
use crate::console::line::{GARBLED_BYTE, Line, LineEnd};
use crate::console::output::Output;
use crate::console::print;
use crate::console::refusal;
use crate::console::text::Text;
use crate::console::watch::Watch;
use crate::control::Controller;
use crate::control::order::Acceptance;
use crate::control::refusal::Refusal;
use crate::control::safety::Notice;
use crate::numbers::gaits::GaitId;
use crate::numbers::rate::BaudRate;
use crate::numbers::units::FRAME_MS;

/// The largest length of a line that [`Console::write_line`] writes, with its line end: that of a
/// `status` line whose numbers all have their largest number of digits.
pub const MAX_OUTPUT_LINE_BYTES: u8 = 250;

/// A line that waits to be written. The variants are in order of priority.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PendingLine {
    /// The firmware's version and the robot's name, once after power-on.
    Banner,
    /// The answer to the last line received, or a part of it.
    Answer(Answer),
    /// An unsolicited notice.
    Notice(Notice),
    /// The reason why the guard holds the robot.
    HoldReason,
    /// The pose report that `watch` requested.
    PoseReport,
}

/// The console of a serial line: the line being received, and the answer being written.
#[derive(Clone, Debug)]
pub struct Console {
    line: Line,
    /// Time since the last byte.
    silence_ms: u16,
    rate_finder: RateFinder,
    has_printed_banner: bool,
    /// The next part of the answer to the last line; `None` if nothing is left to be written.
    answer: Option<Answer>,
    watch: Watch,
}

impl Default for Console {
    fn default() -> Self {
        Self::new()
    }
}

impl Console {
    /// Creates a console that has received nothing; it writes the banner first.
    pub const fn new() -> Self {
        Self {
            line: Line::new(),
            silence_ms: 0,
            rate_finder: RateFinder::new(BaudRate::Fastest),
            has_printed_banner: false,
            answer: None,
            watch: Watch::new(0),
        }
    }

    /// Sets the baud rate at which the serial line starts.
    pub const fn set_initial_rate(&mut self, rate: BaudRate) {
        self.rate_finder = RateFinder::new(rate);
    }

    /// Advances the timer of `watch` and the time since the last byte by a frame. Returns the new
    /// baud rate of the serial line; `None` if it stays the same.
    pub fn advance_frame(&mut self, control: &Controller) -> Option<BaudRate> {
        self.watch.count_frame();
        self.silence_ms = self.silence_ms.saturating_add(FRAME_MS);
        let deadman_ms = control.deadman_ms();
        if deadman_ms != 0 && self.silence_ms >= deadman_ms {
            // If the link breaks within `walk 12`, later noise must not complete the line as `walk 1`.
            self.line.garble_unfinished_line();
        }
        if self.has_output(control) {
            self.rate_finder.note_unread_bytes();
        }
        let rate = self.rate_finder.end_frame()?;
        // The next line end may complete a line that began at the previous rate.
        self.line.push(GARBLED_BYTE);
        Some(rate)
    }

    /// True while a line waits to be written. Meanwhile the caller passes no byte to the console, since the answer may
    /// quote the received line.
    pub const fn has_output(&self, control: &Controller) -> bool {
        self.next_pending_line(control).is_some()
    }

    /// Takes a byte from the serial line; if the byte ends a line of text, executes that line.
    // Not inlined, like the next function: that saves half a kilobyte of flash.
    #[inline(never)]
    pub fn receive(&mut self, byte: u8, control: &mut Controller) {
        control.note_byte();
        self.silence_ms = 0;
        self.rate_finder.note_byte(byte);
        let Some(line_end) = self.line.push(byte) else {
            return;
        };
        let answer = match line_end {
            LineEnd::Line => self.execute_line(control),
            LineEnd::TooLong => Err(Answer::Invalid(LineError::TooLong)),
            LineEnd::Garbled => Err(Answer::Invalid(LineError::Garbled)),
        };
        self.answer = answer.unwrap_or_else(Some);
    }

    /// Executes the received line. Returns `Ok(None)` if the order has to wait for the EEPROM; the caller then reports
    /// its outcome with [`Console::finish_order`].
    #[inline(never)]
    fn execute_line(&mut self, control: &mut Controller) -> Result<Option<Answer>, Answer> {
        let robot = control.motion().robot();
        let text = self.line.text();
        let mut command = command::parse(text, robot);
        if command.is_ok() && !self.rate_finder.note_command(text.len()) {
            command = Err(LineError::Garbled);
        }
        let needs_no_robot = matches!(
            command,
            Ok(Command::Help | Command::Status | Command::Watch(_))
        );
        if robot.is_none() && !needs_no_robot {
            return Err(Answer::Refused(Refusal::NoRobot));
        }
        let command = command.map_err(Answer::Invalid)?;
        // Only a valid command shows that there is somebody at the other end, so noise and incomplete lines do not
        // restart the time of `deadman`.
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
                Acceptance::Pending => None,
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

    /// Writes one waiting line, if any, of at most [`MAX_OUTPUT_LINE_BYTES`] bytes: the banner, once after power-on; an
    /// answer or a part of it; a notice; the reason why the guard holds the robot; or the pose report of
    /// `watch`. The longest line, `status`, is written in parts, one per call.
    #[inline(never)]
    pub fn write_line(
        &mut self,
        control: &mut Controller,
        out: &mut impl Output,
        counters: Counters,
    ) {
        match self.next_pending_line(control) {
            None => return,
            Some(PendingLine::Banner) => {
                self.has_printed_banner = true;
                print::print_banner(out, control.motion().robot());
            }
            Some(PendingLine::Answer(answer)) => {
                self.answer = print::print_answer(out, answer, &self.line, control, counters);
                if matches!(answer, Answer::Status | Answer::StatusMargin) {
                    return;
                }
            }
            Some(PendingLine::Notice(notice)) => {
                control.note_printed(notice);
                print::print_notice(out, notice, control);
            }
            Some(PendingLine::HoldReason) => {
                if let Some(hazard) = control.take_hold_reason() {
                    Text::Held.print(out);
                    refusal::print_hazard(hazard, control.motion(), out);
                }
            }
            Some(PendingLine::PoseReport) => {
                self.watch.is_due = false;
                Text::WatchTime.print(out);
                digits::print_number(out, control.motion().frame_count(), 0);
                print::print_pose(out, control.motion());
            }
        }
        out.write_byte(b'\r');
        out.write_byte(b'\n');
    }

    /// The line to be written next, by priority; `None` if nothing waits.
    const fn next_pending_line(&self, control: &Controller) -> Option<PendingLine> {
        if !self.has_printed_banner {
            Some(PendingLine::Banner)
        } else if let Some(answer) = self.answer {
            Some(PendingLine::Answer(answer))
        } else if let Some(notice) = control.safety().next_notice() {
            Some(PendingLine::Notice(notice))
        } else if control.has_hold_reason() {
            Some(PendingLine::HoldReason)
        } else if self.watch.is_due {
            Some(PendingLine::PoseReport)
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests;
