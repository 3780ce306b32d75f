//! The robot's motion: one pose every 20 ms, whatever the commands are.
//!
//! A servo that gets a distant angle turns as fast as it can. If all four do, the supply
//! sags. So no pose here ever jumps. A change from any motion to any other has three
//! parts, each continuous in speed:
//!
//! 1. the old motion brakes along its own path (a gait within its cycle, a move within
//!    its line), so that it passes only poses that have been checked;
//! 2. one point-to-point move, at most at the slew limit, leads to where the new
//!    motion begins, all servos arriving together;
//! 3. the new gait reaches its pace gradually.
//!
//! `stop` skips the braking and freezes the pose in the next frame; `rest` ends the pulses.
//!
//! # States
//! The effect of each command and of each frame, by state. "That next" makes the commanded
//! gait or pose the target that follows the present motion; "-" changes nothing. "Standing
//! still" is a pace of 0.
//!
//! | state | command | frame |
//! |---|---|---|
//! | `Resting`: no pulses | a gait or a pose: `Holding`, that next, and servos wake; `rest`, `stop`: - | stays |
//! | `Holding` a pose | a gait or a pose: that next | with a next: `Moving` towards it |
//! | `Moving` to a pose | a gait or a pose: that next; the gait it leads to: - | brakes if there is a next, and once it stands still is `Moving` towards that; arrived, it is `Holding`, or `Cycling` from phase 0 |
//! | `Cycling` through a gait | another gait or a pose: that next; the same gait: - | brakes if there is a next, and once it stands still is `Moving` towards that |
//! | any but `Resting` | `stop`: `Holding`; `rest`: `Resting`; nothing next | an unsafe pose: `Holding` the last one, nothing next, with the reason |
//!
//! A new calibration changes the pulses of a pose. Then the pose stays as it is, in every state, while the pulses
//! move to their new widths at the slew limit. After that the motion speeds up again from a pace of 0.
//!
//! Invariants: every pose that leaves [`Motion::tick`] has passed the guard. A pose that has not passed is
//! never sent; the last safe pose is held instead, and the reason is kept for the console. The 50 Hz call of
//! [`Motion::tick`] is the only clock, so the pace cannot depend on how busy the processor is.

use lizard_avr::Region;

use crate::guard::clearance;
use crate::guard::hazard::Hazard;
use crate::memory::restart::Stance;
use crate::motion::pace;
use crate::motion::point_to_point::PointToPoint;
use crate::motion::state::{Activity, State, Target};
use crate::numbers::calibration::Calibration;
use crate::numbers::gaits::GaitId;
use crate::numbers::part::Servo;
use crate::numbers::pose::{Pose, Pulses};
use crate::numbers::robot::Robot;
use crate::numbers::section::Damage;

use count::Count;

mod count;
mod report;
mod resume;

/// Frames from the wake-up of one servo to that of the next, 0.1 s, to spare the supply.
const WAKE_INTERVAL_FRAMES: u8 = 5;

/// The speed setting at which a gait has its own pace, percent.
const FULL_PERCENT: u8 = 100;

/// Frames from the command that wakes the servos until all four are awake and motion may begin.
pub const AWAKE_FRAMES: u8 = 4 * WAKE_INTERVAL_FRAMES;

/// The motion of a robot: its state, its target and the pulses of the last frame.
#[derive(Clone, Debug)]
pub struct Motion {
    robot: Robot<'static>,
    calibration: [Calibration; 4],
    state: State,
    /// The target after the present motion has stopped; always `None` while the robot rests.
    next: Option<Target>,
    /// The cycles left of the gait that is under way or comes next.
    count: Count,
    /// True in the frame in which a gait has ended.
    has_ended: bool,
    /// Percent of the gaits' own pace.
    speed: u8,
    /// True while the supply limits the pace to [`Robot::slow_pace`].
    is_slow: bool,
    /// True while the pulses move to a new calibration's widths.
    is_settling: bool,
    /// The servos' state; `is_resting` is true in [`State::Resting`] only.
    stance: Stance,
    hazard: Option<Hazard>,
    frames: u32,
}

impl Motion {
    /// The robot at power-on: waking, then standing.
    pub fn new(robot: Robot<'static>) -> Self {
        let mut motion = Self::unstarted(robot);
        motion.speed = FULL_PERCENT;
        motion.begin();
        for servo in Servo::all() {
            motion.calibrate(servo, motion.robot.calibration_of(servo));
        }
        motion
    }

    /// A motion that has not begun. With [`Robot::NONE`] every bit is zero, so that it needs no copy in flash.
    /// [`Motion::take_robot`] or [`Motion::begin`] has to follow, and the calibration of every servo.
    pub const fn unstarted(robot: Robot<'static>) -> Self {
        Self {
            calibration: [Calibration::NONE; 4],
            state: State::Resting,
            robot,
            next: None,
            count: Count::NONE,
            has_ended: false,
            speed: 0,
            is_slow: false,
            is_settling: false,
            stance: Stance {
                is_resting: false,
                ..Stance::RESTING
            },
            hazard: None,
            frames: 0,
        }
    }

    /// Loads the robot at the beginning of `flash`; the calibration of every servo has to
    /// follow.
    ///
    /// # Errors
    /// Returns the reason why the flash holds no usable robot.
    pub fn take_robot(&mut self, flash: Region<'static>) -> Result<(), Damage> {
        self.speed = FULL_PERCENT;
        self.stance.is_resting = true;
        self.robot = Robot::open(flash)?;
        Ok(())
    }

    /// Wakes the servos; then the robot stands.
    pub fn begin(&mut self) {
        self.stance.is_resting = false;
        self.state = State::cycling(&self.robot, GaitId::STAND);
    }

    /// The description of the robot that moves.
    pub const fn robot(&self) -> &Robot<'static> {
        &self.robot
    }

    /// The servos' pulses and travel.
    pub const fn calibration(&self) -> &[Calibration; 4] {
        &self.calibration
    }

    /// Replaces the calibration of a servo; [`Motion::settle`] has to follow.
    pub fn calibrate(&mut self, servo: Servo, calibration: Calibration) {
        *servo.of_mut(&mut self.calibration) = calibration;
    }

    /// Replaces the calibration of all servos; [`Motion::settle`] has to follow.
    pub fn calibrate_all(&mut self, calibration: &[Calibration; 4]) {
        self.calibration = *calibration;
    }

    /// Moves the pulses to the new calibration, at the slew limit. Nothing else moves
    /// meanwhile.
    pub fn settle(&mut self) {
        if let State::Moving { pace, .. } | State::Cycling { pace, .. } = &mut self.state {
            *pace = 0;
        }
        self.is_settling = true;
    }

    /// True if the present pose or a target would be beyond the travel of `servo` with
    /// `calibration`.
    pub fn goes_beyond(&self, servo: Servo, calibration: &Calibration) -> bool {
        let is_beyond = |pose: &Pose| !calibration.reaches(*servo.of(&pose.0));
        let is_target_beyond = match &self.state {
            State::Moving { path, .. } => is_beyond(path.target()),
            _ => false,
        };
        let is_next_beyond = match &self.next {
            Some(Target::Pose(pose)) => is_beyond(pose),
            _ => false,
        };
        is_beyond(&self.stance.pose) || is_target_beyond || is_next_beyond
    }

    /// The servos' state, which has to survive a reset.
    pub const fn stance(&self) -> &Stance {
        &self.stance
    }

    /// Starts a gait with a move to its first pose, or continues it if it is already under way.
    /// After `cycles` more cycles the gait brakes, and the robot holds the pose in which it
    /// stops; with 0 the gait goes on without end.
    #[inline(never)]
    pub fn start_gait(&mut self, id: GaitId, cycles: u16) {
        if self.activity() != Activity::Gait(id) {
            self.set_target(Target::Gait(id));
        } else if let Some(Target::End) = self.next {
            self.next = None;
        }
        self.count.cycles_left = cycles;
        self.count.phase_covered = 0;
    }

    /// Brakes the gait or move under way, cancels the next target, and holds the pose in which the robot
    /// stops. Returns false if nothing is under way or comes next.
    #[inline(never)]
    pub fn end_gait(&mut self) -> bool {
        let is_moving = self.next.is_some()
            || matches!(self.state, State::Moving { .. } | State::Cycling { .. });
        if is_moving {
            self.next = Some(Target::End);
        }
        is_moving
    }

    /// True if a gait ended in the last frame and the robot stands still.
    pub const fn has_ended(&self) -> bool {
        self.has_ended
    }

    /// Goes to a pose within the servos' travel.
    ///
    /// # Errors
    /// Returns the limit that the pose breaks; nothing has changed.
    pub fn go_to(&mut self, pose: &Pose) -> Result<(), Hazard> {
        match self.hazard_of(pose) {
            Some(hazard) => Err(hazard),
            None => {
                self.set_target(Target::Pose(*pose));
                Ok(())
            }
        }
    }

    /// Freezes the pose in the next frame.
    pub fn stop(&mut self) {
        if !matches!(self.state, State::Resting) {
            self.freeze(State::Holding { is_ordered: false });
        }
    }

    /// Ends the pulses with the next frame.
    pub fn rest(&mut self) {
        self.freeze(State::Resting);
    }

    /// Sets the pace of gaits, in percent of their own, 10..=100.
    pub fn set_speed(&mut self, percent: u8) {
        self.speed = percent;
    }

    /// Limits gaits to the pace of a low supply, or ends the limit.
    pub fn set_slow(&mut self, is_slow: bool) {
        self.is_slow = is_slow;
    }

    /// Computes the pulses of the next frame.
    pub fn tick(&mut self) -> Pulses {
        self.frames = self.frames.wrapping_add(1);
        self.has_ended = false;
        let mut pulses = Pulses::default();
        if matches!(self.state, State::Resting) {
            return pulses;
        }
        let awake_before = self.stance.frames_awake;
        if awake_before < AWAKE_FRAMES {
            self.stance.frames_awake = awake_before + 1;
        } else if !self.is_settling {
            self.advance_motion();
        }
        // While the pulses settle, they change by at most the slew limit per frame.
        let per_frame = self.robot.slew().per_frame;
        let is_first = self.frames == 1;
        let mut is_settling = false;
        let mut wakes_at = WAKE_INTERVAL_FRAMES;
        for (index, pulse) in pulses.0.iter_mut().enumerate() {
            let servo = &self.calibration[index];
            let sent = &mut self.stance.sent.0[index];
            let is_asleep = self.stance.frames_awake < wakes_at;
            let mut width = servo.width(self.stance.pose.0[index]);
            if self.is_settling && sent.0 != 0 {
                // A servo's first pulse repeats the last stored width, even one from before a
                // reset: the reset may have come while the pulses were settling, or before a
                // stored width was sent.
                let is_repeated = is_first || awake_before < wakes_at;
                let max_change = if is_repeated {
                    0
                } else {
                    servo.slew(per_frame)
                };
                let target_width = width.0;
                width.0 = target_width
                    .max(sent.0.saturating_sub(max_change))
                    .min(sent.0.saturating_add(max_change));
                is_settling |= width.0 != target_width;
            }
            *sent = width;
            if !is_asleep {
                *pulse = width;
            }
            wakes_at += WAKE_INTERVAL_FRAMES;
        }
        self.is_settling = is_settling;
        pulses
    }

    /// The present activity, or the one that the robot is moving to.
    pub const fn activity(&self) -> Activity {
        match (self.next, self.state) {
            (Some(Target::Gait(id)), _) => Activity::Gait(id),
            (Some(Target::Pose(_)), _) => Activity::Pose,
            (None, State::Resting) => Activity::Rest,
            (None, State::Holding { is_ordered: true }) => Activity::Pose,
            (None, State::Holding { is_ordered: false }) => Activity::Stop,
            (None, State::Moving { gait: None, .. }) => Activity::Pose,
            (None, State::Moving { gait: Some(id), .. })
            | (None | Some(Target::End), State::Cycling { id, .. }) => Activity::Gait(id),
            // A move that ends before its gait has begun.
            (Some(Target::End), _) => Activity::Stop,
        }
    }

    /// The first limit that a pose breaks.
    fn hazard_of(&self, pose: &Pose) -> Option<Hazard> {
        match pose.first_beyond_travel(&self.calibration) {
            Some(servo) => Some(Hazard::Travel(servo)),
            None => clearance::find_hazard(&self.robot, pose),
        }
    }

    fn set_target(&mut self, target: Target) {
        if matches!(self.state, State::Resting) {
            self.state = State::Holding { is_ordered: false };
            self.stance.is_resting = false;
            self.stance.frames_awake = 0;
            // The servos are still where their last pulses turned them, if they had any; settings that have
            // changed since must not make them jump.
            self.is_settling = true;
        }
        self.next = Some(target);
    }

    fn freeze(&mut self, state: State) {
        self.stance.is_resting = matches!(state, State::Resting);
        self.state = state;
        self.next = None;
    }

    // Not inlined: in `tick` its registers would cost more than the call.
    #[inline(never)]
    fn advance_motion(&mut self) {
        self.count();
        self.start_next_target();
        let is_braking = self.next.is_some();
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
                    self.speed.min(self.robot.slow_pace())
                } else {
                    self.speed
                };
                *pace = pace::step_toward(
                    *pace,
                    if is_braking {
                        0
                    } else {
                        pace::of_percent(percent)
                    },
                );
                *phase = gait.advance(*phase, *pace);
                gait.pose(self.robot.waves(), *phase)
            }
        };
        let hazard = self.hazard_of(&pose);
        if hazard.is_some() {
            self.freeze(State::Holding { is_ordered: false });
            self.hazard = hazard;
            return;
        }
        self.stance.pose = pose;
        if let State::Moving { path, gait, .. } = &self.state
            && path.has_arrived()
        {
            self.state = match gait {
                None => State::Holding { is_ordered: true },
                Some(id) => {
                    self.count.phase = 0;
                    State::cycling(&self.robot, *id)
                }
            };
        }
    }

    /// Begins the move to the next target once the pace of the old motion is 0.
    #[inline(always)]
    fn start_next_target(&mut self) {
        if let Some(target) = self.next
            && !matches!(
                self.state,
                State::Moving { pace: 1.., .. } | State::Cycling { pace: 1.., .. }
            )
        {
            self.next = None;
            self.move_to(target);
        }
    }

    // Out of line: most frames do not need it.
    #[inline(never)]
    fn move_to(&mut self, target: Target) {
        let (target_pose, gait) = match target {
            Target::Pose(pose) => (pose, None),
            Target::Gait(id) => (self.robot.gait(id).pose(self.robot.waves(), 0), Some(id)),
            Target::End => {
                self.has_ended = true;
                return self.freeze(State::Holding { is_ordered: false });
            }
        };
        self.state = State::Moving {
            path: PointToPoint::new(&self.stance.pose, &target_pose, self.robot.slew()),
            pace: pace::FULL_PACE,
            gait,
        };
        self.hazard = None;
    }
}

#[cfg(test)]
mod tests;
