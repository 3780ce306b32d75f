//! The inverse kinematics of the five-bar: the crank angles that put the end point at a given point.
//!
//! Each arm forms a triangle of its crank, its coupler and the line from its shaft to the point. Each
//! of the two arms can bend to either side of that line, so a point has four solutions.

use super::{AssemblyMode, FiveBar, FiveBarPose, double_area};
use crate::fault::Fault;
use crate::vector::Vector;

/// The direction in which the elbow of an arm, the joint of crank and coupler, points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Elbow {
    /// Away from the other crank, as the robot is built; positive type-1 margin.
    Outward,
    /// Towards the other crank.
    Inward,
}

/// The elbows of both arms. A mechanism cannot change its working mode without passing through a type-1 singularity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WorkingMode {
    /// Elbow of the left arm.
    pub left: Elbow,
    /// Elbow of the right arm.
    pub right: Elbow,
}

impl WorkingMode {
    /// Both elbows outward, as the robot is built.
    pub const OUTWARD: Self = Self::new(Elbow::Outward, Elbow::Outward);

    /// All four modes, with the left elbow named first: outward-outward, outward-inward, inward-outward, inward-inward.
    pub const ALL: [Self; 4] = [
        Self::OUTWARD,
        Self::new(Elbow::Outward, Elbow::Inward),
        Self::new(Elbow::Inward, Elbow::Outward),
        Self::new(Elbow::Inward, Elbow::Inward),
    ];

    const fn new(left: Elbow, right: Elbow) -> Self {
        Self { left, right }
    }
}

/// One of the four solutions that put the end point at a given point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InverseSolution {
    /// The elbows of both arms.
    pub working_mode: WorkingMode,
    /// The assembly mode in which the forward kinematics returns to the point.
    pub assembly_mode: AssemblyMode,
    /// Left crank angle, (-180, 180] degrees, in the five-bar's own frame.
    pub theta_left: f64,
    /// Right crank angle, (-180, 180] degrees, in the five-bar's own frame.
    pub theta_right: f64,
}

impl FiveBar {
    /// The crank angles that put the end point at a point (mm, own frame): one solution for each
    /// of [`WorkingMode::ALL`], in that order. At the edge of an arm's reach, the solutions for
    /// both of its elbows coincide.
    ///
    /// The paper's second constraint equation has theta2, l1, l2 where theta4, l4, l3 belong.
    ///
    /// # Errors
    /// Returns [`Fault::OutOfReach`] if an arm does not reach the point, [`Fault::OnShaft`] if a
    /// crank's angle is free, [`Fault::NotFinite`] if the input is not finite or overflows.
    pub fn inverse(&self, point: Vector) -> Result<[InverseSolution; 4], Fault> {
        let arms = self.solve_arms(point)?;
        let solution_in_mode = |working_mode: WorkingMode| {
            let (left, right, assembly_mode) = arms.directions_in_mode(working_mode);
            InverseSolution {
                working_mode,
                assembly_mode,
                theta_left: left.angle(),
                theta_right: right.angle(),
            }
        };
        Ok(WorkingMode::ALL.map(solution_in_mode))
    }

    /// The pose with the end point at a point (mm, own frame) and both elbows outward; cheaper than
    /// [`FiveBar::inverse`], since it needs no arc tangents.
    ///
    /// # Errors
    /// Fails as [`FiveBar::inverse`] and [`FiveBar::forward`] do.
    pub fn pose_at_point(&self, point: Vector) -> Result<FiveBarPose, Fault> {
        let arms = self.solve_arms(point)?;
        let (left, right, mode) = arms.directions_in_mode(WorkingMode::OUTWARD);
        self.close(mode, left, right)
    }

    /// Solves both arms for a point (mm, own frame).
    fn solve_arms(&self, point: Vector) -> Result<Arms, Fault> {
        if !point.is_finite() {
            return Err(Fault::NotFinite);
        }
        let from_left_shaft = point - self.left_shaft();
        let from_right_shaft = point - self.right_shaft();
        let (crank, coupler) = (self.left_crank_length, self.left_coupler_length);
        let left_cranks = crank_directions(from_left_shaft, crank, coupler, true)?;
        let (crank, coupler) = (self.right_crank_length, self.right_coupler_length);
        let right_cranks = crank_directions(from_right_shaft, crank, coupler, false)?;
        Ok(Arms {
            five_bar: *self,
            from_left_shaft,
            from_right_shaft,
            left_cranks,
            right_cranks,
        })
    }
}

/// Both arms, solved for a point.
struct Arms {
    /// The five-bar to which the arms belong.
    five_bar: FiveBar,
    /// Vector from the left shaft to the point, mm.
    from_left_shaft: Vector,
    /// Vector from the right shaft to the point, mm.
    from_right_shaft: Vector,
    /// Directions of the left crank, length one: counter-clockwise and clockwise of the line to the point.
    left_cranks: [Vector; 2],
    /// Directions of the right crank, length one: counter-clockwise and clockwise of the line to the point.
    right_cranks: [Vector; 2],
}

impl Arms {
    /// The directions (length one) of the left and the right crank in a working mode, and the assembly mode.
    fn directions_in_mode(&self, mode: WorkingMode) -> (Vector, Vector, AssemblyMode) {
        // Outward is to the left of the line from the left shaft to the point,
        // and to the right of the line from the right shaft.
        let left = match mode.left {
            Elbow::Outward => self.left_cranks[0],
            Elbow::Inward => self.left_cranks[1],
        };
        let right = match mode.right {
            Elbow::Outward => self.right_cranks[1],
            Elbow::Inward => self.right_cranks[0],
        };
        let left_coupler = self.from_left_shaft - left * self.five_bar.left_crank_length;
        let right_coupler = self.from_right_shaft - right * self.five_bar.right_crank_length;
        let assembly_mode = match left_coupler.cross(right_coupler) >= 0.0 {
            true => AssemblyMode::Ahead,
            false => AssemblyMode::Behind,
        };
        (left, right, assembly_mode)
    }
}

/// The directions (length one) of a crank whose coupler ends at a point: counter-clockwise and clockwise of the line
/// from the shaft to the point. `crank` and `coupler` are lengths, mm; `is_left` names the crank in a fault.
fn crank_directions(
    to_point: Vector,
    crank: f64,
    coupler: f64,
    is_left: bool,
) -> Result<[Vector; 2], Fault> {
    let distance = to_point.length();
    let (min_reach, max_reach) = ((crank - coupler).abs(), crank + coupler);
    if !distance.is_finite() || !max_reach.is_finite() {
        return Err(Fault::NotFinite);
    }
    // A point that the caller computed to lie on the edge of the reach may be outside by rounding.
    let rounding_tolerance = max_reach * 4.0 * f64::EPSILON;
    if distance > max_reach + rounding_tolerance || distance < min_reach - rounding_tolerance {
        return Err(Fault::OutOfReach {
            is_left,
            distance,
            min_reach,
            max_reach,
        });
    }
    if distance <= rounding_tolerance {
        return Err(Fault::OnShaft);
    }
    // The components of the crank's direction, relative to the line to the point, scaled by twice the product of crank
    // and distance.
    let parallel = distance * distance + (crank - coupler) * (crank + coupler);
    let perpendicular = 2.0 * double_area(crank, coupler, distance);
    let directions = [perpendicular, -perpendicular].map(|perpendicular| {
        let direction = rotate_and_scale(Vector::new(parallel, perpendicular), to_point);
        direction * (1.0 / direction.length())
    });
    // If the products overflow or underflow, the results do not have length one.
    let is_unit = |direction: &Vector| (direction.length_squared() - 1.0).abs() < 1e-9;
    match directions.iter().all(is_unit) {
        true => Ok(directions),
        false => Err(Fault::NotFinite),
    }
}

/// Returns `vector`, turned by the angle of `frame` and scaled by the length of `frame`.
fn rotate_and_scale(vector: Vector, frame: Vector) -> Vector {
    frame * vector.x + frame.rotated_left() * vector.y
}
