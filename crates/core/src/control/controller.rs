//! The controller of the robot: executes orders, computes frames, and reacts to faults.
//!
//! A console on a serial port, or another source, gives orders to the controller, which accepts or refuses them. Fifty
//! times a second the controller checks for faults and computes a frame; between frames it reads and writes the EEPROM.
//! Nothing here depends on the text of commands or answers.

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
use crate::memory::restart::{Cause, Restart, ServoState};
use crate::memory::settings::{Boot, Settings};
use crate::motion::{Activity, Motion};
use crate::numbers::gaits::GaitId;
use crate::numbers::pose::{Pose, Pulses};
use crate::numbers::robot::Robot;
use crate::numbers::section::SectionError;

use eeprom_operation::EepromOperation;
use routine::Routine;

mod adjust;
mod eeprom_operation;
mod getters;
mod routine;

/// Frames without a reset after which the supply counts as good again: 30 s.
const GOOD_SUPPLY_FRAMES: u32 = 1500;

/// Frames after the program's start within which all servos wake: 0.6 s.
const MAX_WAKING_FRAMES: u32 = 30;

/// The controller of the robot: its motion, its settings, its safety monitor, and the EEPROM operation in progress.
#[derive(Clone, Debug)]
pub struct Controller {
    motion: Motion,
    settings: Settings,
    /// The error in the robot's section of flash; `None` if the section is valid.
    section_error: Option<SectionError>,
    /// The state of the saved settings at power-on.
    saved_settings_state: SavedState,
    safety: Safety,
    /// The cause of the last reset.
    reset_cause: Cause,
    /// Resets since power-on, at most 255.
    reset_count: u8,
    /// True if a weak supply may have caused the last reset. Becomes false once a command proves that a computer has
    /// opened the port.
    is_supply_suspected: bool,
    /// Consecutive resets, including the last one, that a weak supply may have caused.
    suspected_brown_outs: u8,
    /// True if a command has been received since the program started.
    has_received_command: bool,
    routine: Routine,
    /// The contact that may end the current step of a routine.
    contact: Contact,
    /// True if `boot` started the current activity, and no command has been received since.
    is_unattended: bool,
    /// The EEPROM operation that an order has started, if any.
    eeprom_operation: Option<EepromOperation>,
    /// The write or invalidation of the rest pose's record, if one is in progress.
    rest_pose_write: Option<RecordWrite>,
    /// The hazard that makes the guard hold the robot, until the hazard is printed.
    hold_reason: Option<Hazard>,
}

impl Controller {
    /// Creates a controller that has no robot; [`Controller::begin`] must follow.
    pub const fn new() -> Self {
        Self {
            settings: Settings::NONE,
            motion: Motion::unstarted(Robot::NONE),
            section_error: None,
            saved_settings_state: SavedState::Latest,
            safety: Safety::new(),
            reset_cause: Cause::Power,
            reset_count: 0,
            is_supply_suspected: false,
            suspected_brown_outs: 0,
            has_received_command: false,
            routine: Routine::NONE,
            contact: Contact::NONE,
            is_unattended: false,
            eeprom_operation: None,
            rest_pose_write: None,
            hold_reason: None,
        }
    }

    /// Loads the robot's section from `flash`, then restores the settings and the rest pose from the EEPROM, and the
    /// state of the servos before the reset. If the section is not valid, there is no robot, and the controller never
    /// sends pulses.
    #[inline(never)]
    pub fn begin<M: Memory>(&mut self, flash: Region<'static>, memory: &M, restart: &Restart) {
        self.reset_cause = restart.cause;
        self.reset_count = restart.reset_count;
        if let Err(section_error) = self.motion.load_robot(flash) {
            self.section_error = Some(section_error);
            self.safety.record_fault(Fault::Robot);
            return;
        }
        self.is_supply_suspected = restart.is_supply_suspected;
        self.saved_settings_state = copies::load(self.motion.robot(), memory, &mut self.settings);
        if self.saved_settings_state != SavedState::Latest {
            self.safety.notify(Notice::SavedSettings);
        }
        self.apply_calibration();
        let servos_before = match &restart.servo_state_before {
            None => ServosBefore::Unknown,
            Some(servo_state) if servo_state.is_resting => ServosBefore::Rested,
            Some(_) => ServosBefore::Held,
        };
        let suspected_brown_outs = restart.suspected_brown_outs.min(BROWN_OUTS_TO_REST - 1);
        self.suspected_brown_outs = match restart.is_supply_suspected {
            true => suspected_brown_outs + 1,
            false => restart.suspected_brown_outs.min(BROWN_OUTS_TO_REST),
        };
        let (first_action, fault) =
            supervisor::first_action(restart.cause, self.suspected_brown_outs, servos_before);
        if let Some(fault) = fault {
            // Cancels `boot`, as a received byte does.
            self.safety.record_byte();
            self.safety.record_fault(fault);
        }
        let rest_pose = copies::read_rest_pose(self.motion.robot(), memory);
        let servo_state = restart.servo_state_before.as_ref();
        let is_awake = match (first_action, servo_state) {
            (FirstAction::Wake, _) => {
                self.motion.wake(rest_pose.as_ref());
                true
            }
            (FirstAction::WakeInPlace, Some(servo_state)) => self.motion.resume(servo_state, true),
            (FirstAction::Hold, Some(servo_state)) => self.motion.resume(servo_state, false),
            _ => false,
        };
        if is_awake {
            self.rest_pose_write = Some(REST_POSE_ADDRESS.start_invalidation());
            return;
        }
        // If the program was reset before its first frame, the robot has not moved since its last rest.
        let rest_servo_state = rest_pose.map(|pose| ServoState {
            pose,
            ..ServoState::RESTING
        });
        self.motion
            .resume_rest(servo_state.or(rest_servo_state.as_ref()));
        // The reset may have interrupted the write of the pose to the EEPROM.
        let is_saved = servos_before == ServosBefore::Unknown
            || rest_pose.as_ref() == Some(self.motion.pose());
        self.rest_pose_write = (!is_saved).then(|| REST_POSE_ADDRESS.start_write());
    }

    /// Computes the pulses of the next frame. Must be called 50 times a second.
    // Not inlined, so that a simulator can find the function by its name and time it.
    #[inline(never)]
    pub fn compute_frame(&mut self, health: &Health) -> Pulses {
        self.check_health(health);
        let was_held = self.motion.hazard().is_some();
        let pulses = self.motion.advance_frame();
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
            self.suspected_brown_outs = 0;
        }
        // A computer that opens the port resets the board and then sends a line. By radio, lines arrive at any time.
        // Therefore a line while the servos wake does not rule out a weak supply.
        let may_be_port_reset = self.is_supply_suspected && self.reset_cause == Cause::External;
        if may_be_port_reset && self.has_received_command && frames > MAX_WAKING_FRAMES {
            self.is_supply_suspected = false;
            self.suspected_brown_outs = self.suspected_brown_outs.saturating_sub(1);
        }
        self.safety.advance_led(hazard.is_some());
        pulses
    }

    /// Records that a byte was received, which means that a computer is connected.
    pub fn record_byte(&mut self) {
        self.safety.record_byte();
    }

    /// Records that a command was received.
    pub fn record_command(&mut self) {
        self.safety.record_command();
        self.is_unattended = false;
        self.has_received_command = true;
    }

    /// Takes the hazard that makes the guard hold the robot. Returns `None` if the guard does not hold the robot, or if
    /// the hazard was taken before.
    pub fn take_hold_reason(&mut self) -> Option<Hazard> {
        self.hold_reason.take()
    }

    /// True while the hazard that makes the guard hold the robot waits to be printed.
    pub const fn has_hold_reason(&self) -> bool {
        self.hold_reason.is_some()
    }

    /// Removes a notice that has been printed from the pending notices.
    pub fn clear_notice(&mut self, notice: Notice) {
        self.safety.clear_notice(notice);
    }

    /// The voltage of the chip's supply or of the servo rail, whichever restricts the robot more.
    #[inline(never)]
    pub fn limiting_voltage(&self) -> Voltage {
        self.safety
            .supply()
            .limiting_voltage(&self.motion.robot().supplies())
    }

    /// The current activity: the running routine, unless the routine rests; otherwise the activity of the motion.
    pub fn activity(&self) -> Activity {
        if self.routine.is_under_way() && !self.motion.is_resting() {
            Activity::Gait(self.routine.id)
        } else {
            self.motion.activity()
        }
    }

    /// The robot's state, which is a column of the supervisor's table. During a routine the robot counts as walking,
    /// even while it stands or rests, because the routine continues by itself.
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
        // If there is no robot, there is no motion to stop and no threshold of the supply.
        if self.motion.robot().is_none() {
            return;
        }
        let state = self.state();
        let supplies = self.motion.robot().supplies();
        // A routine that `boot` started requires no commands, so silence is not a fault.
        let deadman_ms = if self.is_unattended && self.routine.is_under_way() {
            0
        } else {
            self.settings.deadman_ms()
        };
        match self
            .safety
            .check_frame(health, &supplies, state, deadman_ms)
        {
            Reaction::Boot if self.motion.hazard().is_none() => self.execute_boot(state),
            Reaction::None | Reaction::Boot => {}
            Reaction::Freeze => self.stop(),
            Reaction::EndPulses => {
                self.stop();
                // If the robot rests already, its pose is saved, waits to be saved, or is not known.
                if !self.motion.is_resting() {
                    self.rest();
                }
            }
        }
        self.motion.set_slow(self.safety.is_slow());
    }

    /// Executes the `boot` setting, unless the robot is already in the required state.
    fn execute_boot(&mut self, state: State) {
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

    /// Executes an order.
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
                // The pose that cancels the trims.
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
                let factory_settings = Settings::for_robot(self.motion.robot());
                self.replace_settings(&factory_settings)?;
            }
            Order::Save => {
                self.check_allowed(Event::Save)?;
                self.eeprom_operation = Some(EepromOperation::ChooseCopy);
                return Ok(Acceptance::Pending);
            }
            Order::Load => {
                self.eeprom_operation = Some(EepromOperation::Load);
                return Ok(Acceptance::Pending);
            }
        }
        Ok(Acceptance::Done)
    }

    /// Looks up an event in the supervisor's table. Returns true if the order must be executed, false if there is
    /// nothing to do.
    ///
    /// # Errors
    /// Returns the reason for the refusal.
    #[inline(never)]
    fn check_allowed(&self, event: Event) -> Result<bool, Refusal> {
        match self.safety.response(event, self.state()) {
            Response::RefuseResting => Err(Refusal::Resting),
            Response::RefuseSupply => Err(Refusal::SupplyTooLow),
            response => Ok(response == Response::Obey),
        }
    }

    /// Starts a move to a pose.
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

    /// Freezes the pose and ends the routine.
    #[inline(never)]
    fn stop(&mut self) {
        // If the routine rests, the robot stays at rest, and its pose must survive a loss of power.
        if self.routine.is_under_way() && self.motion.is_resting() {
            return self.rest();
        }
        self.end_routine();
        self.motion.stop();
    }

    /// Prepares for a motion that an order starts: ends the routine, clears the fault, the guard's hazard and the count
    /// of suspected brown-outs, and invalidates the saved rest pose.
    fn prepare_for_motion(&mut self) {
        self.end_routine();
        self.safety.clear_fault();
        self.motion.clear_hazard();
        self.suspected_brown_outs = 0;
        self.rest_pose_write = Some(REST_POSE_ADDRESS.start_invalidation());
    }

    /// Ends the pulses and saves the pose for the next power-on.
    fn rest(&mut self) {
        self.end_routine();
        self.motion.rest();
        self.rest_pose_write = Some(REST_POSE_ADDRESS.start_write());
    }
}
