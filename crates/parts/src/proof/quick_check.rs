//! A quick check at a few poses before the proof.
//!
//! In a robot that does not fit, hundreds of pairs of parts may collide, and bounding the distance of each takes
//! minutes. But one pose at which two parts collide is enough to refuse the robot. So the parts are first checked
//! at poses where collisions are likely: at neutral, on a coarse grid, and at the limits of the guard in every
//! direction from neutral. If some pairs are too near at these poses, the proof bounds only the worst of them.

use lizard_kinematics::Solution;
use lizard_robot::Robot;

use super::shape_pairs::Task;
use crate::bodies::assembly::Assembly;

/// Number of angles per servo on the coarse grid.
const GRID_ANGLES_PER_SERVO: u32 = 6;
/// Number of halvings in the search for a limit of the guard.
const HALVING_COUNT: usize = 12;
/// Largest number of tasks that the proof bounds if the quick check finds collisions.
const MAX_WORST_TASKS: usize = 3;

/// Returns at most [`MAX_WORST_TASKS`] tasks: of those whose parts come too near at a checked pose, the ones whose
/// parts come nearest. `None` if no parts come too near.
pub fn worst_tasks(assembly: &Assembly, tasks: &[Task]) -> Option<Vec<Task>> {
    let robot = assembly.robot();
    let mut poses: Vec<Solution> = robot
        .solve_if_allowed(robot.neutral_pose().into())
        .into_iter()
        .collect();
    poses.extend((0..81).filter_map(|direction| last_accepted_pose(robot, direction)));
    poses.extend(assembly.grid_poses(GRID_ANGLES_PER_SERVO));
    let least_distance_of = |task: &Task| {
        let distances = poses.iter().map(|pose| distance_at(assembly, task, pose));
        distances.fold(f64::INFINITY, f64::min)
    };
    let measured_tasks = tasks.iter().map(|task| (least_distance_of(task), task));
    let mut too_near: Vec<_> = measured_tasks
        .filter(|(mm, task)| *mm < task.min_distance())
        .collect();
    too_near.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let too_near = too_near.into_iter().take(MAX_WORST_TASKS);
    let too_near: Vec<_> = too_near.map(|(_, task)| task.clone()).collect();
    (!too_near.is_empty()).then_some(too_near)
}

/// The least distance of a task's parts at a pose, mm; infinite if they are certainly far enough apart.
fn distance_at(assembly: &Assembly, task: &Task, pose: &Solution) -> f64 {
    let [a, b] = task.mounts.map(|mount| assembly.place(mount, pose));
    let placement = b.relative_to(&a);
    let shape_pairs = task.shape_pairs.iter();
    let near_pairs =
        shape_pairs.filter(|pair| !pair.is_far(&placement, [0.0; 2], task.min_distance()));
    let distances = near_pairs.map(|pair| pair.distance(&placement));
    distances.fold(f64::INFINITY, f64::min)
}

/// The last pose that the guard accepts on the line from neutral in one of 81 directions: each servo turns toward
/// one limit of its travel, toward the other, or not at all. `None` if the guard refuses neutral.
fn last_accepted_pose(robot: &Robot, direction: u32) -> Option<Solution> {
    let neutral: [f64; 4] = robot.neutral_pose().into();
    let end_offsets = [0, 1, 2, 3].map(|servo| {
        let (low, high) = robot.servos()[servo].travel();
        [low, 0.0, high][(direction / 3_u32.pow(servo as u32) % 3) as usize]
    });
    let pose_at = |share: f64| {
        robot.solve_if_allowed([0, 1, 2, 3].map(|i| neutral[i] + share * end_offsets[i]))
    };
    let (mut accepted_share, mut refused_share) = (0.0, 1.0);
    for _ in 0..HALVING_COUNT {
        let share = (accepted_share + refused_share) / 2.0;
        match pose_at(share) {
            Some(_) => accepted_share = share,
            None => refused_share = share,
        }
    }
    pose_at(accepted_share)
}
