//! The whole robot: four servo angles in, every joint out (Algorithm 1).

use crate::angle::wrap;
use crate::fault::{Fault, Infeasible, Part};
use crate::five_bar::{Branch, FiveBar, FiveBarPose};
use crate::leg::{Leg, LegPose};
use crate::links::Links;
use crate::margins::Margins;
use crate::real::{Lanes, Real};
use crate::slider::{Slider, SliderPose};
use crate::vector::Vector;

/// Four servo angles in degrees, chassis frame. Declared in servo order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<T = f64> {
    /// A1, front left.
    pub theta1: T,
    /// A2, front right.
    pub theta4: T,
    /// A3, back right.
    pub theta8: T,
    /// A4, back left.
    pub theta5: T,
}

impl<T> From<[T; 4]> for Pose<T> {
    /// From A1, A2, A3, A4.
    fn from([theta1, theta4, theta8, theta5]: [T; 4]) -> Self {
        Self {
            theta1,
            theta4,
            theta8,
            theta5,
        }
    }
}

impl<T> From<Pose<T>> for [T; 4] {
    /// To A1, A2, A3, A4.
    fn from(pose: Pose<T>) -> Self {
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
pub struct Solution<T = f64> {
    /// The servo angles it belongs to.
    pub pose: Pose<T>,
    /// The head in its own frame, whose axes are the chassis frame's and whose
    /// origin is the middle of l0.
    pub head: FiveBarPose<T>,
    /// The tail in its own frame: origin in the middle of l5, y backwards. Its
    /// left crank is A4's. See [`Solution::tail_point`] for the chassis frame.
    pub tail: FiveBarPose<T>,
    /// The slider between A1 and A4; axes are the chassis frame's.
    pub left: SliderPose<T>,
    /// The slider between A2 and A3; axes are the chassis frame's.
    pub right: SliderPose<T>,
    /// Legs in servo order: front left, front right, back right, back left.
    pub legs: [LegPose<T>; 4],
    /// Distance from each singularity.
    pub margins: Margins<T>,
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
}

impl<T: Real> Solution<T> {
    /// The head point in mm, chassis frame.
    #[inline(always)]
    pub fn head_point(&self) -> Vector<T> {
        self.head.apex + Vector::of(Vector::new(0.0, self.base_y))
    }

    /// The tail point in mm, chassis frame.
    #[inline(always)]
    pub fn tail_point(&self) -> Vector<T> {
        self.tail.apex.mirrored() - Vector::of(Vector::new(0.0, self.base_y))
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
        let solution = self.shape(pose);
        self.check(&solution)?;
        Ok(solution)
    }

    /// Several poses at once, one in each lane, several times faster than one by
    /// one. What a lane holds has a meaning only if [`Lizard::closes`] says so.
    #[inline(always)]
    pub fn solve_lanes<const N: usize>(&self, poses: &Pose<Lanes<N>>) -> Solution<Lanes<N>> {
        self.shape(poses)
    }

    /// In which lanes every loop closes; [`Lizard::solve`] says why one does not.
    #[inline(always)]
    pub fn closes<const N: usize>(&self, solution: &Solution<Lanes<N>>) -> [bool; N] {
        let Lanes(head) = solution.head.gap.length();
        let Lanes(tail) = solution.tail.gap.length();
        let (Lanes(left), Lanes(right)) = (solution.left.d, solution.right.d);
        let mut closes = [false; N];
        for i in 0..N {
            closes[i] = self.head().check(head[i]).is_ok()
                && self.tail().check(tail[i]).is_ok()
                && self.left().check(left[i]).is_ok()
                && self.right().check(right[i]).is_ok();
        }
        closes
    }

    /// Why a solution has no meaning, if it has none.
    #[inline]
    fn check(&self, solution: &Solution) -> Result<(), Infeasible> {
        let at = |part: Part| move |fault: Fault| Infeasible { part, fault };
        let (head, tail) = (solution.head.gap.length(), solution.tail.gap.length());
        self.head().check(head).map_err(at(Part::Head))?;
        self.tail().check(tail).map_err(at(Part::Tail))?;
        self.left().check(solution.left.d).map_err(at(Part::Left))?;
        self.right()
            .check(solution.right.d)
            .map_err(at(Part::Right))
    }

    /// Every closed form, without a question asked.
    #[inline(always)]
    fn shape<T: Real>(&self, pose: &Pose<T>) -> Solution<T> {
        // Loops rather than `map`, which is not always inlined into the
        // functions with vector instructions that call this.
        let angles = [pose.theta1, pose.theta4, pose.theta8, pose.theta5];
        let (sines, cosines) = T::sin_cos_each(angles);
        let mut cranks = [Vector::new(sines[0], sines[0]); 4];
        for i in 0..4 {
            cranks[i] = Vector::new(cosines[i], sines[i]);
        }
        let [a1, a2, a3, a4] = cranks;
        let head = self.head().shape(Branch::Ahead, a1, a2);
        let tail = self
            .tail()
            .shape(Branch::Ahead, a4.mirrored(), a3.mirrored());
        let left = self.left().shape(a4.right(), a1.left());
        let right = self.right().shape(a3.left(), a2.right());
        let mut legs = [self.leg.close(angles[0], a1); 4];
        for i in 1..4 {
            legs[i] = self.leg.close(angles[i], cranks[i]);
        }
        Solution {
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
        }
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
