//! From wishes to frames: one pose every 20 ms, whatever happens.
//!
//! A servo that is told to be elsewhere goes there as fast as it can, all of
//! them at once, and the supply sags. So nothing here ever jumps. A change
//! from any motion to any other has three parts, each continuous in speed:
//!
//! 1. the old motion brakes along its own path (a gait within its cycle, a
//!    stroke within its line), so that it cannot leave ground it has checked;
//! 2. one stroke, at most at the slew limit, leads to where the new motion
//!    begins, all servos arriving together;
//! 3. the new gait gathers pace.
//!
//! `stop` alone skips the braking: it freezes the pose in the next frame.
//!
//! Invariants: every pose that leaves [`Motion::tick`] has passed the guard;
//! a pose that has not is never sent, the last safe one is held instead, and
//! the reason is kept for the console. Time is a call: the 50 Hz tick is the
//! only clock, so pace cannot depend on how busy the processor is.

use lizard_avr::mul_unsigned;

use crate::clearance::Clearance;
use crate::gait::{Gait, GaitId};
use crate::hazard::Hazard;
use crate::pose::{Pose, Pulses};
use crate::stroke::Stroke;

/// Full pace; also the most that a pace may be.
const FULL: u16 = 1024;

/// A motion gathers or loses all its pace in seven frames, 0.14 s. In an odd
/// number of steps a gait goes a whole number of its frames meanwhile, so that
/// at full pace the frames meet the corners between its moves: half a frame
/// beside them, two legs would move at once there, and cost crawl 1.2 %.
const PACE_STEP: u16 = FULL.div_ceil(7);

/// Servos wake one after the other, 0.1 s apart, to spare the supply.
const WAKE_APART: u8 = 5;

/// All four are awake, and motion may begin.
const AWAKE: u8 = 4 * WAKE_APART;

/// What a person asked the robot to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Activity {
    /// Do a gait (`stand` is one).
    Gait(GaitId),
    /// Go to a pose and stay.
    Pose,
    /// Stay where it was stopped, by `stop` or by the guard.
    Stop,
    /// No pulses: the servos are limp.
    Rest,
}

/// What the servos follow at the moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Path {
    /// The last pose.
    Hold,
    /// The stroke; at its end the pose is held.
    StrokeToPose,
    /// The stroke; at its end the gait begins.
    StrokeToGait,
    /// The gait.
    Gait,
}

/// Where to go next, once the present motion has lost its pace.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Goal {
    None,
    /// The gait.
    Gait(GaitId),
    /// The pose that is wished for.
    Wish,
}

/// The robot's motion.
#[derive(Debug)]
pub struct Motion {
    activity: Activity,
    path: Path,
    stroke: Stroke,
    goal: Goal,
    wish: Pose,
    target: Pose,
    gait: Gait,
    phase: u32,
    pace: u16,
    speed: u8,
    waking: u8,
    pose: Pose,
    hazard: Option<Hazard>,
    frames: u32,
}

impl Motion {
    /// The robot at power-on: waking, then standing.
    pub fn new() -> Self {
        Self {
            activity: Activity::Gait(GaitId::STAND),
            path: Path::Gait,
            stroke: Stroke::default(),
            goal: Goal::None,
            wish: Pose::NEUTRAL,
            target: Pose::NEUTRAL,
            gait: GaitId::STAND.load(),
            phase: 0,
            pace: 0,
            speed: 100,
            waking: 0,
            pose: Pose::NEUTRAL,
            hazard: None,
            frames: 0,
        }
    }

    /// Begins a gait, by way of its first pose. The gait that is already under
    /// way just goes on.
    pub fn gait(&mut self, gait: GaitId) {
        let same = self.activity == Activity::Gait(gait);
        if self.activity == Activity::Rest {
            self.waking = 0;
        }
        self.activity = Activity::Gait(gait);
        if !same {
            self.goal = Goal::Gait(gait);
        }
    }

    /// Goes to a pose; or says what is wrong with it, and changes nothing.
    pub fn pose_to(&mut self, pose: &Pose) -> Result<(), Hazard> {
        match Clearance::of(pose).hazard() {
            Some(hazard) => Err(hazard),
            None => {
                self.activity = Activity::Pose;
                self.goal = Goal::Wish;
                self.wish = *pose;
                Ok(())
            }
        }
    }

    /// Freezes the pose in the next frame.
    pub fn stop(&mut self) {
        self.freeze(Activity::Stop);
    }

    /// Ends the pulses with the next frame.
    pub fn rest(&mut self) {
        self.freeze(Activity::Rest);
    }

    /// Sets the pace of gaits, in percent of their own, 10..=100.
    pub fn set_speed(&mut self, percent: u8) {
        self.speed = percent;
    }

    /// One frame on: the pulses to send in it.
    pub fn tick(&mut self) -> Pulses {
        self.frames = self.frames.wrapping_add(1);
        if self.activity == Activity::Rest {
            return Pulses::default();
        }
        if self.waking < AWAKE {
            self.waking += 1;
        } else {
            self.proceed();
        }
        let mut pulses = self.pose.pulses();
        let mut wakes_at = WAKE_APART;
        for width in &mut pulses.0 {
            if self.waking < wakes_at {
                *width = 0;
            }
            wakes_at += WAKE_APART;
        }
        pulses
    }

    /// What the robot is doing, or on its way to do.
    pub const fn activity(&self) -> Activity {
        self.activity
    }

    /// Phase of the gait, 1/2^24 cycle.
    pub const fn phase(&self) -> u32 {
        self.phase
    }

    /// The pose of the last frame.
    pub const fn pose(&self) -> &Pose {
        &self.pose
    }

    /// Speed of gaits in percent.
    pub const fn speed(&self) -> u8 {
        self.speed
    }

    /// Frames since power-on.
    pub const fn frames(&self) -> u32 {
        self.frames
    }

    /// Why the guard stopped the robot, until the next motion begins.
    pub const fn hazard(&self) -> Option<Hazard> {
        self.hazard
    }

    // Out of line, as three short calls: a tenth of a kilobyte of flash.
    #[inline(never)]
    fn freeze(&mut self, activity: Activity) {
        self.activity = activity;
        self.path = Path::Hold;
        self.goal = Goal::None;
        self.pace = 0;
        self.phase = 0;
    }

    // Out of line: in `tick` it costs more registers than it saves calls.
    #[inline(never)]
    fn proceed(&mut self) {
        self.turn_to_goal();
        self.change_pace();
        let mut phase = 0;
        let pose = match self.path {
            Path::Hold => return,
            Path::StrokeToPose | Path::StrokeToGait => {
                self.stroke.advance(self.pace);
                self.stroke.pose(&self.target)
            }
            Path::Gait => {
                phase = self.gait.advance(self.phase, self.pace);
                self.gait.pose(phase)
            }
        };
        if let Some(hazard) = Clearance::of(&pose).hazard() {
            self.freeze(Activity::Stop);
            self.hazard = Some(hazard);
            return;
        }
        self.phase = phase;
        self.pose = pose;
        self.arrive();
    }

    /// Starts the stroke towards the goal once the old motion has no pace.
    fn turn_to_goal(&mut self) {
        if self.path != Path::Hold && self.pace > 0 {
            return;
        }
        match self.goal {
            Goal::None => return,
            Goal::Wish => {
                self.path = Path::StrokeToPose;
                self.target = self.wish;
            }
            Goal::Gait(gait) => {
                self.path = Path::StrokeToGait;
                self.gait = gait.load();
                self.target = self.gait.pose(0);
            }
        }
        self.stroke = Stroke::new(&self.pose, &self.target);
        self.goal = Goal::None;
        self.hazard = None;
        self.phase = 0;
        self.pace = FULL;
    }

    /// At the end of a stroke: the gait that it led to, or rest in the pose.
    fn arrive(&mut self) {
        let next = match self.path {
            Path::StrokeToPose => Path::Hold,
            Path::StrokeToGait => Path::Gait,
            Path::Hold | Path::Gait => return,
        };
        if self.stroke.arrived() {
            self.path = next;
            self.pace = 0;
        }
    }

    fn change_pace(&mut self) {
        let wanted = match self.path {
            _ if self.goal != Goal::None => 0,
            Path::Gait => pace_of(self.speed),
            Path::Hold | Path::StrokeToPose | Path::StrokeToGait => FULL,
        };
        let slowest = self.pace.saturating_sub(PACE_STEP);
        let fastest = self.pace + PACE_STEP;
        self.pace = wanted.max(slowest).min(fastest);
    }
}

/// Percent as a pace, to nearest, so that the slowest is within half a percent
/// of itself: 2622/256 is 1024/100 to four digits.
fn pace_of(percent: u8) -> u16 {
    ((mul_unsigned(u16::from(percent), 2622) + 128) >> 8) as u16
}

impl Default for Motion {
    fn default() -> Self {
        Self::new()
    }
}
