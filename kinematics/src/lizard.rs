//! The whole robot: four servo angles in, every joint out (Algorithm 1).

use crate::angle::{sin_cos_all, wrap};
use crate::fault::{Fault, Infeasible, Part};
use crate::five_bar::{Branch, FiveBar, FiveBarPose};
use crate::leg::{Leg, LegPose};
use crate::links::Links;
use crate::margins::Margins;
use crate::slider::{Slider, SliderPose};
use crate::vector::Vector;

/// Four servo angles in degrees, chassis frame. Declared in servo order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// A1, front left.
    pub theta1: f64,
    /// A2, front right.
    pub theta4: f64,
    /// A3, back right.
    pub theta8: f64,
    /// A4, back left.
    pub theta5: f64,
}

impl From<[f64; 4]> for Pose {
    /// From A1, A2, A3, A4.
    fn from([theta1, theta4, theta8, theta5]: [f64; 4]) -> Self {
        Self {
            theta1,
            theta4,
            theta8,
            theta5,
        }
    }
}

impl From<Pose> for [f64; 4] {
    /// To A1, A2, A3, A4.
    fn from(pose: Pose) -> Self {
        [pose.theta1, pose.theta4, pose.theta8, pose.theta5]
    }
}

/// The robot's dimensions. The chassis is a rectangle with a shaft near each
/// corner, so l10 = l15; every leg is a parallelogram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lizard {
    /// Links of the body.
    pub links: Links,
    /// Links of each leg.
    pub leg: Leg,
}

/// Everything that follows from a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solution {
    /// The servo angles it belongs to.
    pub pose: Pose,
    /// The head in its own frame, whose axes are the chassis frame's and whose
    /// origin is the middle of l0.
    pub head: FiveBarPose,
    /// The tail in its own frame: origin in the middle of l5, y backwards. Its
    /// left crank is A4's. See [`Solution::tail_point`] for the chassis frame.
    pub tail: FiveBarPose,
    /// The slider between A1 and A4; axes are the chassis frame's.
    pub left: SliderPose,
    /// The slider between A2 and A3; axes are the chassis frame's.
    pub right: SliderPose,
    /// Legs in servo order: front left, front right, back right, back left.
    pub legs: [LegPose; 4],
    /// Distance from each singularity.
    pub margins: Margins,
    /// y of the head's base, mm, chassis frame; the tail's is its negative.
    base_y: f64,
}

impl Solution {
    /// theta2, the head's left coupler: degrees, chassis frame.
    pub fn theta2(&self) -> f64 {
        self.head.theta_left_coupler()
    }

    /// theta3, the head's right coupler: degrees, chassis frame.
    pub fn theta3(&self) -> f64 {
        self.head.theta_right_coupler()
    }

    /// theta6, the tail's left coupler: degrees, chassis frame.
    pub fn theta6(&self) -> f64 {
        self.tail.left_coupler.mirrored().angle()
    }

    /// theta7, the tail's right coupler: degrees, chassis frame.
    pub fn theta7(&self) -> f64 {
        self.tail.right_coupler.mirrored().angle()
    }

    /// The head point in mm, chassis frame.
    #[inline]
    pub fn head_point(&self) -> Vector {
        self.head.apex + Vector::new(0.0, self.base_y)
    }

    /// The tail point in mm, chassis frame.
    #[inline]
    pub fn tail_point(&self) -> Vector {
        self.tail.apex.mirrored() - Vector::new(0.0, self.base_y)
    }
}

impl Lizard {
    /// The head's five-bar.
    #[inline]
    pub const fn head(&self) -> FiveBar {
        let l = &self.links;
        FiveBar {
            base: l.l0,
            crank_left: l.l1,
            coupler_left: l.l2,
            coupler_right: l.l3,
            crank_right: l.l4,
        }
    }

    /// The tail's five-bar. In its own frame angles are the negatives of the
    /// chassis frame's; then the tail is solved as the head is.
    #[inline]
    pub const fn tail(&self) -> FiveBar {
        let l = &self.links;
        FiveBar {
            base: l.l5,
            crank_left: l.l6,
            coupler_left: l.l7,
            coupler_right: l.l8,
            crank_right: l.l9,
        }
    }

    /// The left flank.
    #[inline]
    pub const fn left(&self) -> Slider {
        let l = &self.links;
        Slider {
            offset: (l.l5 - l.l0) / 2.0,
            base: l.l10,
            front: l.l14,
            rear: l.l11,
            nominal: l.l12 + l.l13,
        }
    }

    /// The right flank.
    #[inline]
    pub const fn right(&self) -> Slider {
        let l = &self.links;
        Slider {
            offset: (l.l0 - l.l5) / 2.0,
            base: l.l15,
            front: l.l19,
            rear: l.l16,
            nominal: l.l17 + l.l18,
        }
    }

    /// Shafts of A1, A2, A3, A4 in mm, chassis frame.
    pub const fn shafts(&self) -> [Vector; 4] {
        let l = &self.links;
        let y = l.l10 / 2.0;
        [
            Vector::new(-l.l0 / 2.0, y),
            Vector::new(l.l0 / 2.0, y),
            Vector::new(l.l5 / 2.0, -y),
            Vector::new(-l.l5 / 2.0, -y),
        ]
    }

    /// The whole robot at a pose.
    ///
    /// The side arms stand at right angles to the cranks, away from the head:
    /// theta12 = theta1 + 90, theta9 = theta5 - 90, theta16 = theta4 - 90,
    /// theta13 = theta8 + 90. (The paper prints the last two with the other
    /// sign, which would swing the right arms across the chassis.)
    #[inline]
    pub fn solve(&self, pose: &Pose) -> Result<Solution, Infeasible> {
        let angles = <[f64; 4]>::from(*pose);
        let (sines, cosines) = sin_cos_all(angles);
        let cranks: [Vector; 4] = core::array::from_fn(|i| Vector::new(cosines[i], sines[i]));
        let [a1, a2, a3, a4] = cranks;
        let at = |part: Part| move |fault: Fault| Infeasible { part, fault };
        let head = self
            .head()
            .close(Branch::Ahead, a1, a2)
            .map_err(at(Part::Head))?;
        let tail = self
            .tail()
            .close(Branch::Ahead, a4.mirrored(), a3.mirrored())
            .map_err(at(Part::Tail))?;
        let left = self
            .left()
            .close(a4.right(), a1.left())
            .map_err(at(Part::Left))?;
        let right = self
            .right()
            .close(a3.left(), a2.right())
            .map_err(at(Part::Right))?;
        let legs: [LegPose; 4] = core::array::from_fn(|i| self.leg.close(angles[i], cranks[i]));
        Ok(Solution {
            pose: *pose,
            head,
            tail,
            left,
            right,
            legs,
            margins: Margins {
                apex_head: head.type2,
                apex_tail: tail.type2,
                type1_a1: head.type1_left(),
                type1_a2: head.type1_right(),
                type1_a3: tail.type1_right(),
                type1_a4: tail.type1_left(),
                leg_fl: legs[0].margin,
                leg_fr: legs[1].margin,
                leg_br: legs[2].margin,
                leg_bl: legs[3].margin,
            },
            base_y: self.links.l10 / 2.0,
        })
    }

    /// The margins at a pose; no arc tangents are taken.
    pub fn margins(&self, pose: &Pose) -> Result<Margins, Infeasible> {
        self.solve(pose).map(|solution| solution.margins)
    }

    /// The crank angles A1, A2 (degrees, chassis frame) that put the head at a
    /// point in mm from the middle of l0, with outward elbows.
    pub fn head_angles(&self, point: Vector) -> Result<[f64; 2], Infeasible> {
        let [outward, ..] = self.head().inverse(point).map_err(|fault| Infeasible {
            part: Part::Head,
            fault,
        })?;
        Ok([outward.theta_left, outward.theta_right])
    }

    /// The crank angles A3, A4 (degrees, chassis frame) that put the tail at a
    /// point in mm from the middle of l5, y backwards, with outward elbows.
    pub fn tail_angles(&self, point: Vector) -> Result<[f64; 2], Infeasible> {
        let [outward, ..] = self.tail().inverse(point).map_err(|fault| Infeasible {
            part: Part::Tail,
            fault,
        })?;
        Ok([wrap(-outward.theta_right), wrap(-outward.theta_left)])
    }
}
