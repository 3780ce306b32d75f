//! The robot's motion: one pose every 20 ms, for any sequence of commands.
//!
//! A servo that receives a distant angle turns as fast as it can. If all four servos do so, the supply drops. Therefore
//! the pose never jumps. A transition from one motion to another has three parts, each with a continuous speed:
//!
//! 1. The old motion brakes along its own path (a gait along its cycle, a move along its line), so that it passes only
//!    poses that have been checked.
//! 2. A point-to-point move within the slew limit leads to the first pose of the new motion; all servos arrive
//!    together.
//! 3. The new gait accelerates gradually to its pace.
//!
//! `stop` freezes the pose in the next frame without braking; `rest` ends the pulses.
//!
//! # States
//! This table shows the effect of each command and of each frame in each state. A command *queues* its gait or pose,
//! which becomes the next target and follows the current motion. At a pace of 0 a motion stands still. "-" means no
//! change.
//!
//! | state | command | frame |
//! |---|---|---|
//! | `Resting`: no pulses | a gait or a pose: queued, `Holding`, and the servos wake; `rest`, `stop`: - | - |
//! | `Holding` a pose | a gait or a pose: queued | with a next target: `Moving` towards it |
//! | `Moving` to a pose | a gait or a pose: queued; the gait to which the move leads: - | with a next target: brakes, then is `Moving` towards it; without: on arrival `Holding`, or `Cycling` from phase 0 |
//! | `Cycling` through a gait | another gait or a pose: queued; the same gait: - | with a next target: brakes, then is `Moving` towards it |
//! | any but `Resting` | `stop`: `Holding`, no next target; `rest`: `Resting`, no next target | if the new pose is unsafe: `Holding` the last pose, no next target, and the hazard is kept |
//!
//! The next target may also be a standstill: at the end of a counted gait or of a routine, or while a routine waits.
//! The motion then brakes and is `Holding`.
//!
//! A new calibration changes the pulses of a pose. In every state, the pose then stays the same while the pulses
//! settle, that is, change to their new widths at the slew limit. Then the motion accelerates again from a pace of 0.
//!
//! Invariants: [`Motion::advance_frame`] adopts only poses that have passed the guard. An unsafe pose is never sent;
//! instead the last safe pose is held, and the hazard is stored for the console. The 50 Hz call of
//! [`Motion::advance_frame`] is the only clock, so the pace does not depend on the processor's load.

use lizard_avr::Region;

use crate::guard::clearance;
use crate::guard::hazard::Hazard;
use crate::memory::restart::ServoState;
use crate::motion::pace;
use crate::motion::point_to_point::PointToPointMove;
use crate::motion::state::{Activity, State, Target};
use crate::numbers::calibration::Calibration;
use crate::numbers::gaits::GaitId;
use crate::numbers::part::Servo;
use crate::numbers::pose::{Pose, Pulses};
use crate::numbers::robot::Robot;
use crate::numbers::section::SectionError;

use count::CycleCount;

mod count;
mod getters;
mod resume;

/// Frames from the wake-up of one servo to the wake-up of the next: 0.1 s, so that the supply does not drop.
const WAKE_INTERVAL_FRAMES: u8 = 5;

/// The speed setting at which a gait runs at the pace in robot.toml, percent.
const FULL_SPEED_PERCENT: u8 = 100;

/// Frames from the command that wakes the servos until all four servos are awake and may move.
pub const AWAKE_FRAMES: u8 = 4 * WAKE_INTERVAL_FRAMES;

/// The motion of a robot: its state, its next target and the pulses of the last frame.
#[derive(Clone, Debug)]
pub struct Motion {
    robot: Robot<'static>,
    calibration: [Calibration; 4],
    state: State,
    /// The target that follows when the current motion stands still; always `None` while the robot rests.
    next_target: Option<Target>,
    /// The cycle count of the current or the next gait.
    cycle_count: CycleCount,
    /// True in the frame in which the robot comes to a standstill, see [`Target::Standstill`].
    has_come_to_standstill: bool,
    /// The pace of gaits, in percent of the pace in robot.toml.
    speed_percent: u8,
    /// True while the supply limits the pace to [`Robot::slow_pace`].
    is_slow: bool,
    /// True while the pulses change to the widths of a new calibration.
    is_settling: bool,
    /// The state of the servos; `is_resting` is true only in [`State::Resting`].
    servo_state: ServoState,
    /// The hazard that made the guard stop the robot; `None` once another motion has been ordered.
    hazard: Option<Hazard>,
    /// Frames since the program started.
    frame_count: u32,
}

impl Motion {
    /// Creates a motion that has not begun. [`Motion::load_robot`] or [`Motion::start_standing`] must follow, then
    /// [`Motion::calibrate`] for every servo. With [`Robot::NONE`] all bits of the motion are zero, so it requires no
    /// initial value in flash.
    pub const fn unstarted(robot: Robot<'static>) -> Self {
        Self {
            calibration: [Calibration::NONE; 4],
            state: State::Resting,
            robot,
            next_target: None,
            cycle_count: CycleCount::NONE,
            has_come_to_standstill: false,
            speed_percent: 0,
            is_slow: false,
            is_settling: false,
            servo_state: ServoState {
                is_resting: false,
                ..ServoState::RESTING
            },
            hazard: None,
            frame_count: 0,
        }
    }

    /// Loads the robot at the beginning of `flash`; [`Motion::calibrate`] must follow for every servo.
    ///
    /// # Errors
    /// Fails if the flash holds no valid robot.
    pub fn load_robot(&mut self, flash: Region<'static>) -> Result<(), SectionError> {
        self.speed_percent = FULL_SPEED_PERCENT;
        self.servo_state.is_resting = true;
        self.robot = Robot::open(flash)?;
        Ok(())
    }

    /// Wakes the servos; then the robot stands.
    pub fn start_standing(&mut self) {
        self.servo_state.is_resting = false;
        self.state = State::cycling(&self.robot, GaitId::STAND);
    }

    /// The robot that moves.
    pub const fn robot(&self) -> &Robot<'static> {
        &self.robot
    }

    /// The calibration of the servos.
    pub const fn calibration(&self) -> &[Calibration; 4] {
        &self.calibration
    }

    /// Replaces the calibration of a servo; [`Motion::settle`] must follow.
    pub fn calibrate(&mut self, servo: Servo, calibration: Calibration) {
        *servo.pick_mut(&mut self.calibration) = calibration;
    }

    /// Replaces the calibration of all servos; [`Motion::settle`] must follow.
    pub fn calibrate_all(&mut self, calibration: &[Calibration; 4]) {
        self.calibration = *calibration;
    }

    /// Starts to change the pulses, at the slew limit, to the widths of a new calibration. Meanwhile the pose stays the
    /// same.
    pub fn settle(&mut self) {
        if let State::Moving { pace, .. } | State::Cycling { pace, .. } = &mut self.state {
            *pace = 0;
        }
        self.is_settling = true;
    }

    /// True if the current pose, the end of the current move or the next pose would exceed the travel of `servo` with
    /// `calibration`; the poses of gaits are not checked.
    pub fn exceeds_travel(&self, servo: Servo, calibration: &Calibration) -> bool {
        let is_beyond = |pose: &Pose| !calibration.reaches(*servo.pick(&pose.0));
        let is_target_beyond = match &self.state {
            State::Moving { path, .. } => is_beyond(path.target()),
            _ => false,
        };
        let is_next_beyond = match &self.next_target {
            Some(Target::Pose(pose)) => is_beyond(pose),
            _ => false,
        };
        is_beyond(&self.servo_state.pose) || is_target_beyond || is_next_beyond
    }

    /// The state of the servos, which must survive a reset.
    pub const fn servo_state(&self) -> &ServoState {
        &self.servo_state
    }

    /// Starts a gait with a move to its first pose, or continues the gait if it is already running. After `cycles` more
    /// cycles the gait brakes, and the robot holds the pose in which it stops; with 0 the gait does not end.
    #[inline(never)]
    pub fn start_gait(&mut self, id: GaitId, cycles: u16) {
        if self.activity() != Activity::Gait(id) {
            self.queue_target(Target::Gait(id));
        } else if let Some(Target::Standstill) = self.next_target {
            self.next_target = None;
        }
        self.cycle_count.cycles_left = cycles;
        self.cycle_count.phase_covered = 0;
    }

    /// Brakes the current gait or move, cancels the next target, and then holds the pose in which the robot stops.
    /// Returns false if there is neither a current nor a next motion.
    #[inline(never)]
    pub fn brake_to_standstill(&mut self) -> bool {
        let has_motion = self.next_target.is_some()
            || matches!(self.state, State::Moving { .. } | State::Cycling { .. });
        if has_motion {
            self.next_target = Some(Target::Standstill);
        }
        has_motion
    }

    /// True if the robot came to a standstill in the last frame, after the last cycle of a counted gait or after
    /// [`Motion::brake_to_standstill`].
    pub const fn has_come_to_standstill(&self) -> bool {
        self.has_come_to_standstill
    }

    /// Queues a move to a pose.
    ///
    /// # Errors
    /// Returns the limit that the pose violates; nothing has changed.
    pub fn go_to(&mut self, pose: &Pose) -> Result<(), Hazard> {
        match self.first_hazard(pose) {
            Some(hazard) => Err(hazard),
            None => {
                self.queue_target(Target::Pose(*pose));
                Ok(())
            }
        }
    }

    /// Freezes the pose in the next frame.
    pub fn stop(&mut self) {
        if !matches!(self.state, State::Resting) {
            self.freeze(State::Holding {
                is_commanded: false,
            });
        }
    }

    /// Ends the pulses with the next frame.
    pub fn rest(&mut self) {
        self.freeze(State::Resting);
    }

    /// Clears the guard's hazard; called when an order moves the robot.
    pub fn clear_hazard(&mut self) {
        self.hazard = None;
    }

    /// Sets the pace of gaits, in percent of the pace in robot.toml, 10..=100.
    pub fn set_speed(&mut self, percent: u8) {
        self.speed_percent = percent;
    }

    /// Limits gaits to [`Robot::slow_pace`] because of a low supply, or removes this limit.
    pub fn set_slow(&mut self, is_slow: bool) {
        self.is_slow = is_slow;
    }

    /// Advances the motion by a frame, and returns the pulses of that frame.
    pub fn advance_frame(&mut self) -> Pulses {
        self.frame_count = self.frame_count.wrapping_add(1);
        self.has_come_to_standstill = false;
        let mut pulses = Pulses::default();
        if matches!(self.state, State::Resting) {
            return pulses;
        }
        let frames_awake_before = self.servo_state.frames_awake;
        if frames_awake_before < AWAKE_FRAMES {
            self.servo_state.frames_awake = frames_awake_before + 1;
        } else if !self.is_settling {
            self.advance_motion();
        }
        // While the pulses settle, the slew limit restricts their change per frame.
        let per_frame = self.robot.slew().per_frame;
        let is_first_frame = self.frame_count == 1;
        let mut is_still_settling = false;
        let mut wake_frame = WAKE_INTERVAL_FRAMES;
        for (index, pulse) in pulses.0.iter_mut().enumerate() {
            let calibration = &self.calibration[index];
            let stored_width = &mut self.servo_state.sent_pulses.0[index];
            let is_asleep = self.servo_state.frames_awake < wake_frame;
            let mut width = calibration.width(self.servo_state.pose.0[index]);
            if self.is_settling && stored_width.0 != 0 {
                // A servo's first pulse repeats its stored width, even one from before a reset: the reset may have
                // occurred while the pulses were settling, or before the stored width was sent.
                let is_repeated = is_first_frame || frames_awake_before < wake_frame;
                let max_change = if is_repeated {
                    0
                } else {
                    calibration.max_width_change(per_frame)
                };
                let target_width = width.0;
                width.0 = target_width
                    .max(stored_width.0.saturating_sub(max_change))
                    .min(stored_width.0.saturating_add(max_change));
                is_still_settling |= width.0 != target_width;
            }
            *stored_width = width;
            if !is_asleep {
                *pulse = width;
            }
            wake_frame += WAKE_INTERVAL_FRAMES;
        }
        self.is_settling = is_still_settling;
        pulses
    }

    /// The current activity, or the activity to which the robot is moving.
    pub const fn activity(&self) -> Activity {
        match (self.next_target, self.state) {
            (Some(Target::Gait(id)), _) => Activity::Gait(id),
            (Some(Target::Pose(_)), _) => Activity::Pose,
            (None, State::Resting) => Activity::Rest,
            (None, State::Holding { is_commanded: true }) => Activity::Pose,
            (
                None,
                State::Holding {
                    is_commanded: false,
                },
            ) => Activity::Stop,
            (None, State::Moving { gait: None, .. }) => Activity::Pose,
            (None, State::Moving { gait: Some(id), .. })
            | (None | Some(Target::Standstill), State::Cycling { id, .. }) => Activity::Gait(id),
            // A move that brakes to a standstill, or a held pose whose next target was cancelled.
            (Some(Target::Standstill), _) => Activity::Stop,
        }
    }

    /// Returns the first limit that a pose violates, if any: a servo's travel, or a limit of the guard.
    fn first_hazard(&self, pose: &Pose) -> Option<Hazard> {
        match pose.first_servo_beyond_travel(&self.calibration) {
            Some(servo) => Some(Hazard::Travel(servo)),
            None => clearance::find_hazard(&self.robot, pose),
        }
    }

    /// Makes `target` the next target, and wakes the servos if the robot rests.
    fn queue_target(&mut self, target: Target) {
        if matches!(self.state, State::Resting) {
            self.state = State::Holding {
                is_commanded: false,
            };
            self.servo_state.is_resting = false;
            self.servo_state.frames_awake = 0;
            // The servos are still at the angles of their last pulses, if any. Settings that have changed since then
            // must not make them jump.
            self.is_settling = true;
        }
        self.next_target = Some(target);
    }

    /// Ends all motion in the current pose. The robot then holds the pose or rests, according to `state`.
    fn freeze(&mut self, state: State) {
        self.servo_state.is_resting = matches!(state, State::Resting);
        self.state = state;
        self.next_target = None;
    }

    /// Advances the motion, or the next one after a standstill, by a frame. Freezes the last pose before an unsafe one.
    // Not inlined, because in `advance_frame` its registers would cost more than the call.
    #[inline(never)]
    fn advance_motion(&mut self) {
        self.count_cycles();
        self.start_next_target();
        let is_braking = self.next_target.is_some();
        let pose = match &mut self.state {
            State::Resting | State::Holding { .. } => return,
            State::Moving { path, pace, .. } => {
                *pace = pace::step_toward(*pace, if is_braking { 0 } else { pace::FULL_PACE });
                path.advance(*pace);
                path.pose()
            }
            State::Cycling {
                gait, phase, pace, ..
            } => {
                let percent = if self.is_slow {
                    self.speed_percent.min(self.robot.slow_pace())
                } else {
                    self.speed_percent
                };
                *pace = pace::step_toward(
                    *pace,
                    if is_braking {
                        0
                    } else {
                        pace::from_percent(percent)
                    },
                );
                *phase = gait.advance(*phase, *pace);
                gait.pose(self.robot.waves(), *phase)
            }
        };
        let hazard = self.first_hazard(&pose);
        if hazard.is_some() {
            self.freeze(State::Holding {
                is_commanded: false,
            });
            self.hazard = hazard;
            return;
        }
        self.servo_state.pose = pose;
        if let State::Moving { path, gait, .. } = &self.state
            && path.has_arrived()
        {
            self.state = match gait {
                None => State::Holding { is_commanded: true },
                Some(id) => {
                    self.cycle_count.last_phase = 0;
                    State::cycling(&self.robot, *id)
                }
            };
        }
    }

    /// Starts the move to the next target if the pace of the old motion is 0.
    #[inline(always)]
    fn start_next_target(&mut self) {
        if let Some(target) = self.next_target
            && !matches!(
                self.state,
                State::Moving { pace: 1.., .. } | State::Cycling { pace: 1.., .. }
            )
        {
            self.next_target = None;
            self.move_to(target);
        }
    }

    /// Starts the move to a target, or ends all motion if the target is a standstill.
    // Not inlined, because most frames do not call it.
    #[inline(never)]
    fn move_to(&mut self, target: Target) {
        let (target_pose, gait) = match target {
            Target::Pose(pose) => (pose, None),
            Target::Gait(id) => (self.robot.gait(id).pose(self.robot.waves(), 0), Some(id)),
            Target::Standstill => {
                self.has_come_to_standstill = true;
                return self.freeze(State::Holding {
                    is_commanded: false,
                });
            }
        };
        self.state = State::Moving {
            path: PointToPointMove::new(&self.servo_state.pose, &target_pose, self.robot.slew()),
            pace: pace::FULL_PACE,
            gait,
        };
    }
}

#[cfg(test)]
mod tests;
