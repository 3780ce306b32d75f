//! The console: one line in, one answer out.
//!
//! The caller passes bytes on while the console has nothing to write, and lets it
//! write a line while the serial line has room for a whole one. So nothing waits:
//! a long list comes line by line between the frames, and a frame is never
//! late because of a listener who is slow.

use ufmt::uWrite;

use crate::answer::{self, Answer, Refusal};
use crate::command::{Command, parse};
use crate::gait::GaitId;
use crate::guard::Clearance;
use crate::hazard::Hazard;
use crate::line::{Ended, Line};
use crate::motion::{Activity, Motion};
use crate::pose::{Pose, Pulses};
use crate::robot::Robot;
use crate::text::Text;
use crate::units::thousandths_from_phase;

/// The longest line that [`Console::write_line`] writes, with its line end: a
/// `status` whose every number has all its digits.
pub const LONGEST_LINE: u8 = 192;

/// What the board counts for `status`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Pulse edges that came late.
    pub late: u16,
    /// Bytes received and lost.
    pub rx_lost: u16,
}

/// The list of commands, a line each, after the gaits.
const HELP: [Text; 6] = [
    Text::HelpStop,
    Text::HelpRest,
    Text::HelpSpeed,
    Text::HelpPose,
    Text::HelpStatus,
    Text::HelpWatch,
];

/// A line that waits to be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Output {
    /// What robot this is, once after power-on.
    Banner,
    /// The answer to the last line received, or a part of it.
    Answer(Answer),
    /// Why the guard holds the robot.
    Held(Hazard),
    /// The pose, as `watch` asked for it.
    Report,
}

/// Pose reports, as `watch` asked for them.
#[derive(Clone, Copy, Debug, Default)]
struct Watch {
    /// Frames from one report to the next; 0 for none.
    every: u16,
    /// Frames until the next one.
    left: u16,
    /// Whether one waits to be written.
    due: bool,
}

/// The robot as its console sees it.
#[derive(Debug)]
pub struct Console<R> {
    line: Line,
    motion: Motion<R>,
    banner: bool,
    answer: Option<Answer>,
    held: Option<Hazard>,
    watch: Watch,
}

impl<R: Robot> Console<R> {
    /// A robot at power-on, its banner not yet written.
    pub fn new(robot: R) -> Self {
        Self {
            line: Line::new(),
            motion: Motion::new(robot),
            banner: true,
            answer: None,
            held: None,
            watch: Watch::default(),
        }
    }

    /// The robot's motion.
    pub const fn motion(&self) -> &Motion<R> {
        &self.motion
    }

    /// One frame on: the pulses to send in it. To be called 50 times a second.
    // Out of line, so that a simulator can time it by its name.
    #[inline(never)]
    pub fn frame(&mut self) -> Pulses {
        let was_held = self.motion.hazard().is_some();
        let pulses = self.motion.tick();
        if !was_held && let Some(hazard) = self.motion.hazard() {
            self.held = Some(hazard);
        }
        self.watch.frame();
        pulses
    }

    /// True while a line waits to be written. No byte is to be passed on
    /// meanwhile: the answer may still need the line it answers.
    pub const fn has_output(&self) -> bool {
        self.next_output().is_some()
    }

    /// Takes a byte from the serial line and executes the line that it ends.
    // Out of line, as the next: half a kilobyte of flash.
    #[inline(never)]
    pub fn receive(&mut self, byte: u8) {
        self.answer = match self.line.push(byte) {
            None => return,
            Some(Ended::TooLong) => Some(Answer::Refused(Refusal::TooLong)),
            Some(Ended::Line) => Some(match parse(self.line.text(), self.motion.robot()) {
                Err(misread) => Answer::Refused(Refusal::Misread(misread)),
                Ok(command) => self.execute(command).unwrap_or_else(Answer::Refused),
            }),
        };
    }

    /// Writes one line, if one waits, at most [`LONGEST_LINE`] bytes.
    ///
    /// # Errors
    /// Those of `out`.
    #[inline(never)]
    pub fn write_line<W>(&mut self, out: &mut W, counters: Counters) -> Result<(), W::Error>
    where
        W: uWrite + ?Sized,
    {
        match self.next_output() {
            None => return Ok(()),
            Some(Output::Banner) => {
                self.banner = false;
                print_banner(out, self.motion.robot().hash())?;
            }
            Some(Output::Answer(answer)) => {
                self.answer = self.print_answer(out, answer, counters)?;
            }
            Some(Output::Held(hazard)) => {
                self.held = None;
                Text::Held.print(out)?;
                answer::print_hazard(hazard, self.motion.robot(), out)?;
            }
            Some(Output::Report) => {
                self.watch.due = false;
                Text::WatchTime.print(out)?;
                answer::number(out, self.motion.frames(), 0)?;
                self.print_pose(out)?;
            }
        }
        out.write_char('\r')?;
        out.write_char('\n')
    }

    /// What is to be written next: the one order of everything that may wait.
    const fn next_output(&self) -> Option<Output> {
        if self.banner {
            Some(Output::Banner)
        } else if let Some(answer) = self.answer {
            Some(Output::Answer(answer))
        } else if let Some(hazard) = self.held {
            Some(Output::Held(hazard))
        } else if self.watch.due {
            Some(Output::Report)
        } else {
            None
        }
    }

    fn execute(&mut self, command: Command) -> Result<Answer, Refusal> {
        let resting = self.motion.activity() == Activity::Rest;
        match command {
            Command::Help => return Ok(Answer::Gaits(GaitId::STAND)),
            Command::Status => return Ok(Answer::Status),
            Command::Speed(percent) => self.motion.set_speed(percent),
            Command::Watch(frames) => self.watch = Watch::every(frames),
            Command::Rest => self.motion.rest(),
            Command::Gait(gait) => {
                if resting && gait != GaitId::STAND {
                    return Err(Refusal::Resting);
                }
                self.motion.start_gait(gait);
            }
            Command::Pose(angles) => {
                let motion = &self.motion;
                let pose = Pose::at(&angles, &motion.robot().neutral(), motion.calibration())
                    .map_err(Refusal::Travel)?;
                if resting {
                    return Err(Refusal::Resting);
                }
                self.motion.go_to(&pose).map_err(Refusal::Unsafe)?;
            }
            Command::Stop => {
                if resting {
                    return Err(Refusal::Resting);
                }
                self.motion.stop();
            }
        }
        Ok(Answer::Done)
    }

    /// Prints a line of an answer; returns what is left of it.
    fn print_answer<W>(
        &self,
        out: &mut W,
        answer: Answer,
        counters: Counters,
    ) -> Result<Option<Answer>, W::Error>
    where
        W: uWrite + ?Sized,
    {
        match answer {
            Answer::Refused(refusal) => {
                Text::Err.print(out)?;
                out.write_char(char::from(b'0' + refusal.code()))?;
                out.write_char(' ')?;
                refusal.print(&self.motion, out)?;
            }
            Answer::Gaits(first) => {
                let rest = self.print_gaits(out, first)?;
                return Ok(Some(rest.map_or(Answer::Help(0), Answer::Gaits)));
            }
            Answer::Help(line) => match HELP.get(usize::from(line)) {
                Some(text) => {
                    text.print(out)?;
                    return Ok(Some(Answer::Help(line + 1)));
                }
                None => Text::OkHelp.print(out)?,
            },
            Answer::Done => {
                Text::Ok.print(out)?;
                answer::ascii(out, self.line.text().iter().copied())?;
            }
            Answer::Status => self.print_status(out, counters)?,
        }
        Ok(None)
    }

    /// `# gaits: stand|walk|...`, as many as a line takes; returns the first that
    /// it has no room for.
    fn print_gaits<W>(&self, out: &mut W, first: GaitId) -> Result<Option<GaitId>, W::Error>
    where
        W: uWrite + ?Sized,
    {
        /// Without the line end.
        const ROOM: u8 = LONGEST_LINE - 2;
        let robot = self.motion.robot();
        Text::HelpGaits.print(out)?;
        let mut length = Text::HelpGaits.length();
        let mut gait = first;
        loop {
            let name = robot.name(gait);
            length += 1 + name.length();
            if length > ROOM {
                return Ok(Some(gait));
            }
            out.write_char(if gait == first { ' ' } else { '|' })?;
            answer::ascii(out, name)?;
            match gait.next(robot.gaits().len()) {
                Some(next) => gait = next,
                None => return Ok(None),
            }
        }
    }

    fn print_status<W>(&self, out: &mut W, counters: Counters) -> Result<(), W::Error>
    where
        W: uWrite + ?Sized,
    {
        let motion = &self.motion;
        Text::OkGait.print(out)?;
        match motion.activity() {
            Activity::Gait(gait) => self.print_key(out, gait)?,
            Activity::Pose => Text::Pose.print(out)?,
            Activity::Stop => Text::Stop.print(out)?,
            Activity::Rest => Text::Rest.print(out)?,
        }
        Text::StatusPhase.print(out)?;
        answer::number(out, thousandths_from_phase(motion.phase()).into(), 3)?;
        self.print_pose(out)?;
        Text::StatusMargin.print(out)?;
        answer::sine(out, Clearance::of(motion.robot(), motion.pose()).smallest())?;
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

    fn print_pose<W: uWrite + ?Sized>(&self, out: &mut W) -> Result<(), W::Error> {
        Text::WatchPose.print(out)?;
        let motion = &self.motion;
        answer::angles(out, &motion.pose().angles(&motion.robot().neutral()))
    }

    /// A gait's name as a value without a blank: `arc-left`.
    fn print_key<W: uWrite + ?Sized>(&self, out: &mut W, gait: GaitId) -> Result<(), W::Error> {
        let name = self.motion.robot().name(gait);
        answer::ascii(out, name.map(|byte| if byte == b' ' { b'-' } else { byte }))
    }
}

impl Watch {
    /// Reports every so many frames, the first after as many.
    const fn every(frames: u16) -> Self {
        Self {
            every: frames,
            left: frames,
            due: false,
        }
    }

    fn frame(&mut self) {
        if self.every > 0 {
            self.left = self.left.saturating_sub(1);
            if self.left == 0 {
                self.left = self.every;
                self.due = true;
            }
        }
    }
}

/// `# lizard 0.1.0 tables 1a2b3c4d, send help for the commands`.
fn print_banner<W: uWrite + ?Sized>(out: &mut W, hash: u32) -> Result<(), W::Error> {
    Text::Banner.print(out)?;
    Text::Version.print(out)?;
    Text::BannerTables.print(out)?;
    for digit in 0..8 {
        let nibble = (hash >> (28 - 4 * digit)) as u8 & 0xf;
        let digit = if nibble < 10 {
            b'0' + nibble
        } else {
            b'a' - 10 + nibble
        };
        out.write_char(char::from(digit))?;
    }
    Text::BannerEnd.print(out)
}

#[cfg(test)]
mod tests;
