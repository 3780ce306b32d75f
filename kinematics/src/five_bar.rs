//! Two motors, two cranks, two couplers, one point: the RRRRR five-bar.
//!
//! The couplers' far ends meet in the apex. Given the crank tips, the apex is
//! where two circles meet; given the apex, each crank tip is where two circles
//! meet. Both directions use the same construction with the area of a triangle
//! in Heron's factored form, which loses no digits when the triangle is flat.
//!
//! The paper solves R1 + R2 = R0 + R4 + R3 by half-angle tangents. Its theta3
//! holds, but is 0/0 where the crank tips coincide and loses digits where A = 0;
//! its theta2 (D, E, F, K4) has three sign slips.

use crate::fault::Fault;
use crate::real::Real;
use crate::vector::Vector;

/// Below this gap (mm) between the crank tips the apex has no direction left:
/// rounding alone moves it by more than a tenth of a millimetre.
const LEAST_GAP: f64 = 1e-12;

/// Link lengths of a five-bar in mm. Its frame has the origin in the middle of
/// the base, x from the left shaft to the right one, y towards the apex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FiveBar {
    /// Distance between the shafts: l0, l5.
    pub base: f64,
    /// Left crank: l1, l6.
    pub crank_left: f64,
    /// Left coupler: l2, l7.
    pub coupler_left: f64,
    /// Right coupler: l3, l8.
    pub coupler_right: f64,
    /// Right crank: l4, l9.
    pub crank_right: f64,
}

/// On which side of the line from the left crank tip to the right one the apex
/// lies. A mechanism cannot change it without passing the type-2 singularity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Branch {
    /// To the left of that line, which is ahead as long as the cranks are not
    /// crossed. The robot is built this way; the paper's -sqrt in theta3.
    Ahead,
    /// To the right of that line.
    Behind,
}

/// Which way a crank and its coupler bend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Elbow {
    /// Away from the other crank, as the robot is built; positive type-1 margin.
    Outward,
    /// Towards the other crank.
    Inward,
}

/// One of the four ways to put the apex at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Assembly {
    /// Bend of the left crank and coupler.
    pub left: Elbow,
    /// Bend of the right crank and coupler.
    pub right: Elbow,
    /// The branch on which the forward solution finds the point again.
    pub branch: Branch,
    /// Left crank angle, (-180, 180] degrees.
    pub theta_left: f64,
    /// Right crank angle, (-180, 180] degrees.
    pub theta_right: f64,
}

/// A closed five-bar, in its own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FiveBarPose<T = f64> {
    /// Links that this pose belongs to.
    pub bars: FiveBar,
    /// Direction of the left crank, length one.
    pub left: Vector<T>,
    /// Direction of the right crank, length one.
    pub right: Vector<T>,
    /// Tip of the left crank, mm.
    pub left_tip: Vector<T>,
    /// Tip of the right crank, mm.
    pub right_tip: Vector<T>,
    /// Direction of the left coupler (theta2), length one.
    pub left_coupler: Vector<T>,
    /// Direction of the right coupler (theta3), length one.
    pub right_coupler: Vector<T>,
    /// The apex, mm.
    pub apex: Vector<T>,
    /// From the left crank tip to the right one, mm: (K2, K1) in the paper.
    pub gap: Vector<T>,
    /// Type-2 margin sin(theta3 - theta2): 0 where the couplers line up and the
    /// apex can move with both servos still. Positive on [`Branch::Ahead`].
    pub type2: T,
}

impl FiveBarPose {
    /// theta2 (theta6 mirrored): angle of the left coupler, degrees.
    #[inline]
    pub fn theta_left_coupler(&self) -> f64 {
        self.left_coupler.angle()
    }

    /// theta3 (theta7 mirrored): angle of the right coupler, degrees.
    #[inline]
    pub fn theta_right_coupler(&self) -> f64 {
        self.right_coupler.angle()
    }

    /// Smallest of the three margins.
    pub fn margin(&self) -> f64 {
        self.type2.min(self.type1_left()).min(self.type1_right())
    }
}

impl<T: Real> FiveBarPose<T> {
    /// Type-1 margin of the left arm, sin(theta1 - theta2): 0 where crank and
    /// coupler line up and the apex cannot move outward, positive for an
    /// outward elbow.
    #[inline(always)]
    pub fn type1_left(&self) -> T {
        self.left_coupler.cross(self.left)
    }

    /// Type-1 margin of the right arm, sin(theta3 - theta4), likewise.
    #[inline(always)]
    pub fn type1_right(&self) -> T {
        self.right.cross(self.right_coupler)
    }
}

impl FiveBar {
    /// Shaft of the left crank, mm.
    #[inline]
    pub fn left_shaft(&self) -> Vector {
        Vector::new(-self.base / 2.0, 0.0)
    }

    /// Shaft of the right crank, mm.
    #[inline]
    pub fn right_shaft(&self) -> Vector {
        Vector::new(self.base / 2.0, 0.0)
    }

    /// The apex for two crank angles in degrees, on the branch that the robot
    /// is built on. Loop closure is below 1e-12 mm for lengths of this size.
    ///
    /// ```
    /// let head = lizard_kinematics::FiveBar {
    ///     base: 20.0, crank_left: 30.0, coupler_left: 50.0, coupler_right: 50.0, crank_right: 30.0,
    /// };
    /// let pose = head.forward(90.0, 90.0).unwrap();
    /// assert!((pose.apex.y - 30.0 - 2400.0f64.sqrt()).abs() < 1e-12);
    /// ```
    pub fn forward(&self, theta_left: f64, theta_right: f64) -> Result<FiveBarPose, Fault> {
        self.forward_on(Branch::Ahead, theta_left, theta_right)
    }

    /// The apex for two crank angles in degrees, on either branch.
    pub fn forward_on(
        &self,
        branch: Branch,
        theta_left: f64,
        theta_right: f64,
    ) -> Result<FiveBarPose, Fault> {
        self.close(
            branch,
            Vector::direction(theta_left),
            Vector::direction(theta_right),
        )
    }

    /// The apex for two crank directions of length one: all of the solution
    /// except the sines and arc tangents.
    #[inline]
    pub fn close(&self, branch: Branch, left: Vector, right: Vector) -> Result<FiveBarPose, Fault> {
        let pose = self.shape(branch, left, right);
        self.check(pose.gap.length())?;
        Ok(pose)
    }

    /// Whether the couplers can span a gap of `d` mm between the crank tips.
    #[inline]
    pub(crate) fn check(&self, d: f64) -> Result<(), Fault> {
        let (l2, l3) = (self.coupler_left, self.coupler_right);
        let (least, reach) = ((l2 - l3).abs(), l2 + l3);
        if !d.is_finite() {
            Err(Fault::NotFinite)
        } else if d > reach {
            Err(Fault::Apart { gap: d, reach })
        } else if d < least {
            Err(Fault::Nested { gap: d, least })
        } else if d < LEAST_GAP {
            Err(Fault::Coincident)
        } else {
            Ok(())
        }
    }

    /// The pose, if [`FiveBar::check`] agrees; else it has no meaning.
    #[inline(always)]
    pub(crate) fn shape<T: Real>(
        &self,
        branch: Branch,
        left: Vector<T>,
        right: Vector<T>,
    ) -> FiveBarPose<T> {
        let left_tip = Vector::of(self.left_shaft()) + left * self.crank_left;
        let right_tip = Vector::of(self.right_shaft()) + right * self.crank_right;
        let gap = right_tip - left_tip;
        let square = gap.square();
        let (l2, l3) = (self.coupler_left, self.coupler_right);
        let area = match branch {
            Branch::Ahead => double_area(l2, l3, square.root()),
            Branch::Behind => -double_area(l2, l3, square.root()),
        };
        // Foot of the apex on the line between the tips, and its height over it,
        // both in units of the gap.
        let along = (square + T::of((l2 - l3) * (l2 + l3))) / (square * 2.0);
        let rise = gap.left().scaled(area / square);
        let from_left = gap.scaled(along) + rise;
        let from_right = gap.scaled(along - T::of(1.0)) + rise;
        FiveBarPose {
            bars: *self,
            left,
            right,
            left_tip,
            right_tip,
            left_coupler: from_left * (1.0 / l2),
            right_coupler: from_right * (1.0 / l3),
            apex: left_tip + from_left,
            gap,
            type2: area * (1.0 / (l2 * l3)),
        }
    }

    /// Crank angles that put the apex at a point (mm, the five-bar's own frame),
    /// in the order outward-outward, outward-inward, inward-outward,
    /// inward-inward (left elbow first). At the edge of an arm's reach its two
    /// elbows coincide.
    ///
    /// The paper's second constraint equation has theta2, l1, l2 where theta4,
    /// l4, l3 belong.
    pub fn inverse(&self, point: Vector) -> Result<[Assembly; 4], Fault> {
        let arms = self.arms(point)?;
        let assembly = |left: Elbow, right: Elbow| {
            let (left_crank, right_crank, branch) = arms.bent(left, right);
            Assembly {
                left,
                right,
                branch,
                theta_left: left_crank.angle(),
                theta_right: right_crank.angle(),
            }
        };
        use Elbow::{Inward, Outward};
        Ok([
            assembly(Outward, Outward),
            assembly(Outward, Inward),
            assembly(Inward, Outward),
            assembly(Inward, Inward),
        ])
    }

    /// The pose with the apex at a point and both elbows outward: the inverse
    /// without its arc tangents.
    pub fn reach(&self, point: Vector) -> Result<FiveBarPose, Fault> {
        let (left, right, branch) = self.arms(point)?.bent(Elbow::Outward, Elbow::Outward);
        self.close(branch, left, right)
    }

    fn arms(&self, point: Vector) -> Result<Arms, Fault> {
        if !point.is_finite() {
            return Err(Fault::NotFinite);
        }
        let to_left = point - self.left_shaft();
        let to_right = point - self.right_shaft();
        Ok(Arms {
            bars: *self,
            to_left,
            to_right,
            left: bend(to_left, self.crank_left, self.coupler_left, true)?,
            right: bend(to_right, self.crank_right, self.coupler_right, false)?,
        })
    }
}

/// Both arms on their way to a point.
struct Arms {
    bars: FiveBar,
    /// From each shaft to the point.
    to_left: Vector,
    to_right: Vector,
    /// Each crank against that line, bent counter-clockwise.
    left: Vector,
    right: Vector,
}

impl Arms {
    /// Crank directions (length one) for a choice of elbows, and the branch.
    fn bent(&self, left: Elbow, right: Elbow) -> (Vector, Vector, Branch) {
        // Outward is to the left of the line from the left shaft to the point,
        // and to the right of the line from the right shaft.
        let left = match left {
            Elbow::Outward => self.left,
            Elbow::Inward => self.left.mirrored(),
        };
        let right = match right {
            Elbow::Outward => self.right.mirrored(),
            Elbow::Inward => self.right,
        };
        let unit = |v: Vector| v * (1.0 / v.length());
        let left = unit(rotate(left, self.to_left));
        let right = unit(rotate(right, self.to_right));
        let from_left = self.to_left - left * self.bars.crank_left;
        let from_right = self.to_right - right * self.bars.crank_right;
        let branch = if from_left.cross(from_right) >= 0.0 {
            Branch::Ahead
        } else {
            Branch::Behind
        };
        (left, right, branch)
    }
}

/// Twice the area of a triangle from its sides, by Heron in factored form.
#[inline(always)]
fn double_area<T: Real>(a: f64, b: f64, c: T) -> T {
    let (sum, difference) = (T::of(a + b), T::of(a - b));
    let product = (sum + c) * (sum - c) * (c + difference) * (c - difference);
    product.root() * 0.5
}

/// The crank's direction relative to the line from its shaft to the point, bent
/// counter-clockwise, scaled by twice the product of crank and distance.
fn bend(to_point: Vector, crank: f64, coupler: f64, left: bool) -> Result<Vector, Fault> {
    let distance = to_point.length();
    let (least, most) = ((crank - coupler).abs(), crank + coupler);
    // A point on the rim that was computed elsewhere may miss it by rounding.
    let slack = most * 4.0 * f64::EPSILON;
    if distance > most + slack || distance < least - slack {
        return Err(Fault::OutOfReach {
            left,
            distance,
            least,
            most,
        });
    }
    if distance <= slack {
        return Err(Fault::OnShaft);
    }
    let along = distance * distance + (crank - coupler) * (crank + coupler);
    Ok(Vector::new(
        along,
        2.0 * double_area(crank, coupler, distance),
    ))
}

/// `vector` turned by the angle of `frame` and scaled by its length.
fn rotate(vector: Vector, frame: Vector) -> Vector {
    frame * vector.x + frame.left() * vector.y
}
