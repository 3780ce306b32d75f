//! A round of a routine: its duration and its displacement.
//!
//! The changes from one gait to the next also take time and move the robot. Therefore the firmware's core runs the
//! routine frame by frame, and the contact model computes the displacement from the poses.

use lizard_contact::{Prediction, Travel, Walker};
use lizard_core::virtual_board::RunningRobot;

use crate::config::servo::FORWARD_TURN_SIGN;
use crate::gaits::Routine;
use crate::robot::Robot;
use crate::units::{FRAMES_PER_SECOND, STEPS_PER_DEGREE};

/// A row of the routine table: the size of a routine, and the duration and displacement of a round.
#[derive(Debug, Clone, PartialEq)]
pub struct RoutineRow {
    /// The routine's name in robot.toml.
    pub name: String,
    /// The number of steps.
    pub step_count: usize,
    /// The number of rounds; `None` if the routine repeats for ever.
    pub round_count: Option<u16>,
    /// True if an input may end a step.
    pub has_inputs: bool,
    /// Duration of a round that starts from standing, at full speed, s.
    pub seconds: f64,
    /// Displacement over a round with ideal servos, according to the contact model. A component is `None` if it depends
    /// on differences between the pads that cannot be measured.
    pub movement: Prediction,
    /// Displacement over a round with the servos' limited torque and speed. The same components are `None` as in
    /// `movement`.
    pub movement_with_servos: Prediction,
}

impl RoutineRow {
    /// Simulates one round of a routine with all inputs open ([`Robot::without_contacts`]). The computing time is
    /// proportional to the routine's length.
    pub fn simulate(robot: &Robot, routine: &Routine) -> Self {
        let mut sweeps: Vec<[f64; 4]> = vec![[0.0; 4]];
        sweeps.extend(Self::simulate_sweeps(robot, routine));
        let seconds = (sweeps.len() - 1) as f64 / FRAMES_PER_SECOND;
        // The undetermined components depend only on the pads, so rigid legs suffice to find them.
        let rigid_ground = robot.ground().with_rigid_drive();
        let prediction = rigid_ground.predict(sweeps.iter().copied());
        let movement_with_servos = prediction.keep_determined(drive_servos(robot, &sweeps));
        let movement = prediction.keep_determined(robot.ground().compute_travel(sweeps));
        Self {
            name: routine.name().to_string(),
            step_count: routine.step_count(),
            round_count: routine.round_count(),
            has_inputs: routine.has_inputs(),
            seconds,
            movement,
            movement_with_servos,
        }
    }

    /// Simulates the legs' sweeps in each frame of a round that starts from standing, deg, positive if the foot is
    /// forward.
    pub fn simulate_sweeps(robot: &Robot, routine: &Routine) -> impl Iterator<Item = [f64; 4]> {
        let mut running = RunningRobot::power_on(*robot.without_contacts().firmware());
        running.run_frames(STANDING_FRAMES);
        running.send_line(&format!("{} 1", routine.command()));
        let mut is_done = false;
        std::iter::from_fn(move || {
            if is_done {
                return None;
            }
            is_done = running.run_frames(1).iter().any(|line| line == "# done");
            let pose = running.motion().pose().0;
            Some(std::array::from_fn(|servo| {
                FORWARD_TURN_SIGN[servo] * f64::from(pose[servo].0) / STEPS_PER_DEGREE
            }))
        })
    }
}

/// Simulates the robot's servos as they follow one set of sweeps (deg) per frame, until they are at rest.
fn drive_servos(robot: &Robot, sweeps: &[[f64; 4]]) -> Travel {
    let motors = robot.motors();
    let start_sweeps = sweeps[0];
    let end_sweeps = sweeps.last().copied().unwrap_or(start_sweeps);
    let mut walker = Walker::new(*robot.ground(), start_sweeps);
    for sweeps in sweeps[1..].iter().chain(&[end_sweeps; SETTLING_FRAMES]) {
        walker.run_motors(sweeps.map(Some), 1.0 / FRAMES_PER_SECOND, &motors);
    }
    walker.body_pose().travel()
}

/// Number of frames after the last sweeps in which every servo comes to rest.
const SETTLING_FRAMES: usize = 25;
/// Number of frames after power-on in which the robot stands up.
const STANDING_FRAMES: u32 = 60;
