//! The console: one line in, one answer out.
//!
//! The caller passes bytes on while the console has nothing to write, and lets it
//! write a line while the serial line has room for a whole one. So nothing waits:
//! a long list comes line by line between the frames, and a frame is never
//! late because of a listener who is slow.

use ufmt::uWrite;

use crate::answer::Answer;
use crate::command::Command;
use crate::digits;
use crate::fault::Fault;
use crate::gait::GaitId;
use crate::hazard::Hazard;
use crate::line::{self, Line};
use crate::memory::Memory;
use crate::motion::{Activity, Motion};
use crate::pose::{Pose, Pulses};
use crate::record::{self, Outcome, RESTED};
use crate::refusal::{self, Refusal};
use crate::restart::{Cause, Restart};
use crate::robot::Robot;
use crate::safety::{Health, Notice, Order, Safety};
use crate::settings::{Boot, Settings};
use crate::supply::Voltage;
use crate::text::Text;
use crate::word::Word;

use job::Job;
use watch::Watch;

mod adjust;
mod job;
mod print;
mod watch;

/// The longest line that [`Console::write_line`] writes, with its line end: a
/// `status` whose every number has all its digits.
pub const LONGEST_LINE: u8 = 250;

/// A line that waits to be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Output {
    /// What robot this is, once after power-on.
    Banner,
    /// The answer to the last line received, or a part of it.
    Answer(Answer),
    /// Something that nobody asked for.
    Notice(Notice),
    /// Why the guard holds the robot.
    Held,
    /// The pose, as `watch` asked for it.
    Report,
}

/// What the board counts for `status`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Pulse edges that came late.
    pub late: u16,
    /// Bytes received and lost.
    pub rx_lost: u16,
}

/// Something is not done; the answer says why.
struct Refused;

/// The robot as its console sees it.
#[derive(Clone, Debug)]
pub struct Console<R> {
    line: Line,
    motion: Motion<R>,
    settings: Settings,
    /// What was found of them at power-on.
    found: Outcome,
    safety: Safety,
    cause: Cause,
    restarts: u8,
    job: Option<Job>,
    banner: bool,
    answer: Option<Answer>,
    held: Option<Hazard>,
    watch: Watch,
}

impl<R: Robot> Console<R> {
    /// A robot at power-on, its banner not yet written; [`Console::begin`] has to
    /// follow.
    pub const fn new(robot: R) -> Self {
        Self {
            line: Line::new(),
            settings: Settings::NONE,
            motion: Motion::unbegun(robot),
            found: Outcome::Latest,
            safety: Safety::new(),
            cause: Cause::Power,
            restarts: 0,
            job: Some(Job::Pose(RESTED.forget())),
            banner: true,
            answer: None,
            held: None,
            watch: Watch::every(0),
        }
    }

    /// Takes over what the memory keeps: settings, and the pose of the last rest; and
    /// what is known of the program before, if there was one.
    #[inline(never)]
    pub fn begin<M: Memory>(&mut self, memory: &M, restart: &Restart) {
        self.cause = restart.cause;
        self.restarts = restart.count;
        self.motion.begin();
        self.found = record::load(self.motion.robot(), memory, &mut self.settings);
        if self.found != Outcome::Latest {
            self.safety.notify(Notice::Memory);
        }
        self.calibrate();
        let hung = restart.cause == Cause::Watchdog;
        if hung {
            self.safety.byte_came();
            self.safety.fail(Fault::Watchdog);
        }
        let rested = record::rested(self.motion.robot(), memory);
        if let Some(pose) = restart.pose.or(rested) {
            self.motion.begin_at(&pose, !hung);
        }
    }

    /// The robot's motion.
    pub const fn motion(&self) -> &Motion<R> {
        &self.motion
    }

    /// One frame on: the pulses to send in it. To be called 50 times a second.
    // Out of line, so that a simulator can time it by its name.
    #[inline(never)]
    pub fn frame(&mut self, health: &Health) -> Pulses {
        self.look_after(health);
        let was_held = self.motion.hazard().is_some();
        let pulses = self.motion.tick();
        let hazard = self.motion.hazard();
        if !was_held && let Some(hazard) = hazard {
            self.held = Some(hazard);
        }
        self.safety.beat(hazard.is_some());
        self.watch.frame();
        pulses
    }

    /// Whether the LED is lit in this frame.
    pub const fn is_lit(&self) -> bool {
        self.safety.is_lit()
    }

    /// True while there is something to do with the memory. No byte is to be
    /// passed on meanwhile.
    pub const fn is_writing(&self) -> bool {
        self.job.is_some()
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
        self.safety.byte_came();
        let Some(ended) = self.line.push(byte) else {
            return;
        };
        self.safety.line_came();
        self.answer = Some(Answer::Done);
        if ended == line::Ended::TooLong {
            self.answer = Some(Answer::Refused(Refusal::TooLong));
            return;
        }
        let mut command = Command::NONE;
        // Either way, what is to be said is in the answer.
        _ = match command.read(self.line.text(), self.motion.robot()) {
            Ok(()) => self.execute(&command),
            Err(misread) => self.refuse(Refusal::Misread(misread)),
        };
    }

    /// Writes one line, if one waits, at most [`LONGEST_LINE`] bytes: what robot this
    /// is, once after power-on; an answer or a part of it; what nobody asked for; why
    /// the guard holds the robot; the pose, as `watch` asked for it. Of the longest
    /// line it writes one part, and the next call the other.
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
                print::print_banner(out, self.motion.robot().hash())?;
            }
            Some(Output::Answer(answer)) => {
                self.answer = self.print_answer(out, answer, counters)?;
                if answer == Answer::Status {
                    return Ok(());
                }
            }
            Some(Output::Notice(notice)) => {
                self.safety.written(notice);
                self.print_notice(out, notice)?;
            }
            Some(Output::Held) => {
                if let Some(hazard) = self.held.take() {
                    Text::Held.print(out)?;
                    refusal::print_hazard(hazard, self.motion.robot(), out)?;
                }
            }
            Some(Output::Report) => {
                self.watch.due = false;
                Text::WatchTime.print(out)?;
                digits::number(out, self.motion.frames(), 0)?;
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
        } else if let Some(notice) = self.safety.notice() {
            Some(Output::Notice(notice))
        } else if self.held.is_some() {
            Some(Output::Held)
        } else if self.watch.due {
            Some(Output::Report)
        } else {
            None
        }
    }

    /// Watches what may go wrong, and does what that asks for.
    fn look_after(&mut self, health: &Health) {
        let motion = &self.motion;
        let walks = matches!(motion.activity(), Activity::Gait(id) if id != GaitId::STAND);
        let supplies = motion.robot().supplies();
        match self
            .safety
            .frame(health, &supplies, walks, self.settings.deadman())
        {
            Order::None => {}
            Order::Stop => self.motion.stop(),
            Order::Rest => self.motion.rest(),
            Order::Boot => match self.settings.boot(motion.robot()) {
                // It stands already.
                Boot::Gait(GaitId::STAND) => {}
                Boot::Gait(gait) => {
                    self.safety.notify(Notice::Boot);
                    self.motion.start_gait(gait);
                }
                Boot::Rest => {
                    self.safety.notify(Notice::Boot);
                    self.rest();
                }
            },
        }
        self.motion.set_slow(!self.safety.allows_writing());
    }

    /// Executes a command. The answer is that it is done, if this sets no other; none
    /// comes as long as there is something to do with the memory.
    #[inline(never)]
    fn execute(&mut self, command: &Command) -> Result<(), Refused> {
        let [number, ..] = command.numbers;
        let Some(word) = command.word else {
            let gait = command.gait.unwrap_or(GaitId::STAND);
            self.may_move(gait == GaitId::STAND)?;
            self.motion.start_gait(gait);
            self.moves();
            return Ok(());
        };
        match word {
            Word::Help | Word::QuestionMark => self.answer = Some(Answer::Gaits(GaitId::STAND)),
            Word::Status => self.answer = Some(Answer::Status),
            Word::Cal => self.answer = Some(Answer::Settings(0)),
            Word::Speed => self.motion.set_speed(number as u8),
            Word::Watch => self.watch = Watch::every(number),
            Word::Rest => self.rest(),
            Word::Pose => {
                let pose = Pose::at(&command.numbers, self.motion.robot());
                self.go_to(&pose)?;
            }
            Word::Center => {
                let mut pose = self.settings.pose();
                for sweep in &mut pose.0 {
                    sweep.0 = -sweep.0;
                }
                self.go_to(&pose)?;
            }
            Word::Stop => {
                if self.motion.activity() == Activity::Rest {
                    return self.refuse(Refusal::Resting);
                }
                self.motion.stop();
            }
            Word::Trim | Word::Limit | Word::Dir | Word::Scale => self.set_servo(word, command)?,
            Word::Factory => self.replace(&Settings::of(self.motion.robot()))?,
            Word::Boot => {
                let boot = command.gait.map_or(Boot::Rest, Boot::Gait);
                self.settings.set_boot(boot, self.motion.robot());
            }
            Word::Deadman => self.settings.set_deadman(number),
            Word::Load => self.begin_job(Job::Load),
            Word::Save => {
                if !self.safety.allows_writing() {
                    return self.refuse(Refusal::Supply);
                }
                self.begin_job(Job::Save);
            }
        }
        Ok(())
    }

    /// Refuses a motion for want of a supply, or because the servos rest and this
    /// command does not `wake` them.
    #[inline(never)]
    fn may_move(&mut self, wakes: bool) -> Result<(), Refused> {
        if !wakes && self.motion.activity() == Activity::Rest {
            self.refuse(Refusal::Resting)
        } else if !self.safety.allows_motion() {
            self.refuse(Refusal::Supply)
        } else {
            Ok(())
        }
    }

    fn go_to(&mut self, pose: &Pose) -> Result<(), Refused> {
        if let Some(servo) = pose.beyond(self.motion.calibration()) {
            return self.refuse(Refusal::Travel(servo));
        }
        self.may_move(false)?;
        if let Err(hazard) = self.motion.go_to(pose) {
            return self.refuse(Refusal::Unsafe(hazard));
        }
        self.moves();
        Ok(())
    }

    /// Answers why something is not done.
    #[inline(never)]
    fn refuse(&mut self, why: Refusal) -> Result<(), Refused> {
        self.answer = Some(Answer::Refused(why));
        Err(Refused)
    }

    /// A motion begins: faults are over, and the pose of the last rest is, too.
    fn moves(&mut self) {
        self.safety.clear();
        self.job = Some(Job::Pose(RESTED.forget()));
    }

    /// Ends the pulses; the pose is kept for the next power-on.
    fn rest(&mut self) {
        self.motion.rest();
        if self.safety.allows_writing() {
            self.job = Some(Job::Pose(RESTED.write()));
        }
    }

    /// The supply that is the reason to refuse something.
    #[inline(never)]
    fn voltage(&self) -> Voltage {
        self.safety.supply().worst(&self.motion.robot().supplies())
    }
}

#[cfg(test)]
mod tests;
