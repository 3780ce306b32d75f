//! The workspace of head and tail: the part of the plane in which the user can draw a path of the end point.
//!
//! The other end is at neutral. A point is allowed if the inverse kinematics has a solution there and the limits allow
//! the solution's pose.

use std::ops::RangeInclusive;

use lizard_kinematics::{End, Vector, wrap};
use lizard_robot::Robot;
use serde::Serialize;
use tsify::Tsify;

/// Number of grid steps across the plane, whose width is twice the longest reach.
const STEPS_ACROSS: i32 = 160;
/// Width of the rim around the allowed points, in grid points.
const RIM_WIDTH: i32 = 2;
/// Largest distance between two points that count as equal, mm.
const POINT_TOLERANCE_MM: f64 = 1e-6;

/// The workspace of an end point as a grid, mm in the end's own frame. The frame's origin is the middle of the end's
/// base, and its y axis points outward.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct Workspace {
    /// First point of the first row.
    pub first_point: [f64; 2],
    /// Distance between neighbouring points, mm.
    pub spacing: f64,
    /// Number of points in a row.
    pub columns: usize,
    /// True at allowed points, row by row.
    pub allowed: Vec<bool>,
    /// End point in the neutral pose.
    pub neutral: [f64; 2],
    /// Shafts of the two cranks.
    pub shafts: [[f64; 2]; 2],
}

impl Workspace {
    /// Computes the workspace of the end point of head or tail.
    pub fn compute(robot: &Robot, end: End) -> Self {
        let five_bar = robot.lizard().end(end);
        let half_base = five_bar.base / 2.0;
        let crank_length = five_bar.left_crank_length.max(five_bar.right_crank_length);
        let coupler_length = five_bar
            .left_coupler_length
            .max(five_bar.right_coupler_length);
        let reach = half_base + crank_length + coupler_length;
        let spacing = 2.0 * reach / f64::from(STEPS_ACROSS);
        let point_at =
            |column: i32, row: i32| [f64::from(column) * spacing, f64::from(row) * spacing];
        let indices = -(STEPS_ACROSS / 2)..=STEPS_ACROSS / 2;
        // Returns row and column of each point, in ascending order.
        let points_in = |rows: &RangeInclusive<i32>, columns: &RangeInclusive<i32>| {
            let columns = columns.clone();
            let points_of_row = move |row| columns.clone().map(move |column| (row, column));
            rows.clone().flat_map(points_of_row)
        };
        let allowed_points: Vec<(i32, i32)> = points_in(&indices, &indices)
            .filter(|(row, column)| is_point_allowed(robot, end, point_at(*column, *row)))
            .collect();
        // Returns the range of rows or columns with allowed points, with the rim on both sides.
        let find_range_with_rim = |to_index: fn(&(i32, i32)) -> i32| {
            let allowed_indices = allowed_points.iter().map(to_index);
            let smallest = allowed_indices.clone().min().unwrap_or(0);
            (smallest - RIM_WIDTH)..=(allowed_indices.max().unwrap_or(0) + RIM_WIDTH)
        };
        let rows = find_range_with_rim(|(row, _)| *row);
        let columns = find_range_with_rim(|(_, column)| *column);
        let is_allowed = |point: (i32, i32)| allowed_points.binary_search(&point).is_ok();
        let allowed = points_in(&rows, &columns).map(is_allowed);
        Self {
            first_point: point_at(*columns.start(), *rows.start()),
            spacing,
            columns: columns.clone().count(),
            allowed: allowed.collect(),
            neutral: compute_neutral_point(robot, end),
            shafts: [[-half_base, 0.0], [half_base, 0.0]],
        }
    }
}

/// Returns the end point of head or tail in the neutral pose, mm, in the end's own frame; the origin if that pose has
/// no solution.
pub fn compute_neutral_point(robot: &Robot, end: End) -> [f64; 2] {
    let solution = robot.lizard().solve(&robot.neutral_pose());
    let point = solution.map(|solution| solution.end(end).end_point);
    point.map_or([0.0; 2], |point| [point.x, point.y])
}

/// Returns true if the limits allow the pose with the end point at (`x`, `y`) and the other end at neutral.
fn is_point_allowed(robot: &Robot, end: End, [x, y]: [f64; 2]) -> bool {
    let Ok(crank_angles) = robot.lizard().point_angles(end, Vector::new(x, y)) else {
        return false;
    };
    let mut angles: [f64; 4] = robot.neutral_pose().into();
    for servo in end.servos() {
        angles[servo] += wrap(crank_angles[servo % 2] - angles[servo]);
    }
    // In the robot's assembly mode, these crank angles may put the end point elsewhere.
    robot.solve_if_allowed(angles).is_some_and(|solution| {
        let end_point = solution.end(end).end_point;
        (end_point.x - x).hypot(end_point.y - y) < POINT_TOLERANCE_MM
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_workspace_contains_the_neutral_point_and_no_points_out_of_reach() {
        let robot = crate::paper::load_paper_robot();
        for end in End::ALL {
            let workspace = Workspace::compute(&robot, end);
            let is_allowed_at = |[x, y]: [f64; 2]| {
                let [first_x, first_y] = workspace.first_point;
                let column = ((x - first_x) / workspace.spacing).round() as usize;
                let row = ((y - first_y) / workspace.spacing).round() as usize;
                workspace.allowed[row * workspace.columns + column]
            };
            assert!(is_allowed_at(workspace.neutral), "{end}");
            assert_eq!(workspace.allowed.len() % workspace.columns, 0);
            // The first row belongs to the rim of forbidden points, which makes the workspace's edge visible.
            let first_row = &workspace.allowed[..workspace.columns];
            assert!(first_row.iter().all(|allowed| !allowed));
            // The gesture `look` stays in the workspace: 10 mm to either side of 54 mm outward.
            for x in [-10.0, 0.0, 10.0] {
                assert!(is_allowed_at([x, 54.0]), "{end} {x}");
            }
        }
    }
}
