//! The map of singularities of an end: the plane of its two crank angles, the margin at every point, and the curves on
//! which the margin is zero.

use lizard_kinematics::{Check, End, Pose, SingularPose, Singularity};
use lizard_robot::Robot;
use serde::Serialize;
use tsify::Tsify;

/// Distance between adjacent points of the map, deg.
const GRID_STEP_DEG: f64 = 1.5;
/// Smallest angle of either crank on the map: a change point of the leg's four-bar.
const MIN_ANGLE_DEG: f64 = 0.0;
/// Largest angle of either crank on the map: the other change point.
const MAX_ANGLE_DEG: f64 = 180.0;
/// Step of the left crank's angle along a curve.
const CURVE_STEP_DEG: f64 = 0.5;

/// A point of the map: the angles of the two cranks in the end's own frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Tsify)]
pub struct MapPoint(
    /// Angle of the left crank, deg.
    pub f64,
    /// Angle of the right crank, deg.
    pub f64,
);

/// The singular poses of one kind.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct Curve {
    /// Name of the collinear links.
    pub kind: &'static str,
    /// The poses, in no particular order.
    pub points: Vec<MapPoint>,
}

/// The map of singularities of an end.
#[derive(Clone, Debug, PartialEq, Serialize, Tsify)]
pub struct SingularityMap {
    /// Smallest angle of either crank, deg.
    pub min_angle: f64,
    /// Largest angle of either crank, deg.
    pub max_angle: f64,
    /// Number of columns, and of rows; the first column and the first row are at `min_angle`.
    pub size: usize,
    /// Smallest margin at each point, in hundredths, column by column: for each left crank angle, all right crank
    /// angles. `None` if the loop does not close.
    pub margins: Vec<Option<i8>>,
    /// True at points that the limits allow, in the order of `margins`.
    pub safe: Vec<bool>,
    /// The singular poses.
    pub curves: Vec<Curve>,
}

impl SingularityMap {
    /// Computes the map of an end.
    pub fn compute(robot: &Robot, end: End) -> Self {
        let size = ((MAX_ANGLE_DEG - MIN_ANGLE_DEG) / GRID_STEP_DEG) as usize + 1;
        let angle_at = |i: usize| MIN_ANGLE_DEG + GRID_STEP_DEG * i as f64;
        let points = (0..size).flat_map(|left| (0..size).map(move |right| (left, right)));
        let (margins, safe) = points
            .map(|(left, right)| evaluate_point(robot, end, angle_at(left), angle_at(right)))
            .unzip();
        Self {
            min_angle: MIN_ANGLE_DEG,
            max_angle: MAX_ANGLE_DEG,
            size,
            margins,
            safe,
            curves: find_curves(robot, end),
        }
    }
}

/// Returns an end's smallest margin, in hundredths, at its crank angles, deg, and true if the limits allow the angles.
fn evaluate_point(robot: &Robot, end: End, left: f64, right: f64) -> (Option<i8>, bool) {
    let Ok(five_bar_pose) = robot.lizard().end(end).forward(left, right) else {
        return (None, false);
    };
    let margins = five_bar_pose.conditions(end).into_iter();
    let smallest_margin = margins
        .filter(|(check, _)| !Check::UNCROSSED.contains(check))
        .fold(1.0f64, |smallest, (_, value)| smallest.min(value));
    let mut violations = robot.limits().end_violations(end, &five_bar_pose);
    let is_safe = violations.next().is_none();
    (Some((smallest_margin * 100.0).round() as i8), is_safe)
}

/// Finds the singular poses of an end on the map.
fn find_curves(robot: &Robot, end: End) -> Vec<Curve> {
    let five_bar = robot.lizard().end(end);
    let step_count = ((MAX_ANGLE_DEG - MIN_ANGLE_DEG) / CURVE_STEP_DEG) as usize;
    let poses: Vec<SingularPose> = (0..=step_count)
        .flat_map(|i| five_bar.find_singular_poses(MIN_ANGLE_DEG + CURVE_STEP_DEG * i as f64))
        .chain(five_bar.find_coinciding_tip_poses())
        .filter(|pose| {
            let is_inside = |theta: f64| (MIN_ANGLE_DEG..=MAX_ANGLE_DEG).contains(&theta);
            is_inside(pose.theta_left) && is_inside(pose.theta_right)
        })
        .collect();
    let kinds = [
        (Singularity::Couplers, "couplers"),
        (Singularity::LeftArm, "left arm"),
        (Singularity::RightArm, "right arm"),
    ];
    let curves = kinds.map(|(kind, name)| {
        let poses = poses.iter().filter(|pose| pose.kind == kind);
        let points = poses.map(|pose| MapPoint(pose.theta_left, pose.theta_right));
        Curve {
            kind: name,
            points: points.collect(),
        }
    });
    curves.into()
}

/// Returns a pose's point on the map of an end: the angles of left and right crank, deg, 0 to 360.
pub fn to_map_point(end: End, pose: &Pose) -> MapPoint {
    let angles: [f64; 4] = (*pose).into();
    let angles = end.pick(angles);
    let [left, right] = angles.map(|theta| end.mirror_angle(theta).rem_euclid(360.0));
    MapPoint(left, right)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_maps_show_the_neutral_pose_as_safe_and_coinciding_tips_as_unsafe() {
        let robot = crate::paper::load_paper_robot();
        for end in End::ALL {
            let map = SingularityMap::compute(&robot, end);
            let index_at = |MapPoint(left, right): MapPoint| {
                let grid_index =
                    |theta: f64| ((theta - map.min_angle) / GRID_STEP_DEG).round() as usize;
                grid_index(left) * map.size + grid_index(right)
            };
            let neutral_point = to_map_point(end, &robot.neutral_pose());
            let MapPoint(left, right) = neutral_point;
            assert!((left - 138.59).abs() < 0.01, "{neutral_point:?}");
            assert!((right - 41.41).abs() < 0.01, "{neutral_point:?}");
            let neutral_index = index_at(neutral_point);
            assert!(map.safe[neutral_index]);
            assert!(map.margins[neutral_index] > Some(60));
            assert!(!map.safe[index_at(MapPoint(70.5, 109.5))]);
            let couplers = &map.curves[0].points;
            assert!(
                couplers.iter().any(|point| (point.0 - 70.529).abs() < 0.01),
                "{couplers:?}"
            );
            assert!(map.curves[1].points.len() > 50 && map.curves[2].points.len() > 50);
        }
    }
}
