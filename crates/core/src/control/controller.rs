//! What the robot does, order by order and frame by frame. It knows no text.
//!
//! A console on a serial line, or something else, gives orders to the robot and learns
//! which of them are refused. Fifty times a second the robot computes a frame and watches
//! for faults; in between it does the work of the memory. Nothing here knows of lines or
//! answers.

use lizard_avr::Region;

use crate::control::fault::Fault;
use crate::control::order::{Order, Taken};
use crate::control::refusal::Refusal;
use crate::control::safety::{Health, Notice, Reaction, Safety};
use crate::control::supervisor::{self, BROWN_OUTS, Before, Beginning, Event, Response, State};
use crate::control::supply::Voltage;
use crate::guard::hazard::Hazard;
use crate::memory::copies::{self, Outcome, RESTED};
use crate::memory::record::{Memory, Writing};
use crate::memory::restart::{Cause, Restart, Stance};
use crate::memory::settings::{Boot, Settings};
use crate::motion::{Activity, Motion};
use crate::numbers::gaits::GaitId;
use crate::numbers::pose::{Pose, Pulses};
use crate::numbers::robot::Robot;
use crate::numbers::section::Damage;

use job::Job;

mod adjust;
mod job;

/// Frames without a restart after which a weak supply is one no more, 30 s.
const STEADY: u32 = 1500;

/// The robot.
#[derive(Clone, Debug)]
pub struct Control {
    motion: Motion,
    settings: Settings,
    /// Why there is no robot.
    damage: Option<Damage>,
    /// What was found of them at power-on.
    found: Outcome,
    safety: Safety,
    /// Why the program began.
    cause: Cause,
    /// How many times since power came on.
    restarts: u8,
    /// Whether a weak supply may have been the cause, and nothing else.
    may_be_supply: bool,
    /// Restarts in a row that a weak supply may have made.
    brown_outs: u8,
    /// What an order has the memory do.
    job: Option<Job>,
    /// The pose of a rest on its way into the memory, or out of it.
    rested: Option<Writing>,
    /// Why the guard holds the robot, until that is printed.
    held: Option<Hazard>,
}

impl Default for Control {
    fn default() -> Self {
        Self::new()
    }
}

impl Control {
    /// No robot yet; [`Control::begin`] has to follow.
    pub const fn new() -> Self {
        Self {
            settings: Settings::NONE,
            motion: Motion::unbegun(Robot::NONE),
            damage: None,
            found: Outcome::Latest,
            safety: Safety::new(),
            cause: Cause::Power,
            restarts: 0,
            may_be_supply: false,
            brown_outs: 0,
            job: None,
            rested: None,
            held: None,
        }
    }

    /// Takes the robot at the beginning of `flash`, if it is whole; then takes over what
    /// the memory keeps: settings, and the pose of the last rest; and what is known of the
    /// program before, if there was one. Without a robot there are no pulses, ever.
    #[inline(never)]
    pub fn begin<M: Memory>(&mut self, flash: Region<'static>, memory: &M, restart: &Restart) {
        self.cause = restart.cause;
        self.restarts = restart.count;
        if let Err(damage) = self.motion.take_robot(flash) {
            self.damage = Some(damage);
            self.safety.fail(Fault::Robot);
            return;
        }
        self.may_be_supply = restart.may_be_supply;
        self.found = copies::load(self.motion.robot(), memory, &mut self.settings);
        if self.found != Outcome::Latest {
            self.safety.notify(Notice::Memory);
        }
        self.calibrate();
        let before = match &restart.before {
            None => Before::Nothing,
            Some(stance) if stance.resting => Before::Rested,
            Some(_) => Before::Held,
        };
        let brown_outs = restart.brown_outs.min(BROWN_OUTS - 1);
        self.brown_outs = match restart.may_be_supply {
            true => brown_outs + 1,
            false => restart.brown_outs.min(BROWN_OUTS),
        };
        let (beginning, fault) = supervisor::beginning(restart.cause, self.brown_outs, before);
        if let Some(fault) = fault {
            self.safety.byte_came();
            self.safety.fail(fault);
        }
        let rested = copies::rested(self.motion.robot(), memory);
        let stance = restart.before.as_ref();
        let began = match (beginning, stance) {
            (Beginning::Wake, _) => {
                self.motion.wake(rested.as_ref());
                true
            }
            (Beginning::TakeOver, Some(stance)) => self.motion.resume(stance, true),
            (Beginning::Hold, Some(stance)) => self.motion.resume(stance, false),
            _ => false,
        };
        if began {
            self.rested = Some(RESTED.forget());
            return;
        }
        // A program that hung before its first frame has moved nothing since the rest.
        let at_rest = rested.map(|pose| Stance {
            pose,
            ..Stance::RESTING
        });
        self.motion.resume_rest(stance.or(at_rest.as_ref()));
        // The pose may not have reached the memory yet.
        let kept = before == Before::Nothing || rested.as_ref() == Some(self.motion.pose());
        self.rested = (!kept).then(|| RESTED.write());
    }

    /// The robot's motion.
    pub const fn motion(&self) -> &Motion {
        &self.motion
    }

    /// What is set.
    pub const fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Why there is no robot, where there is none.
    pub const fn damage(&self) -> Option<Damage> {
        self.damage
    }

    /// What was found of the settings at power-on.
    pub const fn found(&self) -> Outcome {
        self.found
    }

    /// What may go wrong, and has.
    pub const fn safety(&self) -> &Safety {
        &self.safety
    }

    /// Why the program began.
    pub const fn cause(&self) -> Cause {
        self.cause
    }

    /// How many times it has begun since power came on, less one; stays at 255.
    pub const fn restarts(&self) -> u8 {
        self.restarts
    }

    /// The guard's fault, or another one.
    pub fn fault(&self) -> Option<Fault> {
        match self.motion.hazard() {
            Some(_) => Some(Fault::Guard),
            None => self.safety.fault(),
        }
    }

    /// Restarts in a row that a weak supply may have made.
    pub const fn brown_outs(&self) -> u8 {
        self.brown_outs
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
        if self.motion.frames() == STEADY {
            self.brown_outs = 0;
        }
        self.safety.beat(hazard.is_some());
        pulses
    }

    /// Whether the LED is lit in this frame.
    pub const fn is_lit(&self) -> bool {
        self.safety.is_lit()
    }

    /// A byte has come, so a computer is connected.
    pub fn byte_came(&mut self) {
        self.safety.byte_came();
    }

    /// A line has come.
    pub fn line_came(&mut self) {
        self.safety.line_came();
        // Who opens the port resets the board. A brown-out sends no line.
        if self.may_be_supply && self.cause == Cause::External {
            self.may_be_supply = false;
            self.brown_outs = self.brown_outs.saturating_sub(1);
        }
    }

    /// Why the guard holds the robot, once.
    pub fn take_held(&mut self) -> Option<Hazard> {
        self.held.take()
    }

    /// Whether the guard holds the robot and that has not been printed yet.
    pub const fn was_held(&self) -> bool {
        self.held.is_some()
    }

    /// What is to be said unasked has been written.
    pub fn written(&mut self, notice: Notice) {
        self.safety.written(notice);
    }

    /// The supply that is the reason to refuse something.
    #[inline(never)]
    pub fn voltage(&self) -> Voltage {
        self.safety.supply().worst(&self.motion.robot().supplies())
    }

    /// What the robot does, as the supervisor's table has it.
    fn state(&self) -> State {
        match self.motion.activity() {
            Activity::Rest => State::Resting,
            Activity::Gait(id) if id != GaitId::STAND => State::Walking,
            _ => State::Still,
        }
    }

    /// Watches what may go wrong, and does what that asks for.
    fn look_after(&mut self, health: &Health) {
        // Without a robot there is nothing to stop, and no voltage that would be too low.
        if self.motion.robot().is_none() {
            return;
        }
        let state = self.state();
        let supplies = self.motion.robot().supplies();
        let deadman = self.settings.deadman();
        match self.safety.frame(health, &supplies, state, deadman) {
            Reaction::None => {}
            Reaction::Freeze => self.motion.stop(),
            Reaction::EndPulses => self.motion.rest(),
            Reaction::Boot => self.boot(state),
        }
        self.motion.set_slow(self.safety.is_slow());
    }

    /// Does what `boot` says, unless the robot does so already.
    fn boot(&mut self, state: State) {
        let boot = self.settings.boot(self.motion.robot());
        let rests = state == State::Resting;
        match boot {
            Boot::Gait(GaitId::STAND) if !rests => return,
            Boot::Rest if rests => return,
            Boot::Gait(gait) => {
                self.motion.start_gait(gait);
                self.rested = Some(RESTED.forget());
            }
            Boot::Rest => self.rest(),
        }
        self.safety.notify(Notice::Boot);
    }

    /// Takes an order.
    ///
    /// # Errors
    /// Why it is refused; then nothing has changed.
    #[inline(never)]
    pub fn execute(&mut self, order: &Order) -> Result<Taken, Refusal> {
        if self.motion.robot().is_none() {
            return Err(Refusal::NoRobot);
        }
        match order {
            Order::Gait(gait) => {
                self.may(match *gait {
                    GaitId::STAND => Event::Stand,
                    _ => Event::Move,
                })?;
                self.motion.start_gait(*gait);
                self.moves();
            }
            Order::Pose(angles) => {
                let pose = Pose::at(angles, &self.motion.robot().neutral());
                self.go_to(&pose)?;
            }
            Order::Center => {
                let mut pose = self.settings.pose();
                for sweep in &mut pose.0 {
                    sweep.0 = -sweep.0;
                }
                self.go_to(&pose)?;
            }
            Order::Stop => {
                self.may(Event::Stop)?;
                self.motion.stop();
            }
            Order::Rest => {
                if self.may(Event::Rest)? {
                    self.rest();
                }
            }
            Order::Speed(percent) => self.motion.set_speed(*percent),
            Order::Set(servo, setting) => self.set_servo(*servo, *setting)?,
            Order::Boot(boot) => self.settings.set_boot(*boot, self.motion.robot()),
            Order::Deadman(ms) => self.settings.set_deadman(*ms),
            Order::Factory => {
                let factory = Settings::of(self.motion.robot());
                self.replace(&factory)?;
            }
            Order::Save => {
                self.may(Event::Save)?;
                self.job = Some(Job::Save);
                return Ok(Taken::Later);
            }
            Order::Load => {
                self.job = Some(Job::Load);
                return Ok(Taken::Later);
            }
        }
        Ok(Taken::Done)
    }

    /// Whether a command leaves anything to do.
    ///
    /// # Errors
    /// Why it is refused.
    #[inline(never)]
    fn may(&self, event: Event) -> Result<bool, Refusal> {
        match self.safety.response(event, self.state()) {
            Response::RefuseResting => Err(Refusal::Resting),
            Response::RefuseSupply => Err(Refusal::Supply),
            response => Ok(response == Response::Obey),
        }
    }

    fn go_to(&mut self, pose: &Pose) -> Result<(), Refusal> {
        if let Some(servo) = pose.beyond(self.motion.calibration()) {
            return Err(Refusal::Unsafe(Hazard::Travel(servo)));
        }
        self.may(Event::Move)?;
        self.motion.go_to(pose).map_err(Refusal::Unsafe)?;
        self.moves();
        Ok(())
    }

    /// A motion begins by a command: faults are over, and the pose of the last
    /// rest is, too.
    fn moves(&mut self) {
        self.safety.clear();
        self.brown_outs = 0;
        self.rested = Some(RESTED.forget());
    }

    /// Ends the pulses; the pose is kept for the next power-on.
    fn rest(&mut self) {
        self.motion.rest();
        self.rested = Some(RESTED.write());
    }
}
