//! A quick check at a few poses before the proof.
//!
//! In a robot that does not fit, hundreds of pairs of parts may collide, and bounding all distances takes minutes. Yet
//! one pose at which two parts collide is enough to refuse the robot. The parts are therefore first checked at poses
//! where collisions are likely: at neutral, on a coarse grid, and at the guard's limits in every direction from
//! neutral. If some pairs are too close at these poses, the proof bounds only the worst of them.

use lizard_kinematics::Solution;
use lizard_robot::Robot;

use super::shape_pairs::Task;
use crate::bodies::assembly::Assembly;

/// Number of angles per servo on the coarse grid.
const GRID_ANGLES_PER_SERVO: u32 = 6;
/// Number of directions from neutral: each of the four servos turns in one of three ways.
const DIRECTION_COUNT: u32 = 3_u32.pow(4);
/// Number of halvings in the search for a limit of the guard.
const HALVING_COUNT: usize = 12;
/// Largest number of tasks that the proof bounds if the quick check finds collisions.
const MAX_WORST_TASKS: usize = 3;

/// Finds the tasks whose parts come too close at a checked pose, at most the [`MAX_WORST_TASKS`] closest. Returns
/// `None` if no parts come too close.
pub fn find_worst_tasks(assembly: &Assembly, tasks: &[Task]) -> Option<Vec<Task>> {
    let robot = assembly.robot();
    let neutral_pose = robot.solve_if_allowed(robot.neutral_pose().into());
    let mut poses = Vec::from_iter(neutral_pose);
    poses.extend(
        (0..DIRECTION_COUNT).filter_map(|direction| find_last_accepted_pose(robot, direction)),
    );
    poses.extend(assembly.grid_poses(GRID_ANGLES_PER_SERVO));
    let find_smallest_distance = |task: &Task| {
        let distance_at = |pose| measure_distance(assembly, task, pose);
        poses.iter().map(distance_at).fold(f64::INFINITY, f64::min)
    };
    let measured_tasks = tasks
        .iter()
        .map(|task| (find_smallest_distance(task), task));
    let worst_tasks = measured_tasks.filter(|(distance, task)| *distance < task.required_gap());
    let mut worst_tasks: Vec<_> = worst_tasks.collect();
    worst_tasks.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    worst_tasks.truncate(MAX_WORST_TASKS);
    let to_task = |(_, task): (f64, &Task)| task.clone();
    (!worst_tasks.is_empty()).then(|| worst_tasks.into_iter().map(to_task).collect())
}

/// Computes the smallest distance between a task's parts at a pose, mm; infinite if they are certainly far enough
/// apart.
fn measure_distance(assembly: &Assembly, task: &Task, pose: &Solution) -> f64 {
    let [a, b] = task.mounts.map(|mount| assembly.placement(mount, pose));
    let placement = b.relative_to(&a);
    let shape_pairs = task.shape_pairs.iter();
    let close_pairs =
        shape_pairs.filter(|pair| !pair.is_far(&placement, [0.0; 2], task.required_gap()));
    let distances = close_pairs.map(|pair| pair.distance(&placement));
    distances.fold(f64::INFINITY, f64::min)
}

/// Finds the last accepted pose on the line from neutral in one of [`DIRECTION_COUNT`] directions: each servo turns
/// towards one limit of its travel, towards the other limit, or not at all. `None` if the guard refuses neutral.
fn find_last_accepted_pose(robot: &Robot, direction: u32) -> Option<Solution> {
    let neutral: [f64; 4] = robot.neutral_pose().into();
    let end_offsets = [0, 1, 2, 3].map(|servo| {
        let (low, high) = robot.servos()[servo].travel();
        [low, 0.0, high][(direction / 3_u32.pow(servo as u32) % 3) as usize]
    });
    let pose_at = |fraction: f64| {
        robot.solve_if_allowed([0, 1, 2, 3].map(|i| neutral[i] + fraction * end_offsets[i]))
    };
    let (mut accepted, mut refused) = (0.0, 1.0);
    for _ in 0..HALVING_COUNT {
        let middle = (accepted + refused) / 2.0;
        match pose_at(middle) {
            Some(_) => accepted = middle,
            None => refused = middle,
        }
    }
    pose_at(accepted)
}
