//! Inverse kinematics of the five-bar: the crank angles that put the end point at a given point.
//!
//! Each arm by itself is a triangle of crank, coupler and the line from its shaft to the point. An
//! arm can bend to either side of that line, so a point has four solutions.

use super::{AssemblyMode, FiveBar, FiveBarPose, double_area};
use crate::fault::Fault;
use crate::vector::Vector;

/// The direction in which a crank and its coupler bend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Elbow {
    /// Away from the other crank, as the robot is built; positive type-1 margin.
    Outward,
    /// Towards the other crank.
    Inward,
}

/// The bends of both arms. A mechanism cannot change them without passing a type-1
/// singularity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WorkingMode {
    /// Bend of the left crank and coupler.
    pub left: Elbow,
    /// Bend of the right crank and coupler.
    pub right: Elbow,
}

impl WorkingMode {
    /// Both elbows outward, as the robot is built.
    pub const OUTWARD: Self = Self::new(Elbow::Outward, Elbow::Outward);

    /// All four modes: outward-outward, outward-inward, inward-outward, inward-inward,
    /// the left elbow first.
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
    /// The bends of both arms.
    pub working_mode: WorkingMode,
    /// The assembly mode in which the forward solution finds the point again.
    pub assembly_mode: AssemblyMode,
    /// Left crank angle, (-180, 180] degrees, the five-bar's own frame.
    pub theta_left: f64,
    /// Right crank angle, (-180, 180] degrees, the five-bar's own frame.
    pub theta_right: f64,
}

impl FiveBar {
    /// Crank angles that put the end point at a point (mm, own frame), one
    /// solution for each of [`WorkingMode::ALL`], in that order. At the edge of
    /// an arm's reach its two elbows coincide.
    ///
    /// The paper's second constraint equation has theta2, l1, l2 where theta4,
    /// l4, l3 belong.
    ///
    /// # Errors
    /// Returns [`Fault::OutOfReach`] where an arm does not reach the point, [`Fault::OnShaft`]
    /// where a crank's angle is free, [`Fault::NotFinite`] for input that is not finite or that
    /// overflows.
    pub fn inverse(&self, point: Vector) -> Result<[InverseSolution; 4], Fault> {
        let arms = self.solve_arms(point)?;
        let solution_of = |working_mode: WorkingMode| {
            let (left, right, assembly_mode) = arms.directions_in(working_mode);
            InverseSolution {
                working_mode,
                assembly_mode,
                theta_left: left.angle(),
                theta_right: right.angle(),
            }
        };
        Ok(WorkingMode::ALL.map(solution_of))
    }

    /// The pose with the end point at a point (mm, own frame) and both elbows outward; cheaper than
    /// [`FiveBar::inverse`], since it needs no arc tangents.
    ///
    /// # Errors
    /// Fails as [`FiveBar::inverse`] and [`FiveBar::forward`] do.
    pub fn reach(&self, point: Vector) -> Result<FiveBarPose, Fault> {
        let (left, right, mode) = self.solve_arms(point)?.directions_in(WorkingMode::OUTWARD);
        self.close(mode, left, right)
    }

    fn solve_arms(&self, point: Vector) -> Result<Arms, Fault> {
        if !point.is_finite() {
            return Err(Fault::NotFinite);
        }
        let from_left_shaft = point - self.left_shaft();
        let from_right_shaft = point - self.right_shaft();
        Ok(Arms {
            bars: *self,
            from_left_shaft,
            from_right_shaft,
            left: crank_directions(from_left_shaft, self.crank_left, self.coupler_left, true)?,
            right: crank_directions(
                from_right_shaft,
                self.crank_right,
                self.coupler_right,
                false,
            )?,
        })
    }
}

/// Both arms, solved for a point.
struct Arms {
    bars: FiveBar,
    /// Vector from the left shaft to the point, mm.
    from_left_shaft: Vector,
    /// Vector from the right shaft to the point, mm.
    from_right_shaft: Vector,
    /// Directions of the left crank, length one, bent counter-clockwise and clockwise from the line
    /// to the point.
    left: [Vector; 2],
    /// Directions of the right crank, length one, bent counter-clockwise and clockwise from the line
    /// to the point.
    right: [Vector; 2],
}

impl Arms {
    /// Crank directions (length one) in a working mode, and the assembly mode.
    fn directions_in(&self, mode: WorkingMode) -> (Vector, Vector, AssemblyMode) {
        // Outward is to the left of the line from the left shaft to the point,
        // and to the right of the line from the right shaft.
        let left = match mode.left {
            Elbow::Outward => self.left[0],
            Elbow::Inward => self.left[1],
        };
        let right = match mode.right {
            Elbow::Outward => self.right[1],
            Elbow::Inward => self.right[0],
        };
        let left_coupler = self.from_left_shaft - left * self.bars.crank_left;
        let right_coupler = self.from_right_shaft - right * self.bars.crank_right;
        let assembly_mode = if left_coupler.cross(right_coupler) >= 0.0 {
            AssemblyMode::Ahead
        } else {
            AssemblyMode::Behind
        };
        (left, right, assembly_mode)
    }
}

/// The directions (length one) of a crank whose coupler ends at a point: bent counter-clockwise and
/// clockwise from the line between shaft and point.
fn crank_directions(
    to_point: Vector,
    crank: f64,
    coupler: f64,
    is_left: bool,
) -> Result<[Vector; 2], Fault> {
    let distance = to_point.length();
    let (min, max) = ((crank - coupler).abs(), crank + coupler);
    if !distance.is_finite() || !max.is_finite() {
        return Err(Fault::NotFinite);
    }
    // A point on the edge of the reach that was computed elsewhere may miss it by rounding.
    let slack = max * 4.0 * f64::EPSILON;
    if distance > max + slack || distance < min - slack {
        return Err(Fault::OutOfReach {
            is_left,
            distance,
            least: min,
            most: max,
        });
    }
    if distance <= slack {
        return Err(Fault::OnShaft);
    }
    // Crank direction relative to the line to the point, scaled by twice the product of both lengths.
    let parallel = distance * distance + (crank - coupler) * (crank + coupler);
    let perpendicular = 2.0 * double_area(crank, coupler, distance);
    let directions = [perpendicular, -perpendicular].map(|perpendicular| {
        let crank = rotate(Vector::new(parallel, perpendicular), to_point);
        crank * (1.0 / crank.length())
    });
    // If the products overflow or vanish, no direction of length one is left.
    if directions
        .iter()
        .all(|crank| (crank.length_squared() - 1.0).abs() < 1e-9)
    {
        Ok(directions)
    } else {
        Err(Fault::NotFinite)
    }
}

/// `vector` turned by the angle of `frame` and scaled by its length.
fn rotate(vector: Vector, frame: Vector) -> Vector {
    frame * vector.x + frame.rotated_left() * vector.y
}
