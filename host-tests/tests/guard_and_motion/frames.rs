//! A robot that the tests command through its console, and the checks of every frame that it sends.

use std::collections::BTreeMap;
use std::sync::Mutex;

use fastrand::Rng;
use lizard_core::motion::{Activity, Motion};
use lizard_core::numbers::gaits::GaitId;
use lizard_core::numbers::pose::{Pose, Pulses};
use lizard_core::numbers::units::CYCLE;
use lizard_core::virtual_board::RunningRobot;
use lizard_host_tests::Named;
use lizard_robot::{CheckedGait, Robot};

use crate::truth::{Verdict, angles, is_safe, pose_within};

/// Frames until all servos are awake.
pub const WAKING_FRAMES: u32 = 20;

/// The speed of one angle step per frame, deg/s.
pub const STEP_PER_FRAME: f64 = 50.0 * 360.0 / 65536.0;

/// Number of frames in which a motion accelerates to its pace, or brakes.
const ACCELERATION_FRAMES: f64 = 7.0;

/// Largest rounding error of a change of speed, in angle steps per frame.
const ROUNDING: f64 = 4.0;

/// Returns the largest allowed change of a servo's speed from one frame to the next, deg/s. `stop`, `rest`
/// and the guard are exempt, since they stop a servo at once.
///
/// A point-to-point move changes speed most at the start and the end of the shortest move, of
/// eight frames: by `6 distance / 8^2` per frame, at a mean speed of 2/3 of the slew limit. That
/// is half the slew limit, also where one move ends and the next turns the servo straight back. A gait
/// changes the servos' speeds by its waveforms, and gaining or losing pace adds to these changes.
///
/// The value is computed once for each robot and cached by the hash of the robot's numbers.
pub fn max_speed_change(robot: &Robot) -> f64 {
    static KNOWN: Mutex<BTreeMap<u32, f64>> = Mutex::new(BTreeMap::new());
    let mut known = KNOWN.lock().expect("no test fails in here");
    *known
        .entry(robot.firmware().hash())
        .or_insert_with(|| compute_max_speed_change(robot))
}

fn compute_max_speed_change(robot: &Robot) -> f64 {
    let move_change = robot.speed_limits().slew / 2.0;
    let gaits = GaitId::all(robot.gaits().len()).map(|id| {
        let (speed, change) = max_speed_and_change(robot, id);
        change.max(speed / ACCELERATION_FRAMES + robot.speed_limits().slew / 4.0)
            + speed / ACCELERATION_FRAMES
    });
    gaits.fold(move_change, f64::max) + ROUNDING * STEP_PER_FRAME
}

/// Returns the largest servo speed in a gait at full pace, and the largest change of that speed from one
/// frame to the next, deg/s.
fn max_speed_and_change(robot: &Robot, id: GaitId) -> (f64, f64) {
    let firmware = robot.firmware();
    let gait = firmware.gait(id);
    let sweeps_at = |phase: u32| {
        gait.pose(firmware.waves(), phase % CYCLE)
            .0
            .map(|sweep| f64::from(sweep.0))
    };
    let frame = gait.increment.unsigned_abs();
    let (mut speed, mut change) = (0.0f64, 0.0f64);
    for phase in (0..CYCLE).step_by(CYCLE as usize / 4096) {
        let [a, b, c] = [phase, phase + frame, phase + 2 * frame].map(sweeps_at);
        for servo in 0..4 {
            speed = speed.max((b[servo] - a[servo]).abs());
            change = change.max((c[servo] - 2.0 * b[servo] + a[servo]).abs());
        }
    }
    (speed * STEP_PER_FRAME, change * STEP_PER_FRAME)
}

/// Returns an upper bound of the frames that any command takes: for waking, braking, the longest move at the
/// slew limit, and gaining pace.
pub fn settling_frames(robot: &Robot) -> u32 {
    let travels = robot.firmware().calibration();
    let ranges = travels.map(|servo| f64::from(servo.travel_max.0) - f64::from(servo.travel_min.0));
    let farthest = ranges.into_iter().fold(0.0, f64::max);
    let frames = 1.5 * farthest * STEP_PER_FRAME / robot.speed_limits().slew;
    WAKING_FRAMES + 30 + (1.05 * frames) as u32
}

/// A robot each frame of which is checked when it is sent.
pub struct CheckedRobot<'a> {
    name: &'a str,
    robot: &'a Robot,
    running: RunningRobot,
    /// Speed of each servo in the last frame, deg/s.
    speeds: [f64; 4],
    /// True if the servos may stop at once in the next frame.
    may_stop: bool,
    allowed_speed_change: f64,
    /// The largest change of speed so far, deg/s.
    pub largest_speed_change: f64,
}

impl<'a> CheckedRobot<'a> {
    /// Powers a robot on and discards its banner.
    pub fn new(Named { name, robot }: &'a Named) -> Self {
        let mut walker = Self {
            name,
            robot,
            running: RunningRobot::power_on(*robot.firmware()),
            speeds: [0.0; 4],
            may_stop: false,
            allowed_speed_change: max_speed_change(robot),
            largest_speed_change: 0.0,
        };
        walker.take_output_lines();
        walker
    }

    /// Returns a robot that is awake and stands.
    pub fn standing(named: &'a Named) -> Self {
        let mut walker = Self::new(named);
        walker.run_frames(WAKING_FRAMES + 1);
        walker
    }

    pub fn motion(&self) -> &Motion {
        self.running.motion()
    }

    pub fn pose(&self) -> Pose {
        *self.motion().pose()
    }

    /// Reads all output of the console.
    pub fn take_output_lines(&mut self) -> Vec<String> {
        self.running.read_lines()
    }

    /// Types a line; returns its answer.
    pub fn say(&mut self, line: &str) -> String {
        let answer = self.running.send_line(line);
        if ["stop", "rest"].contains(&line) {
            self.may_stop = true;
        }
        answer
    }

    /// Types a line that must be accepted.
    pub fn expect_ok(&mut self, line: &str) {
        let answer = self.say(line);
        assert!(answer.starts_with("ok"), "{}: {line}: {answer}", self.name);
    }

    /// Moves to a pose; false if the guard stops the robot on the path.
    pub fn move_to(&mut self, pose: &Pose) -> bool {
        self.expect_ok(&self.pose_command(pose));
        self.run_frames(settling_frames(self.robot));
        self.motion().hazard().is_none()
    }

    /// Returns the command for a pose. The console's hundredths of a degree select the pose's angle step of
    /// 1/65536 turn or a neighbour of that step.
    pub fn pose_command(&self, pose: &Pose) -> String {
        pose_command(angles(self.robot.firmware(), pose))
    }

    /// Runs a number of frames.
    pub fn run_frames(&mut self, frames: u32) {
        for _ in 0..frames {
            self.run_frame();
        }
    }

    /// Runs a frame and checks its safety, its pulses and the servos' speeds.
    pub fn run_frame(&mut self) -> Pulses {
        let (name, robot) = (self.name, self.robot);
        let previous_pose = self.pose();
        let was_held = self.motion().hazard().is_some();
        self.running.run_frame();
        let pulses = self.running.board.submitted_pulses();
        let (pose, motion) = (self.pose(), self.running.motion());

        let guard_stopped = !was_held && motion.hazard().is_some();
        if guard_stopped {
            assert_eq!(
                pose, previous_pose,
                "{name}: the guard holds the last safe pose"
            );
        }
        let chassis_angles = angles(robot.firmware(), &pose);
        assert!(
            is_safe(robot.firmware(), &pose),
            "{name}: {chassis_angles:?}"
        );
        assert_ne!(
            Verdict::of(robot, chassis_angles),
            Verdict::Unsafe,
            "{name}: {chassis_angles:?}"
        );
        self.check_pulses(&pose, pulses);

        // During a move, the phase is 0. In a gait, the phase is 0 only once per cycle.
        let is_in_gait = motion.phase() != 0;
        let speed_limit = if is_in_gait {
            robot.speed_limits().gait_slew
        } else {
            robot.speed_limits().slew
        };
        // The poses of a gait are rounded, which may add a step.
        let fastest_speed = f64::from(previous_pose.largest_turn_to(&pose)) * STEP_PER_FRAME;
        let max_speed = speed_limit + if is_in_gait { STEP_PER_FRAME } else { 0.0 };
        assert!(
            fastest_speed <= max_speed + 1e-6,
            "{name}: {fastest_speed} deg/s, limit {speed_limit}"
        );

        let speeds: [f64; 4] = std::array::from_fn(|n| {
            (f64::from(pose.0[n].0) - f64::from(previous_pose.0[n].0)) * STEP_PER_FRAME
        });
        for (speed, last_speed) in speeds.iter().zip(&self.speeds) {
            let change = (speed - last_speed).abs();
            if !(self.may_stop || guard_stopped) {
                assert!(
                    change <= self.allowed_speed_change,
                    "{name}: {last_speed} and then {speed} deg/s"
                );
                self.largest_speed_change = self.largest_speed_change.max(change);
            }
        }
        self.speeds = speeds;
        self.may_stop = false;
        pulses
    }

    /// Checks that the pulses are those that robot.toml gives for the pose, within each servo's travel.
    fn check_pulses(&self, pose: &Pose, pulses: Pulses) {
        for (n, (servo, width)) in self.robot.servos().iter().zip(pulses.0).enumerate() {
            if width.0 == 0 {
                continue;
            }
            let sweep = f64::from(pose.0[n].0) * 360.0 / 65536.0;
            let expected = 16.0 * (servo.neutral_us + servo.us_per_degree * sweep);
            let error = f64::from(width.0) - expected;
            // Neutral and product are rounded to half a cycle each, and half a step of the gain
            // is one cycle at a sweep of half a turn.
            assert!(
                error.abs() <= 2.0,
                "{}: A{} is {error} cycles off",
                self.name,
                n + 1
            );
            let us = f64::from(width.0) / 16.0;
            let travel = servo.min_us - 0.13..=servo.max_us + 0.13;
            assert!(
                travel.contains(&us),
                "{}: A{} gets {us} us",
                self.name,
                n + 1
            );
        }
    }
}

/// Returns the command for a pose by its angles in the chassis frame, deg.
pub fn pose_command(angles: [f64; 4]) -> String {
    let [a1, a2, a3, a4] = angles;
    format!("pose {a1:.2} {a2:.2} {a3:.2} {a4:.2}")
}

/// Returns the command that starts a gait.
pub fn gait_command(gait: &CheckedGait) -> String {
    gait.name().replace('-', " ")
}

/// Returns a random command that moves a robot, stops it or sets its speed.
pub fn random_command(rng: &mut Rng, robot: &Robot) -> String {
    let pose_line = |rng: &mut Rng, share: f64| {
        let firmware = robot.firmware();
        let pose = pose_within(rng, &firmware.calibration(), share);
        pose_command(angles(firmware, &pose))
    };
    match rng.u8(..20) {
        0..9 => gait_command(&robot.gaits()[rng.usize(..robot.gaits().len())]),
        9..13 => pose_line(rng, 0.25),
        13..15 => pose_line(rng, 0.8),
        15 => "stop".into(),
        16 => ["rest", "stand"][rng.usize(..2)].into(),
        17 => "stand".into(),
        _ => format!("speed {}", rng.u8(10..=100)),
    }
}

/// Returns the robot's activity once a command is complete; `None` for a command that selects no activity.
pub fn final_activity(robot: &Robot, command: &str) -> Option<Activity> {
    let gait_index = robot
        .gaits()
        .iter()
        .position(|gait| gait_command(gait) == command);
    let activity_of = |index: usize| {
        GaitId::all(robot.gaits().len())
            .nth(index)
            .map(Activity::Gait)
    };
    match command {
        "stop" => Some(Activity::Stop),
        "rest" => Some(Activity::Rest),
        _ if command.starts_with("pose") => Some(Activity::Pose),
        _ => gait_index.and_then(activity_of),
    }
}
