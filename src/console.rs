//! The console: one line in, one answer out.
//!
//! The caller feeds bytes while the console has nothing to say and asks it to
//! speak while the serial line has room for a whole line. So nothing waits:
//! a long list comes line by line between the frames, and a frame is never
//! late because of a listener who is slow.

use ufmt::uWrite;

use crate::answer::{self, Answer, Refusal};
use crate::clearance::Clearance;
use crate::command::{Command, parse};
use crate::gait::GaitId;
use crate::line::{Ended, Line};
use crate::motion::{Activity, Motion};
use crate::pose::Pulses;
use crate::robot::TABLES_HASH;
use crate::text::Text;
use crate::units::{thousandths_from_phase, thousandths_from_q15};

/// The longest line that [`Console::speak`] writes, with its line end: a
/// `status` whose every number has all its digits.
pub const LONGEST_LINE: u8 = 192;

/// What the board counts for `status`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counters {
    /// Pulse edges that came late.
    pub late: u16,
    /// Bytes received and lost.
    pub rx_lost: u16,
}

const HELP: [Text; 7] = [
    Text::HelpGaits,
    Text::HelpStop,
    Text::HelpRest,
    Text::HelpSpeed,
    Text::HelpPose,
    Text::HelpStatus,
    Text::HelpWatch,
];

/// The robot as its console sees it.
#[derive(Debug)]
pub struct Console {
    line: Line,
    motion: Motion,
    banner_due: bool,
    answer: Option<Answer>,
    help_line: usize,
    watch_every: u16,
    watch_in: u16,
    watch_due: bool,
    held_due: bool,
}

impl Console {
    /// A robot at power-on, with a banner to say.
    pub fn new() -> Self {
        Self {
            line: Line::new(),
            motion: Motion::new(),
            banner_due: true,
            answer: None,
            help_line: 0,
            watch_every: 0,
            watch_in: 0,
            watch_due: false,
            held_due: false,
        }
    }

    /// The robot's motion.
    pub const fn motion(&self) -> &Motion {
        &self.motion
    }

    /// One frame on: the pulses to send in it. To be called 50 times a second.
    // Out of line, so that a simulator can time it by its name.
    #[inline(never)]
    pub fn frame(&mut self) -> Pulses {
        let was_held = self.motion.hazard().is_some();
        let pulses = self.motion.tick();
        self.held_due |= !was_held && self.motion.hazard().is_some();
        if self.watch_every > 0 {
            self.watch_in = self.watch_in.saturating_sub(1);
            if self.watch_in == 0 {
                self.watch_in = self.watch_every;
                self.watch_due = true;
            }
        }
        pulses
    }

    /// True while there is something to say. No byte is to be heard meanwhile:
    /// the answer may still need the line it answers.
    pub const fn has_news(&self) -> bool {
        self.banner_due || self.answer.is_some() || self.held_due || self.watch_due
    }

    /// Takes a byte from the serial line and acts on it if it ends a line.
    // Out of line, as the next: half a kilobyte of flash.
    #[inline(never)]
    pub fn hear(&mut self, byte: u8) {
        self.answer = match self.line.push(byte) {
            None => return,
            Some(Ended::TooLong) => Some(Answer::Refused(Refusal::TooLong)),
            Some(Ended::Line) => Some(match parse(self.line.text()) {
                Err(misread) => Answer::Refused(Refusal::Misread(misread)),
                Ok(command) => self.obey(command).unwrap_or_else(Answer::Refused),
            }),
        };
    }

    /// Says one line, if there is one to say, at most [`LONGEST_LINE`] bytes.
    #[inline(never)]
    pub fn speak<W>(&mut self, out: &mut W, counters: Counters) -> Result<(), W::Error>
    where
        W: uWrite + ?Sized,
    {
        if self.banner_due {
            self.banner_due = false;
            print_banner(out)
        } else if let Some(answer) = self.answer {
            if answer == Answer::Help && self.help_line < HELP.len() {
                self.help_line += 1;
                print_help(out, self.help_line - 1)
            } else {
                self.answer = None;
                self.help_line = 0;
                self.print_answer(out, answer, counters)
            }
        } else if let Some(hazard) = self.motion.hazard()
            && self.held_due
        {
            self.held_due = false;
            Text::Held.print(out)?;
            answer::print_hazard(hazard, out)?;
            end_line(out)
        } else if self.watch_due {
            self.watch_due = false;
            Text::WatchTime.print(out)?;
            answer::number(out, self.motion.frames(), 0)?;
            Text::WatchPose.print(out)?;
            answer::pose(out, self.motion.pose(), ',')?;
            end_line(out)
        } else {
            Ok(())
        }
    }

    fn obey(&mut self, command: Command) -> Result<Answer, Refusal> {
        let resting = self.motion.activity() == Activity::Rest;
        match command {
            Command::Help => return Ok(Answer::Help),
            Command::Status => return Ok(Answer::Status),
            Command::Speed(percent) => self.motion.set_speed(percent),
            Command::Watch(frames) => {
                (self.watch_every, self.watch_in, self.watch_due) = (frames, frames, false);
            }
            Command::Rest => self.motion.rest(),
            Command::Gait(gait) if gait == GaitId::STAND || !resting => self.motion.gait(gait),
            _ if resting => return Err(Refusal::Resting),
            Command::Gait(gait) => self.motion.gait(gait),
            Command::Stop => self.motion.stop(),
            Command::Pose(pose) => self.motion.pose_to(&pose).map_err(Refusal::Unsafe)?,
        }
        Ok(Answer::Done)
    }

    fn print_answer<W>(
        &self,
        out: &mut W,
        answer: Answer,
        counters: Counters,
    ) -> Result<(), W::Error>
    where
        W: uWrite + ?Sized,
    {
        match answer {
            Answer::Refused(refusal) => {
                Text::Err.print(out)?;
                out.write_char(char::from(b'0' + refusal.code()))?;
                out.write_char(' ')?;
                refusal.print(out)?;
            }
            Answer::Help => Text::OkHelp.print(out)?,
            Answer::Done => {
                Text::Ok.print(out)?;
                answer::ascii(out, self.line.text())?;
            }
            Answer::Status => self.print_status(out, counters)?,
        }
        end_line(out)
    }

    fn print_status<W>(&self, out: &mut W, counters: Counters) -> Result<(), W::Error>
    where
        W: uWrite + ?Sized,
    {
        let motion = &self.motion;
        Text::OkGait.print(out)?;
        match motion.activity() {
            Activity::Gait(gait) => print_key(out, gait)?,
            Activity::Pose => Text::Pose.print(out)?,
            Activity::Stop => Text::Stop.print(out)?,
            Activity::Rest => Text::Rest.print(out)?,
        }
        Text::StatusPhase.print(out)?;
        answer::number(out, thousandths_from_phase(motion.phase()).into(), 3)?;
        Text::WatchPose.print(out)?;
        answer::pose(out, motion.pose(), ',')?;
        Text::StatusMargin.print(out)?;
        let margin = thousandths_from_q15(Clearance::of(motion.pose()).smallest());
        answer::signed(out, margin, 3)?;
        let counts = [
            (Text::StatusSpeed, motion.speed().into()),
            (Text::StatusFrames, motion.frames()),
            (Text::StatusLate, counters.late.into()),
            (Text::StatusRxLost, counters.rx_lost.into()),
        ];
        for (key, count) in &counts {
            key.print(out)?;
            answer::number(out, *count, 0)?;
        }
        Text::StatusGuard.print(out)?;
        match motion.hazard() {
            None => Text::GuardClear,
            Some(_) => Text::GuardHeld,
        }
        .print(out)
    }
}

impl Default for Console {
    fn default() -> Self {
        Self::new()
    }
}

/// `# lizard 0.1.0 tables 1a2b3c4d, send help for the commands`.
fn print_banner<W: uWrite + ?Sized>(out: &mut W) -> Result<(), W::Error> {
    Text::Banner.print(out)?;
    Text::Version.print(out)?;
    Text::BannerTables.print(out)?;
    for digit in 0..8 {
        let nibble = (TABLES_HASH >> (28 - 4 * digit)) as u8 & 0xf;
        let digit = if nibble < 10 {
            b'0' + nibble
        } else {
            b'a' - 10 + nibble
        };
        out.write_char(char::from(digit))?;
    }
    Text::BannerEnd.print(out)?;
    end_line(out)
}

fn print_help<W: uWrite + ?Sized>(out: &mut W, line: usize) -> Result<(), W::Error> {
    let text = HELP.get(line).copied().unwrap_or(Text::HelpStop);
    text.print(out)?;
    if text == Text::HelpGaits {
        for gait in GaitId::all() {
            out.write_char(if gait == GaitId::STAND { ' ' } else { '|' })?;
            answer::ascii(out, gait.load().name.trim_ascii_end())?;
        }
    }
    end_line(out)
}

/// A gait's name as a value without a blank: `arc-left`.
fn print_key<W: uWrite + ?Sized>(out: &mut W, gait: GaitId) -> Result<(), W::Error> {
    let name = gait
        .load()
        .name
        .map(|byte| if byte == b' ' { b'-' } else { byte });
    let length = name.iter().rposition(|byte| *byte != b'-').unwrap_or(0);
    answer::ascii(out, name.get(..=length).unwrap_or_default())
}

fn end_line<W: uWrite + ?Sized>(out: &mut W) -> Result<(), W::Error> {
    out.write_char('\r')?;
    out.write_char('\n')
}
