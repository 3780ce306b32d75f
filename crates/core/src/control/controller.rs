//! The robot as a whole: it carries out orders, computes frames, and reacts to faults.
//!
//! A console on a serial line, or another source, gives orders to the robot and learns
//! which of them are refused. Fifty times a second the robot computes a frame and watches
//! for faults; in between it reads and writes its EEPROM. Nothing here depends on the text of commands or answers.

use lizard_avr::Region;

use crate::control::contact::Contact;
use crate::control::fault::Fault;
use crate::control::order::{Acceptance, Order};
use crate::control::refusal::Refusal;
use crate::control::safety::{Health, Notice, Reaction, Safety};
use crate::control::supervisor::{
    self, BROWN_OUTS_TO_REST, Event, FirstAction, Response, ServosBefore, State,
};
use crate::control::supply::Voltage;
use crate::guard::hazard::Hazard;
use crate::memory::copies::{self, REST_POSE_ADDRESS, SavedState};
use crate::memory::record::{Memory, RecordWrite};
use crate::memory::restart::{Cause, Restart, Stance};
use crate::memory::settings::{Boot, Settings};
use crate::motion::{Activity, Motion};
use crate::numbers::gaits::GaitId;
use crate::numbers::pose::{Pose, Pulses};
use crate::numbers::robot::Robot;
use crate::numbers::section::SectionError;

use job::Job;
use routine::Routine;

mod adjust;
mod job;
mod report;
mod routine;

/// Frames without a reset after which the supply counts as good again: 30 s.
const GOOD_SUPPLY_FRAMES: u32 = 1500;

/// Frames after the program starts within which all servos wake: 0.6 s.
const WAKING_FRAMES: u32 = 30;

/// The controller of the robot: its motion, settings, safety, and the EEPROM operation in progress.
#[derive(Clone, Debug)]
pub struct Controller {
    motion: Motion,
    settings: Settings,
    /// The reason why the flash holds no usable robot.
    damage: Option<SectionError>,
    /// The state of the saved settings at power-on.
    saved_state: SavedState,
    safety: Safety,
    /// The cause of the last reset.
    reset_cause: Cause,
    /// Resets since power-on, at most 255.
    reset_count: u8,
    /// True if a weak supply may have caused the last reset. Becomes false once a command shows that a computer opened
    /// the port.
    is_supply_suspected: bool,
    /// Consecutive resets, including the last one, that a weak supply may have caused.
    brown_outs: u8,
    /// True if a command has been received since the program started.
    has_heard_command: bool,
    routine: Routine,
    /// The contact that may end the current step of a routine.
    contact: Contact,
    /// True if `boot` started the current activity, and no command has been received since.
    is_unattended: bool,
    /// The EEPROM operation that an order has started.
    job: Option<Job>,
    /// The write or invalidation of the rest pose's record, if one is in progress.
    rest_pose_write: Option<RecordWrite>,
    /// The reason why the guard holds the robot, until it is printed.
    hold_reason: Option<Hazard>,
}

impl Default for Controller {
    fn default() -> Self {
        Self::new()
    }
}

impl Controller {
    /// Returns a controller without a robot; [`Controller::begin`] must follow.
    pub const fn new() -> Self {
        Self {
            settings: Settings::NONE,
            motion: Motion::unstarted(Robot::NONE),
            damage: None,
            saved_state: SavedState::Latest,
            safety: Safety::new(),
            reset_cause: Cause::Power,
            reset_count: 0,
            is_supply_suspected: false,
            brown_outs: 0,
            has_heard_command: false,
            routine: Routine::NONE,
            contact: Contact::NONE,
            is_unattended: false,
            job: None,
            rest_pose_write: None,
            hold_reason: None,
        }
    }

    /// Loads the robot's section from `flash`, then restores the settings and the rest pose from the EEPROM, and the
    /// servos' state from before the reset. If the section is not valid, there is no robot, and the controller never
    /// sends pulses.
    #[inline(never)]
    pub fn begin<M: Memory>(&mut self, flash: Region<'static>, memory: &M, restart: &Restart) {
        self.reset_cause = restart.cause;
        self.reset_count = restart.reset_count;
        if let Err(damage) = self.motion.load_robot(flash) {
            self.damage = Some(damage);
            self.safety.record_fault(Fault::Robot);
            return;
        }
        self.is_supply_suspected = restart.is_supply_suspected;
        self.saved_state = copies::load(self.motion.robot(), memory, &mut self.settings);
        if self.saved_state != SavedState::Latest {
            self.safety.notify(Notice::SavedSettings);
        }
        self.apply_calibration();
        let servos_before = match &restart.stance_before {
            None => ServosBefore::Unknown,
            Some(stance) if stance.is_resting => ServosBefore::Rested,
            Some(_) => ServosBefore::Held,
        };
        let brown_outs = restart.brown_outs.min(BROWN_OUTS_TO_REST - 1);
        self.brown_outs = match restart.is_supply_suspected {
            true => brown_outs + 1,
            false => restart.brown_outs.min(BROWN_OUTS_TO_REST),
        };
        let (first_action, fault) =
            supervisor::first_action(restart.cause, self.brown_outs, servos_before);
        if let Some(fault) = fault {
            self.safety.note_byte();
            self.safety.record_fault(fault);
        }
        let rest_pose = copies::last_rest_pose(self.motion.robot(), memory);
        let stance = restart.stance_before.as_ref();
        let is_awake = match (first_action, stance) {
            (FirstAction::Wake, _) => {
                self.motion.wake(rest_pose.as_ref());
                true
            }
            (FirstAction::WakeInPlace, Some(stance)) => self.motion.resume(stance, true),
            (FirstAction::Hold, Some(stance)) => self.motion.resume(stance, false),
            _ => false,
        };
        if is_awake {
            self.rest_pose_write = Some(REST_POSE_ADDRESS.start_invalidation());
            return;
        }
        // A program that was reset before its first frame has not moved the robot since its last rest.
        let rest_stance = rest_pose.map(|pose| Stance {
            pose,
            ..Stance::RESTING
        });
        self.motion.resume_rest(stance.or(rest_stance.as_ref()));
        // The reset may have interrupted the write of the pose to the EEPROM.
        let is_saved = servos_before == ServosBefore::Unknown
            || rest_pose.as_ref() == Some(self.motion.pose());
        self.rest_pose_write = (!is_saved).then(|| REST_POSE_ADDRESS.start_write());
    }

    /// Computes the pulses of the next frame. Must be called 50 times a second.
    // Out of line, so that a simulator can time it by its name.
    #[inline(never)]
    pub fn compute_frame(&mut self, health: &Health) -> Pulses {
        self.check_health(health);
        let was_held = self.motion.hazard().is_some();
        let pulses = self.motion.tick();
        let hazard = self.motion.hazard();
        if !was_held && let Some(hazard) = hazard {
            self.hold_reason = Some(hazard);
        }
        if self.routine.is_under_way() {
            self.advance_routine(health.is_contact_closed);
        } else if self.motion.has_come_to_standstill() {
            self.safety.notify(Notice::Done);
        }
        let frames = self.motion.frame_count();
        if frames == GOOD_SUPPLY_FRAMES {
            self.brown_outs = 0;
        }
        // A computer that opens the port resets the board and then sends a line. By radio, lines arrive at any time, so
        // a line while the servos wake is no evidence against a weak supply.
        let may_be_port_reset = self.is_supply_suspected && self.reset_cause == Cause::External;
        if may_be_port_reset && self.has_heard_command && frames > WAKING_FRAMES {
            self.is_supply_suspected = false;
            self.brown_outs = self.brown_outs.saturating_sub(1);
        }
        self.safety.advance_led(hazard.is_some());
        pulses
    }

    /// True while the LED is lit.
    pub const fn is_lit(&self) -> bool {
        self.safety.is_lit()
    }

    /// The time without a command after which a gait ends, ms; 0 for never.
    pub fn deadman_ms(&self) -> u16 {
        self.settings.deadman_ms()
    }

    /// Notes that a byte was received, which means that a computer is connected.
    pub fn note_byte(&mut self) {
        self.safety.note_byte();
    }

    /// Notes that a command was received.
    pub fn note_command(&mut self) {
        self.safety.note_command();
        self.is_unattended = false;
        self.has_heard_command = true;
    }

    /// Takes the reason why the guard holds the robot. Returns `None` if there is none, or if it was taken before.
    pub fn take_hold_reason(&mut self) -> Option<Hazard> {
        self.hold_reason.take()
    }

    /// True while the reason why the guard holds the robot waits to be printed.
    pub const fn has_hold_reason(&self) -> bool {
        self.hold_reason.is_some()
    }

    /// Notes that a notice has been printed.
    pub fn note_printed(&mut self, notice: Notice) {
        self.safety.note_printed(notice);
    }

    /// The voltage of the chip's supply or of the servos' rail, whichever restricts the robot more.
    #[inline(never)]
    pub fn voltage(&self) -> Voltage {
        self.safety
            .supply()
            .worst_voltage(&self.motion.robot().supplies())
    }

    /// The current activity: the running routine, unless it rests; otherwise the motion's.
    pub fn activity(&self) -> Activity {
        if self.routine.is_under_way() && !self.motion.is_resting() {
            Activity::Gait(self.routine.id)
        } else {
            self.motion.activity()
        }
    }

    /// The robot's state, as a column of the supervisor's table. During a routine the robot counts as walking
    /// even while it stands or rests, since the routine continues by itself.
    fn state(&self) -> State {
        if self.routine.is_under_way() {
            return State::Walking;
        }
        match self.motion.activity() {
            Activity::Rest => State::Resting,
            Activity::Gait(id) if id != GaitId::STAND => State::Walking,
            _ => State::Posing,
        }
    }

    /// Checks the board's health and reacts to a fault.
    fn check_health(&mut self, health: &Health) {
        // Without a robot there is nothing to stop, and no voltage that would be too low.
        if self.motion.robot().is_none() {
            return;
        }
        let state = self.state();
        let supplies = self.motion.robot().supplies();
        // A routine that `boot` started needs no sender of commands, so silence is not a fault.
        let deadman_ms = if self.is_unattended && self.routine.is_under_way() {
            0
        } else {
            self.settings.deadman_ms()
        };
        match self
            .safety
            .check_frame(health, &supplies, state, deadman_ms)
        {
            Reaction::None => {}
            Reaction::Freeze => self.stop(),
            Reaction::EndPulses => {
                self.stop();
                self.motion.rest();
            }
            Reaction::Boot => self.boot(state),
        }
        self.motion.set_slow(self.safety.is_slow());
    }

    /// Carries out the `boot` setting, unless the robot is in that state already.
    fn boot(&mut self, state: State) {
        let boot = self.settings.boot(self.motion.robot());
        let is_resting = state == State::Resting;
        match boot {
            Boot::Gait(GaitId::STAND) if !is_resting => return,
            Boot::Rest if is_resting => return,
            Boot::Gait(gait) => {
                self.start_gait(gait, 0);
                self.is_unattended = true;
                self.rest_pose_write = Some(REST_POSE_ADDRESS.start_invalidation());
            }
            Boot::Rest => self.rest(),
        }
        self.safety.notify(Notice::Boot);
    }

    /// Carries out an order.
    ///
    /// # Errors
    /// Returns the reason for the refusal; nothing has changed.
    #[inline(never)]
    pub fn execute(&mut self, order: &Order) -> Result<Acceptance, Refusal> {
        if self.motion.robot().is_none() {
            return Err(Refusal::NoRobot);
        }
        match order {
            Order::Gait(gait, cycles) => {
                self.check_allowed(match *gait {
                    GaitId::STAND => Event::Stand,
                    _ => Event::Move,
                })?;
                self.prepare_for_motion();
                self.start_gait(*gait, *cycles);
            }
            Order::Pose(angles) => {
                let pose = Pose::from_angles(angles, &self.motion.robot().neutral_angles());
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
                self.check_allowed(Event::Stop)?;
                self.stop();
            }
            Order::Rest => {
                if self.check_allowed(Event::Rest)? {
                    self.rest();
                }
            }
            Order::Speed(percent) => self.motion.set_speed(*percent),
            Order::Set(servo, setting) => self.set_servo(*servo, *setting)?,
            Order::Boot(boot) => self.settings.set_boot(*boot, self.motion.robot()),
            Order::Deadman(ms) => self.settings.set_deadman_ms(*ms),
            Order::Factory => {
                let factory_settings = Settings::of(self.motion.robot());
                self.replace_settings(&factory_settings)?;
            }
            Order::Save => {
                self.check_allowed(Event::Save)?;
                self.job = Some(Job::ChooseCopy);
                return Ok(Acceptance::Pending);
            }
            Order::Load => {
                self.job = Some(Job::Load);
                return Ok(Acceptance::Pending);
            }
        }
        Ok(Acceptance::Done)
    }

    /// Looks up an event in the supervisor's table. Returns true if the order must be carried out, false if there is
    /// nothing to do.
    ///
    /// # Errors
    /// Returns the reason for the refusal.
    #[inline(never)]
    fn check_allowed(&self, event: Event) -> Result<bool, Refusal> {
        match self.safety.response(event, self.state()) {
            Response::RefuseResting => Err(Refusal::Resting),
            Response::RefuseSupply => Err(Refusal::Supply),
            response => Ok(response == Response::Obey),
        }
    }

    /// Begins a move to a pose.
    ///
    /// # Errors
    /// Returns the reason for the refusal; nothing has changed.
    fn go_to(&mut self, pose: &Pose) -> Result<(), Refusal> {
        if let Some(servo) = pose.first_servo_beyond_travel(self.motion.calibration()) {
            return Err(Refusal::Unsafe(Hazard::Travel(servo)));
        }
        self.check_allowed(Event::Move)?;
        self.motion.go_to(pose).map_err(Refusal::Unsafe)?;
        self.prepare_for_motion();
        Ok(())
    }

    /// Freezes the pose, and ends the routine.
    #[inline(never)]
    fn stop(&mut self) {
        self.routine = Routine::NONE;
        self.motion.stop();
    }

    /// Prepares for a motion that an order starts: ends the routine, clears the fault, and invalidates
    /// the saved rest pose.
    fn prepare_for_motion(&mut self) {
        self.routine = Routine::NONE;
        self.safety.clear_fault();
        self.brown_outs = 0;
        self.rest_pose_write = Some(REST_POSE_ADDRESS.start_invalidation());
    }

    /// Ends the pulses and saves the pose for the next power-on.
    fn rest(&mut self) {
        self.routine = Routine::NONE;
        self.motion.rest();
        self.rest_pose_write = Some(REST_POSE_ADDRESS.start_write());
    }
}
