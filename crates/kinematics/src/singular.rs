//! The singular poses of a five-bar, as curves in the plane of its crank angles.
//!
//! The paper finds singular configurations at sin(theta2 + theta3) = 0, which holds in every symmetrical pose,
//! including the neutral one. In fact the determinant of its matrix K* is proportional to sin(theta3 - theta2). Here
//! each curve is a function of the left crank's angle: for a given left crank, intersections of two circles give the
//! singular right cranks.

use crate::angle::wrap;
use crate::five_bar::{AssemblyMode, FiveBar, FiveBarPose};
use crate::vector::Vector;

/// A kind of singularity, by the links that line up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Singularity {
    /// Type 2: the couplers lie on one line, or the crank tips coincide; the end point can move
    /// although both servos hold.
    Couplers,
    /// Type 1: left crank and coupler lie on one line; the end point cannot move along it.
    LeftArm,
    /// Type 1: right crank and coupler lie on one line; the end point cannot move along it.
    RightArm,
}

/// A singular pose of a five-bar. The crank angles are in (-180, 180] degrees, in the five-bar's own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SingularPose {
    /// The links that line up.
    pub kind: Singularity,
    /// Angle of the left crank.
    pub theta_left: f64,
    /// Angle of the right crank.
    pub theta_right: f64,
}

impl FiveBar {
    /// The singular poses with this left crank angle (degrees), in the assembly mode in which the
    /// robot is built; at most ten.
    ///
    /// Poses with coinciding crank tips are isolated points and are not included: see
    /// [`FiveBar::find_coinciding_tip_poses`].
    pub fn find_singular_poses(
        &self,
        theta_left: f64,
    ) -> impl Iterator<Item = SingularPose> + use<> {
        let five_bar = *self;
        let left = Vector::from_angle(theta_left);
        let tip = five_bar.left_shaft() + left * five_bar.left_crank_length;
        let (l2, l3) = (five_bar.left_coupler_length, five_bar.right_coupler_length);
        // Type 2: the distance between the crank tips is the sum or the difference of the couplers.
        let couplers = [l2 + l3, (l2 - l3).abs()]
            .into_iter()
            .filter(|reach| *reach > 0.0)
            .flat_map(move |reach| five_bar.right_thetas_at(tip, reach))
            .map(|theta| (Singularity::Couplers, theta));
        // Type 1, left arm: the end point is the tip of the stretched or folded arm.
        let left_arm = [l2, -l2]
            .into_iter()
            .flat_map(move |reach| five_bar.right_thetas_at(tip + left * reach, l3))
            .map(|theta| (Singularity::LeftArm, theta));
        // Type 1, right arm: the end point is on a circle about the right shaft with radius
        // right crank + l3 or |right crank - l3|.
        let right_arm = [
            five_bar.right_crank_length + l3,
            five_bar.right_crank_length - l3,
        ]
        .into_iter()
        .flat_map(move |reach| {
            circle_intersections(tip, l2, five_bar.right_shaft(), reach.abs())
                .map(move |point| (point - five_bar.right_shaft()) * (1.0 / reach))
        })
        .filter(|crank| crank.is_finite())
        .map(|crank| (Singularity::RightArm, crank.angle()));
        couplers
            .chain(left_arm)
            .chain(right_arm)
            .map(move |(kind, theta_right)| SingularPose {
                kind,
                theta_left: wrap(theta_left),
                theta_right,
            })
            .filter(move |pose| five_bar.is_singular(pose))
    }

    /// The poses in which both crank tips coincide, so that the end point is free on a circle;
    /// none if the couplers differ in length.
    pub fn find_coinciding_tip_poses(&self) -> impl Iterator<Item = SingularPose> + use<> {
        let (left, right) = (self.left_shaft(), self.right_shaft());
        let has_equal_couplers = self.left_coupler_length == self.right_coupler_length;
        circle_intersections(left, self.left_crank_length, right, self.right_crank_length)
            .filter(move |_| has_equal_couplers)
            .map(move |tip| SingularPose {
                kind: Singularity::Couplers,
                theta_left: (tip - left).angle(),
                theta_right: (tip - right).angle(),
            })
    }

    /// The right crank angles (degrees) at which the right tip is at distance `reach` from a point.
    fn right_thetas_at(&self, point: Vector, reach: f64) -> impl Iterator<Item = f64> + use<> {
        let shaft = self.right_shaft();
        circle_intersections(point, reach, shaft, self.right_crank_length)
            .map(move |tip| (tip - shaft).angle())
    }

    /// True if the margin of a candidate vanishes in the assembly mode in which the robot is built;
    /// the same circles also give singular poses of the other mode. A type-2 candidate whose loop
    /// does not close also counts, because only rounding keeps it from closing.
    fn is_singular(&self, pose: &SingularPose) -> bool {
        match self.forward_in_mode(AssemblyMode::Ahead, pose.theta_left, pose.theta_right) {
            Err(_) => pose.kind == Singularity::Couplers,
            Ok(closed_pose) => pose.kind.margin(&closed_pose).abs() < 1e-6,
        }
    }
}

impl Singularity {
    /// The margin of a pose that vanishes at singularities of this kind.
    fn margin(self, pose: &FiveBarPose) -> f64 {
        match self {
            Self::Couplers => pose.type2,
            Self::LeftArm => pose.type1_left(),
            Self::RightArm => pose.type1_right(),
        }
    }
}

/// The intersections of two circles with centres `a`, `b` and radii `r`, `s`: none or two, which
/// are equal if the circles touch.
fn circle_intersections(a: Vector, r: f64, b: Vector, s: f64) -> impl Iterator<Item = Vector> {
    let centre_line = b - a;
    let distance_squared = centre_line.length_squared();
    let middle_ratio = (distance_squared + (r - s) * (r + s)) / (2.0 * distance_squared);
    let height_ratio = (r * r / distance_squared - middle_ratio * middle_ratio).sqrt();
    // Circles that do not intersect, or are concentric, give NaN or infinity.
    let points = height_ratio.is_finite().then(|| {
        let middle = a + centre_line * middle_ratio;
        let height = centre_line.rotated_left() * height_ratio;
        [middle + height, middle - height]
    });
    points.into_iter().flatten()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::PAPER_HEAD;

    /// The margin that vanishes at singularities of a kind, at two crank angles; `None` if the loop does not close.
    fn margin_at(five_bar: &FiveBar, kind: Singularity, left: f64, right: f64) -> Option<f64> {
        let pose = five_bar.forward(left, right).ok()?;
        Some(kind.margin(&pose))
    }

    #[test]
    fn every_sign_change_of_a_type_1_margin_lies_on_a_singular_curve() {
        let unequal_five_bar = FiveBar::new([20.0, 25.0, 55.0, 50.0, 30.0]);
        let mut sign_change_count = 0;
        for five_bar in [PAPER_HEAD, unequal_five_bar] {
            for left in (-175..180).step_by(10).map(f64::from) {
                let singular_poses: Vec<_> = five_bar.find_singular_poses(left).collect();
                for kind in [Singularity::LeftArm, Singularity::RightArm] {
                    for step in 0..3600 {
                        let (a, b) = (f64::from(step) / 10.0 + 0.03, f64::from(step) / 10.0 + 0.13);
                        let margin_at = |right| margin_at(&five_bar, kind, left, right);
                        let (Some(value_a), Some(value_b)) = (margin_at(a), margin_at(b)) else {
                            continue;
                        };
                        // If the crank tips nearly coincide, the end point moves fast and signs change abruptly.
                        let gap = five_bar.forward(left, a).unwrap().gap.length();
                        if value_a * value_b >= 0.0 || gap < 1.0 {
                            continue;
                        }
                        sign_change_count += 1;
                        let is_near = singular_poses.iter().any(|pose| {
                            pose.kind == kind && wrap(pose.theta_right - (a + b) / 2.0).abs() < 0.2
                        });
                        assert!(
                            is_near,
                            "{kind:?} at crank angles {left} and {a} is missing from {singular_poses:?}"
                        );
                    }
                }
            }
        }
        assert!(
            sign_change_count > 100,
            "only {sign_change_count} sign changes"
        );
    }

    #[test]
    fn every_singular_pose_has_a_vanishing_margin() {
        let five_bar_with_short_couplers = FiveBar::new([20.0, 30.0, 30.0, 25.0, 30.0]);
        let mut kind_counts = [0; 3];
        for five_bar in [PAPER_HEAD, five_bar_with_short_couplers] {
            for left in -180..180 {
                for pose in five_bar.find_singular_poses(f64::from(left)) {
                    kind_counts[pose.kind as usize] += 1;
                    let (left, right) = (pose.theta_left, pose.theta_right);
                    if let Some(value) = margin_at(&five_bar, pose.kind, left, right) {
                        assert!(value.abs() < 1e-6, "{pose:?} has the margin {value}");
                    }
                }
            }
        }
        let are_frequent = kind_counts.iter().all(|count| *count > 100);
        assert!(are_frequent, "counts by kind: {kind_counts:?}");
        let left_angles = (0..360).map(f64::from);
        let mut poses = left_angles.flat_map(|left| PAPER_HEAD.find_singular_poses(left));
        assert!(
            poses.all(|pose| pose.kind != Singularity::Couplers),
            "the paper's couplers line up, although the crank tips are at most 80 mm apart, less than 100 mm"
        );
    }

    #[test]
    fn the_papers_crank_tips_coincide_in_two_poses() {
        let poses: Vec<_> = PAPER_HEAD.find_coinciding_tip_poses().collect();
        assert_eq!(poses.len(), 2);
        for pose in poses {
            assert!((pose.theta_left.abs() - 70.52878).abs() < 1e-5);
            assert!((pose.theta_right.abs() - 109.47122).abs() < 1e-5);
        }
    }

    #[test]
    fn no_path_with_sufficient_margins_leads_to_crossed_cranks() {
        // A flood fill divides the poses of a half-degree grid in which every margin, including those of the legs, is
        // at least 0.3, into connected regions. No region contains both crossed and uncrossed cranks. The grid covers
        // the cranks' range between the legs' change points at 0 and 180 degrees.
        const CELLS_PER_SIDE: usize = 360;
        const CELL_COUNT: usize = CELLS_PER_SIDE * CELLS_PER_SIDE;
        let is_uncrossed_at = |left: usize, right: usize| {
            let (left, right) = (left as f64 / 2.0 + 0.25, right as f64 / 2.0 + 0.25);
            let pose = PAPER_HEAD.forward(left, right).ok()?;
            let leg_margin = pose.left_crank.y.abs().min(pose.right_crank.y.abs());
            (pose.margin().min(leg_margin) >= 0.3).then_some(pose.gap.x > 0.0)
        };
        let grid: Vec<Option<bool>> = (0..CELL_COUNT)
            .map(|i| is_uncrossed_at(i / CELLS_PER_SIDE, i % CELLS_PER_SIDE))
            .collect();
        let mut is_visited = vec![false; CELL_COUNT];
        let (mut crossed_count, mut uncrossed_count) = (0, 0);
        for start in 0..CELL_COUNT {
            if grid[start].is_none() || is_visited[start] {
                continue;
            }
            let mut cells_to_visit = vec![start];
            is_visited[start] = true;
            while let Some(i) = cells_to_visit.pop() {
                let (left, right) = (i / CELLS_PER_SIDE, i % CELLS_PER_SIDE);
                assert_eq!(
                    grid[i], grid[start],
                    "crossed and uncrossed cranks are connected at cell {left}, {right}"
                );
                match grid[i] {
                    Some(true) => uncrossed_count += 1,
                    _ => crossed_count += 1,
                }
                let back = CELLS_PER_SIDE - 1;
                for (left_step, right_step) in [(1, 0), (back, 0), (0, 1), (0, back)] {
                    let next_cell = (left + left_step) % CELLS_PER_SIDE * CELLS_PER_SIDE
                        + (right + right_step) % CELLS_PER_SIDE;
                    if grid[next_cell].is_some() && !is_visited[next_cell] {
                        is_visited[next_cell] = true;
                        cells_to_visit.push(next_cell);
                    }
                }
            }
        }
        assert!(
            crossed_count > 100 && uncrossed_count > 100,
            "{crossed_count} crossed and {uncrossed_count} uncrossed poses"
        );
    }
}
