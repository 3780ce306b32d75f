//! The console's dialogue: one line in, one answer out.
//!
//! While no line waits, or only a report of the pose, the caller passes received bytes to the console. When the
//! transmit buffer has room for a whole line, the caller lets the console write a line. Therefore nothing blocks: a
//! long list is written line by line between the frames, and a slow receiver never delays a frame.

use crate::console::answer::{AnswerPart, Counters};
use crate::console::autobaud::RateDetector;
use crate::console::command::{self, Command, LineError};
use crate::console::digits;
use crate::console::line::{GARBLED_BYTE, Line, LineKind};
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

/// The largest length of an output line, including its line end: a `status` line with the longest name of a gait, in
/// which every number has its largest number of digits.
pub const MAX_OUTPUT_LINE_BYTES: u8 = 250;

/// A line waiting to be written. The variants are in order of priority.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PendingLine {
    /// The firmware's version and the robot's name, once after power-on.
    Banner,
    /// A part of the answer to the last received line.
    Answer(AnswerPart),
    /// An unsolicited notice.
    Notice(Notice),
    /// The hazard that makes the guard hold the robot.
    HoldReason,
    /// The pose report that `watch` requested.
    PoseReport,
}

/// The console of a serial port: the line being received, and the answer being written.
#[derive(Clone, Debug)]
pub struct Console {
    line: Line,
    /// The time since the last received byte.
    silence_ms: u16,
    rate_detector: RateDetector,
    has_printed_banner: bool,
    /// The next part of the answer to the last line; `None` once the answer is written.
    answer: Option<AnswerPart>,
    watch: Watch,
}

impl Console {
    /// Creates a console that has received nothing; it writes the banner first.
    pub const fn new() -> Self {
        Self {
            line: Line::new(),
            silence_ms: 0,
            rate_detector: RateDetector::new(BaudRate::Fastest),
            has_printed_banner: false,
            answer: None,
            watch: Watch::new(0),
        }
    }

    /// Sets the initial baud rate.
    pub const fn set_initial_rate(&mut self, rate: BaudRate) {
        self.rate_detector = RateDetector::new(rate);
    }

    /// Advances the console by a frame: the timer of `watch`, the time since the last byte, and autobaud. Returns the
    /// new baud rate, or `None` if the rate stays the same.
    pub fn advance_frame(&mut self, control: &Controller) -> Option<BaudRate> {
        self.silence_ms = self.silence_ms.saturating_add(FRAME_MS);
        let deadman_ms = control.settings().deadman_ms();
        if deadman_ms != 0 && self.silence_ms >= deadman_ms {
            // If the link breaks within `walk 12`, later noise must not complete the partial line as `walk 1`.
            self.line.mark_partial_line_garbled();
        }
        if self.blocks_input(control) {
            self.rate_detector.record_unread_bytes();
        }
        self.watch.count_frame();
        let rate = self.rate_detector.end_frame()?;
        // The next line end may complete a line that began at the previous rate.
        self.line.push(GARBLED_BYTE);
        Some(rate)
    }

    /// True while a line waits to be written.
    pub const fn has_output(&self, control: &Controller) -> bool {
        self.next_pending_line(control).is_some()
    }

    /// True while a line waits that must be written before the next line is received. An answer may quote the
    /// received
    /// line, so the caller passes no byte meanwhile; banner, notices and the reason of a hold precede the answers to
    /// later lines. Only a report of the pose may wait.
    pub const fn blocks_input(&self, control: &Controller) -> bool {
        !matches!(
            self.next_pending_line(control),
            None | Some(PendingLine::PoseReport)
        )
    }

    /// Adds a received byte to the line; if the byte ends the line, executes the line.
    // Not inlined, like the next function, because that saves half a kilobyte of flash.
    #[inline(never)]
    pub fn receive(&mut self, byte: u8, control: &mut Controller) {
        control.record_byte();
        self.silence_ms = 0;
        self.rate_detector.record_byte(byte);
        let Some(line_kind) = self.line.push(byte) else {
            return;
        };
        let answer = match line_kind {
            LineKind::Valid => self.execute_line(control),
            LineKind::TooLong => Err(AnswerPart::Invalid(LineError::TooLong)),
            LineKind::Garbled => Err(AnswerPart::Invalid(LineError::Garbled)),
        };
        self.answer = answer.unwrap_or_else(Some);
    }

    /// Executes the received line. Returns the first part of its answer, as an error if the line is invalid or its
    /// order is refused. Returns `Ok(None)` if the order must wait for the EEPROM; the caller then reports its outcome
    /// with [`Console::finish_order`].
    #[inline(never)]
    fn execute_line(&mut self, control: &mut Controller) -> Result<Option<AnswerPart>, AnswerPart> {
        let robot = control.motion().robot();
        let text = self.line.text();
        let mut command = command::parse(text, robot);
        if command.is_ok() && !self.rate_detector.confirm_rate(text.len()) {
            command = Err(LineError::Garbled);
        }
        let needs_no_robot = matches!(command, Ok(Command::Help | Command::Status));
        if robot.is_none() && !needs_no_robot {
            return Err(AnswerPart::Refused(Refusal::NoRobot));
        }
        let command = command.map_err(AnswerPart::Invalid)?;
        // Only a valid command proves that a user is connected, so noise and partial lines do not restart the `deadman`
        // timeout.
        control.record_command();
        Ok(match command {
            Command::Help => Some(AnswerPart::HelpGaits(GaitId::STAND)),
            Command::Status => Some(AnswerPart::StatusStart),
            Command::Cal => Some(AnswerPart::CalLine(0)),
            Command::Watch(frames) => {
                self.watch = Watch::new(frames);
                Some(AnswerPart::Done)
            }
            Command::Order(order) => match control.execute(&order).map_err(AnswerPart::Refused)? {
                Acceptance::Done => Some(AnswerPart::Done),
                Acceptance::Pending => None,
            },
        })
    }

    /// Reports the outcome of an order that has waited for the EEPROM.
    pub fn finish_order(&mut self, outcome: Result<(), Refusal>) {
        self.answer = Some(match outcome {
            Ok(()) => AnswerPart::Done,
            Err(refusal) => AnswerPart::Refused(refusal),
        });
    }

    /// Writes the waiting line of the highest priority, if any; it has at most [`MAX_OUTPUT_LINE_BYTES`] bytes. The
    /// longest line, `status`, is written in parts, one per call.
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
                if matches!(answer, AnswerPart::StatusStart | AnswerPart::StatusMargin) {
                    return;
                }
            }
            Some(PendingLine::Notice(notice)) => {
                control.clear_notice(notice);
                print::print_notice(out, notice, control);
            }
            Some(PendingLine::HoldReason) => {
                if let Some(hazard) = control.take_hold_reason() {
                    Text::Held.print(out);
                    refusal::print_hazard(hazard, control.motion(), out);
                }
            }
            Some(PendingLine::PoseReport) => {
                self.watch.is_report_pending = false;
                Text::WatchTime.print(out);
                digits::print_number(out, control.motion().frame_count(), 0);
                print::print_pose(out, control.motion());
            }
        }
        out.write_byte(b'\r');
        out.write_byte(b'\n');
    }

    /// Returns the waiting line of the highest priority; `None` if no line waits.
    const fn next_pending_line(&self, control: &Controller) -> Option<PendingLine> {
        if !self.has_printed_banner {
            Some(PendingLine::Banner)
        } else if let Some(answer) = self.answer {
            Some(PendingLine::Answer(answer))
        } else if let Some(notice) = control.safety().next_notice() {
            Some(PendingLine::Notice(notice))
        } else if control.has_hold_reason() {
            Some(PendingLine::HoldReason)
        } else if self.watch.is_report_pending {
            Some(PendingLine::PoseReport)
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests;
