//! A robot that runs the core, is commanded through its console, and has each of its frames checked.

use std::collections::BTreeMap;
use std::sync::Mutex;

use fastrand::Rng;
use lizard_core::motion::{Activity, Motion};
use lizard_core::numbers::gaits::GaitId;
use lizard_core::numbers::pose::{Pose, Pulses};
use lizard_core::numbers::units::CYCLE;
use lizard_core::virtual_board::RunningRobot;
use lizard_host_tests::{CYCLES_PER_US, NamedRobot, robots};
use lizard_robot::{CheckedGait, CoreRobot, Robot};

use crate::reference::{
    chassis_angles_deg, exact_width_us, is_clearly_unsafe, is_safe, random_pose_within,
};

/// Number of frames after which all servos are awake.
const WAKING_FRAMES: u32 = 20;

/// The speed of one angle step per frame, deg/s.
pub const STEP_SPEED_DEG_PER_S: f64 = 50.0 * 360.0 / 65536.0;

/// Number of frames in which a motion accelerates to its pace, or brakes.
const ACCELERATION_FRAMES: f64 = 7.0;

/// Maximum rounding error of a speed change, angle steps per frame.
const SPEED_CHANGE_ERROR_STEPS: f64 = 4.0;

/// Returns the largest allowed change in a servo's speed from one frame to the next, deg/s. This limit does not apply
/// to `stop`, `rest` and the guard, which stop a servo at once.
///
/// Among moves to a pose, the shortest move has the largest speed change, at its start and its end. This move has eight
/// frames and a mean speed of 2/3 of the slew limit, so its speed changes by `6 distance / 8^2` per frame: half the
/// slew limit. The same holds if one move ends and the next move turns the servo back. In a gait, the waveforms change
/// the servos' speeds, and a change of pace adds to these changes.
///
/// The value is computed once for each robot and cached under the hash of the robot's numbers.
pub fn max_speed_change(robot: &Robot) -> f64 {
    static CACHE: Mutex<BTreeMap<u32, f64>> = Mutex::new(BTreeMap::new());
    let mut cache = CACHE.lock().expect("no thread has panicked");
    *cache
        .entry(robot.firmware().hash())
        .or_insert_with(|| compute_max_speed_change(robot))
}

fn compute_max_speed_change(robot: &Robot) -> f64 {
    let move_change = robot.speed_limits().slew / 2.0;
    let gaits = robot.gaits().iter();
    let gait_changes = gaits.map(|gait| compute_max_gait_change(robot, gait_id(gait)));
    gait_changes.fold(move_change, f64::max) + SPEED_CHANGE_ERROR_STEPS * STEP_SPEED_DEG_PER_S
}

/// Computes the largest allowed change in a servo's speed in a gait from one frame to the next, deg/s, from the largest
/// speed and the largest change of speed at full pace.
fn compute_max_gait_change(robot: &Robot, id: GaitId) -> f64 {
    let firmware = robot.firmware();
    let gait = firmware.gait(id);
    let sweeps_at = |phase: u32| {
        let pose = gait.pose(firmware.waves(), phase % CYCLE);
        pose.0.map(|sweep| f64::from(sweep.0))
    };
    let frame_advance = gait.increment.unsigned_abs();
    let (mut max_speed, mut max_change) = (0.0f64, 0.0f64);
    for phase in (0..CYCLE).step_by(CYCLE as usize / 4096) {
        let [first, second, third] =
            [phase, phase + frame_advance, phase + 2 * frame_advance].map(sweeps_at);
        for servo in 0..4 {
            max_speed = max_speed.max((second[servo] - first[servo]).abs());
            max_change = max_change.max((third[servo] - 2.0 * second[servo] + first[servo]).abs());
        }
    }
    let pace_change = max_speed * STEP_SPEED_DEG_PER_S / ACCELERATION_FRAMES;
    let start_change = pace_change + robot.speed_limits().slew / 4.0;
    start_change.max(max_change * STEP_SPEED_DEG_PER_S) + pace_change
}

/// Returns an upper bound of the number of frames that a command takes, which includes waking the servos, braking, the
/// longest move at the slew limit, and acceleration.
pub fn settling_frames(robot: &Robot) -> u32 {
    let calibration = robot.firmware().calibration();
    let ranges =
        calibration.map(|servo| f64::from(servo.travel_max.0) - f64::from(servo.travel_min.0));
    let largest_range = ranges.into_iter().fold(0.0, f64::max);
    let longest_move_frames =
        1.5 * largest_range * STEP_SPEED_DEG_PER_S / robot.speed_limits().slew;
    WAKING_FRAMES + 30 + (1.05 * longest_move_frames) as u32
}

/// A robot whose frames are checked when they are sent.
pub struct CheckedRobot<'a> {
    name: &'a str,
    robot: &'a Robot,
    running_robot: RunningRobot,
    /// The speed of each servo in the last frame, deg/s.
    speeds: [f64; 4],
    /// True if the servos may stop at once in the next frame, without braking.
    can_stop_at_once: bool,
    /// The largest allowed change in a servo's speed from one frame to the next, deg/s.
    max_speed_change: f64,
    /// The largest change in a servo's speed so far, deg/s.
    pub largest_speed_change: f64,
}

impl<'a> CheckedRobot<'a> {
    /// Powers on a robot and reads its banner.
    pub fn power_on(NamedRobot { name, robot }: &'a NamedRobot) -> Self {
        let mut checked_robot = Self {
            name,
            robot,
            running_robot: RunningRobot::power_on(*robot.firmware()),
            speeds: [0.0; 4],
            can_stop_at_once: false,
            max_speed_change: max_speed_change(robot),
            largest_speed_change: 0.0,
        };
        checked_robot.take_output_lines();
        checked_robot
    }

    /// Powers on a robot and waits until it stands.
    pub fn power_on_and_stand(named_robot: &'a NamedRobot) -> Self {
        let mut checked_robot = Self::power_on(named_robot);
        checked_robot.run_frames(WAKING_FRAMES + 1);
        checked_robot
    }

    pub fn motion(&self) -> &Motion {
        self.running_robot.motion()
    }

    pub fn pose(&self) -> Pose {
        *self.motion().pose()
    }

    /// Takes the lines that the console has printed since the last call.
    pub fn take_output_lines(&mut self) -> Vec<String> {
        self.running_robot.read_lines()
    }

    /// Sends a line and returns its answer.
    pub fn say(&mut self, line: &str) -> String {
        let answer = self.running_robot.send_line(line);
        if ["stop", "rest"].contains(&line) {
            self.can_stop_at_once = true;
        }
        answer
    }

    /// Sends a line and asserts that the robot accepts it.
    pub fn expect_ok(&mut self, line: &str) {
        let answer = self.say(line);
        assert!(answer.starts_with("ok"), "{}: {line}: {answer}", self.name);
    }

    /// Runs the frames of the last command. Returns false if the guard stops the robot on the path.
    pub fn settle(&mut self) -> bool {
        self.run_frames(settling_frames(self.robot));
        self.motion().hazard().is_none()
    }

    /// Commands a pose. Returns false if the robot refuses the pose, because rounding to hundredths of a degree moves
    /// it beyond a limit.
    pub fn try_pose(&mut self, pose: &Pose) -> bool {
        let answer = self.say(&pose_command(self.robot.firmware(), pose));
        answer.starts_with("ok")
    }

    pub fn run_frames(&mut self, count: u32) {
        for _ in 0..count {
            self.run_frame();
        }
    }

    /// Runs a frame, checks the safety, the pulses and the servos' speeds, and returns the pulses.
    pub fn run_frame(&mut self) -> Pulses {
        let (name, robot) = (self.name, self.robot);
        let previous_pose = self.pose();
        let was_held = self.motion().hazard().is_some();
        self.running_robot.run_frame();
        let pulses = self.running_robot.board.submitted_pulses();
        let (pose, motion) = (self.pose(), self.running_robot.motion());

        let is_stopped_by_guard = !was_held && motion.hazard().is_some();
        if is_stopped_by_guard {
            assert_eq!(
                pose, previous_pose,
                "{name}: the guard does not hold the last safe pose"
            );
        }
        let chassis_angles = chassis_angles_deg(robot.firmware(), &pose);
        let is_safe = is_safe(robot.firmware(), &pose) && !is_clearly_unsafe(robot, &pose);
        assert!(is_safe, "{name}: {chassis_angles:?}");
        self.check_pulses(&pose, pulses);

        // The phase is 0 during a move, and only once per cycle in a gait. The poses of a gait are rounded, which may
        // add a step.
        let (speed_limit, rounding) = match motion.phase() {
            0 => (robot.speed_limits().slew, 0.0),
            _ => (robot.speed_limits().gait_slew, STEP_SPEED_DEG_PER_S),
        };
        let largest_speed = f64::from(previous_pose.max_turn_to(&pose)) * STEP_SPEED_DEG_PER_S;
        assert!(
            largest_speed <= speed_limit + rounding + 1e-6,
            "{name}: {largest_speed} deg/s, limit {speed_limit}"
        );

        let speeds: [f64; 4] = std::array::from_fn(|n| {
            (f64::from(pose.0[n].0) - f64::from(previous_pose.0[n].0)) * STEP_SPEED_DEG_PER_S
        });
        for (speed, previous_speed) in speeds.iter().zip(&self.speeds) {
            let speed_change = (speed - previous_speed).abs();
            if !(self.can_stop_at_once || is_stopped_by_guard) {
                assert!(
                    speed_change <= self.max_speed_change,
                    "{name}: the speed was {previous_speed} deg/s, then {speed} deg/s"
                );
                self.largest_speed_change = self.largest_speed_change.max(speed_change);
            }
        }
        self.speeds = speeds;
        self.can_stop_at_once = false;
        pulses
    }

    /// Checks that the pulses match the pose according to robot.toml, and are within each servo's travel.
    fn check_pulses(&self, pose: &Pose, pulses: Pulses) {
        for (index, (servo, width)) in self.robot.servos().iter().zip(pulses.0).enumerate() {
            if width.0 == 0 {
                continue;
            }
            let servo_name = format!("{}: A{}", self.name, index + 1);
            let expected_cycles = CYCLES_PER_US * exact_width_us(servo, pose.0[index].0.into());
            let error_cycles = f64::from(width.0) - expected_cycles;
            // The rounding errors are half a cycle for the neutral pulse, half a cycle for the product, and one cycle
            // for the scale at a sweep of half a turn.
            assert!(
                error_cycles.abs() <= 2.0,
                "{servo_name} is {error_cycles} cycles off"
            );
            let width_us = f64::from(width.0) / CYCLES_PER_US;
            let allowed_us = servo.min_us - 0.13..=servo.max_us + 0.13;
            assert!(
                allowed_us.contains(&width_us),
                "{servo_name} gets {width_us} us"
            );
        }
    }
}

/// Returns the command for a pose. The command has hundredths of a degree, so the commanded pose may differ by one step
/// of 1/65536 turn.
fn pose_command(firmware: &CoreRobot, pose: &Pose) -> String {
    let [a1, a2, a3, a4] = chassis_angles_deg(firmware, pose);
    format!("pose {a1:.2} {a2:.2} {a3:.2} {a4:.2}")
}

/// Returns a random command that moves a robot, stops the robot or sets its speed.
pub fn random_command(rng: &mut Rng, robot: &Robot) -> String {
    let pose_line = |rng: &mut Rng, fraction: f64| {
        let firmware = robot.firmware();
        let pose = random_pose_within(rng, &firmware.calibration(), fraction);
        pose_command(firmware, &pose)
    };
    match rng.u8(..20) {
        0..9 => robot.gaits()[rng.usize(..robot.gaits().len())].command(),
        9..13 => pose_line(rng, 0.25),
        13..15 => pose_line(rng, 0.8),
        15 => "stop".into(),
        16 => ["rest", "stand"][rng.usize(..2)].into(),
        17 => "stand".into(),
        _ => format!("speed {}", rng.u8(10..=100)),
    }
}

/// Returns the robot's activity after a command is complete; `None` for a command that selects no activity.
pub fn final_activity(robot: &Robot, command: &str) -> Option<Activity> {
    match command {
        "stop" => Some(Activity::Stop),
        "rest" => Some(Activity::Rest),
        _ if command.starts_with("pose") => Some(Activity::Pose),
        _ => {
            let mut gaits = robot.gaits().iter();
            let gait = gaits.find(|gait| gait.command() == command)?;
            Some(Activity::Gait(gait_id(gait)))
        }
    }
}

/// Returns the id of a gait in the core.
pub fn gait_id(gait: &CheckedGait) -> GaitId {
    GaitId::at(gait.index() as u8)
}

/// Starts the gaits of every robot from `first_gait` on, and calls `check` once a gait runs. The path to a gait's first
/// pose may contain an unsafe pose, where the guard stops the robot; this must be rare.
pub fn check_running_gaits(
    first_gait: usize,
    mut check: impl FnMut(&NamedRobot, &CheckedGait, &mut CheckedRobot),
) {
    let (mut walked_count, mut blocked_count) = (0, 0);
    for named_robot in robots() {
        for gait in &named_robot.robot.gaits()[first_gait..] {
            let mut checked_robot = CheckedRobot::power_on_and_stand(named_robot);
            checked_robot.expect_ok(&gait.command());
            if checked_robot.settle() {
                check(named_robot, gait, &mut checked_robot);
                walked_count += 1;
            } else {
                println!(
                    "{}: the path to {} is blocked",
                    named_robot.name,
                    gait.name()
                );
                blocked_count += 1;
            }
        }
    }
    assert!(
        walked_count > 10 * blocked_count,
        "{walked_count} gaits walked, {blocked_count} blocked"
    );
}
