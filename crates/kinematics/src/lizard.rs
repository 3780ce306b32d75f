//! The whole robot: four servo angles in, every joint out (Algorithm 1).

use crate::end::End;
use crate::fault::{Fault, Infeasible, Part};
use crate::five_bar::{AssemblyMode, FiveBar, FiveBarPose};
use crate::leg::{Leg, LegPose};
use crate::links::Links;
use crate::margins::Margins;
use crate::real::{Lanes, Real};
use crate::side::Side;
use crate::slider::{Slider, SliderPose};
use crate::vector::Vector;

/// Four servo angles in degrees, chassis frame. Declared in servo order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<T = f64> {
    /// A1, front left; any finite angle, as are all four.
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
    /// left crank is A4's. See [`Solution::point`] for the chassis frame.
    pub tail: FiveBarPose<T>,
    /// The slider between A1 and A4; axes are the chassis frame's.
    pub left: SliderPose<T>,
    /// The slider between A2 and A3; axes are the chassis frame's.
    pub right: SliderPose<T>,
    /// Legs in servo order: LF, RF, RH, LH.
    pub legs: [LegPose<T>; 4],
    /// Distance from each singularity.
    pub margins: Margins<T>,
    /// The robot it belongs to.
    lizard: Lizard,
}

impl Solution {
    /// theta2, the head's left coupler: degrees, chassis frame.
    pub fn theta2(&self) -> f64 {
        self.couplers(End::Head)[0].angle()
    }

    /// theta3, the head's right coupler: degrees, chassis frame.
    pub fn theta3(&self) -> f64 {
        self.couplers(End::Head)[1].angle()
    }

    /// theta6, the tail's left coupler: degrees, chassis frame.
    pub fn theta6(&self) -> f64 {
        self.couplers(End::Tail)[0].angle()
    }

    /// theta7, the tail's right coupler: degrees, chassis frame.
    pub fn theta7(&self) -> f64 {
        self.couplers(End::Tail)[1].angle()
    }
}

impl<T: Real> Solution<T> {
    /// The five-bar of an end, in the end's own frame.
    #[inline(always)]
    pub const fn end(&self, end: End) -> &FiveBarPose<T> {
        match end {
            End::Head => &self.head,
            End::Tail => &self.tail,
        }
    }

    /// The slider of a side.
    #[inline(always)]
    pub const fn side(&self, side: Side) -> &SliderPose<T> {
        match side {
            Side::Left => &self.left,
            Side::Right => &self.right,
        }
    }

    /// The end point of an end, mm, chassis frame.
    #[inline(always)]
    pub fn point(&self, end: End) -> Vector<T> {
        self.lizard.to_chassis(end, self.end(end).end_point)
    }

    /// The head point, mm, chassis frame.
    #[inline(always)]
    pub fn head_point(&self) -> Vector<T> {
        self.point(End::Head)
    }

    /// The tail point, mm, chassis frame.
    #[inline(always)]
    pub fn tail_point(&self) -> Vector<T> {
        self.point(End::Tail)
    }

    /// Directions of the left and the right coupler of an end, length one,
    /// chassis frame.
    #[inline(always)]
    pub fn couplers(&self, end: End) -> [Vector<T>; 2] {
        let bars = self.end(end);
        [
            end.mirror(bars.left_coupler),
            end.mirror(bars.right_coupler),
        ]
    }

    /// Tips of the four cranks in servo order, mm, chassis frame.
    pub fn crank_tips(&self) -> [Vector<T>; 4] {
        let mut tips = [self.head.left_tip; 4];
        for end in End::ALL {
            let ([left, right], bars) = (end.servos(), self.end(end));
            tips[left] = self.lizard.to_chassis(end, bars.left_tip);
            tips[right] = self.lizard.to_chassis(end, bars.right_tip);
        }
        tips
    }
}

impl Lizard {
    /// The five-bar of an end, to be solved in the end's own frame.
    #[inline]
    pub const fn end(&self, end: End) -> FiveBar {
        let l = &self.links;
        match end {
            End::Head => FiveBar {
                base: l.l0,
                crank_left: l.l1,
                coupler_left: l.l2,
                coupler_right: l.l3,
                crank_right: l.l4,
            },
            End::Tail => FiveBar {
                base: l.l5,
                crank_left: l.l6,
                coupler_left: l.l7,
                coupler_right: l.l8,
                crank_right: l.l9,
            },
        }
    }

    /// The slider of a side.
    #[inline]
    pub const fn side(&self, side: Side) -> Slider {
        let l = &self.links;
        let offset = side.sign() * (l.l5 - l.l0) / 2.0;
        match side {
            Side::Left => Slider {
                offset,
                base: l.l10,
                front: l.l14,
                rear: l.l11,
                nominal: l.l12 + l.l13,
            },
            Side::Right => Slider {
                offset,
                base: l.l15,
                front: l.l19,
                rear: l.l16,
                nominal: l.l17 + l.l18,
            },
        }
    }

    /// y of the middle of an end's base, mm, chassis frame.
    #[inline]
    pub const fn base_y(&self, end: End) -> f64 {
        end.sign() * self.links.l10 / 2.0
    }

    /// A point of an end's own frame in the chassis frame, mm.
    #[inline(always)]
    pub fn to_chassis<T: Real>(&self, end: End, point: Vector<T>) -> Vector<T> {
        end.mirror(point) + Vector::of(Vector::new(0.0, self.base_y(end)))
    }

    /// A point of the chassis frame in an end's own frame, mm.
    #[inline(always)]
    pub fn to_end<T: Real>(&self, end: End, point: Vector<T>) -> Vector<T> {
        end.mirror(point - Vector::of(Vector::new(0.0, self.base_y(end))))
    }

    /// Shafts of A1, A2, A3, A4 in mm, chassis frame.
    pub fn shafts(&self) -> [Vector; 4] {
        let mut shafts = [Vector::default(); 4];
        for end in End::ALL {
            let ([left, right], bars) = (end.servos(), self.end(end));
            shafts[left] = self.to_chassis(end, bars.left_shaft());
            shafts[right] = self.to_chassis(end, bars.right_shaft());
        }
        shafts
    }

    /// The whole robot at a pose.
    ///
    /// # Errors
    /// The first loop that does not close, and why: see [`FiveBar::forward`] and
    /// [`Slider::forward`].
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
        let head = self.end(End::Head).closes(&solution.head);
        let tail = self.end(End::Tail).closes(&solution.tail);
        let left = self.side(Side::Left).closes(&solution.left);
        let right = self.side(Side::Right).closes(&solution.right);
        let mut closes = [false; N];
        for i in 0..N {
            closes[i] = head[i] && tail[i] && left[i] && right[i];
        }
        closes
    }

    /// Why a solution has no meaning, if it has none.
    #[inline]
    fn check(&self, solution: &Solution) -> Result<(), Infeasible> {
        let at = |part: Part| move |fault: Fault| Infeasible { part, fault };
        for end in End::ALL {
            let checked = self.end(end).check(solution.end(end));
            checked.map_err(at(Part::End(end)))?;
        }
        for side in Side::ALL {
            let checked = self.side(side).check(solution.side(side));
            checked.map_err(at(Part::Side(side)))?;
        }
        Ok(())
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
        let head = self.shape_end(End::Head, cranks);
        let tail = self.shape_end(End::Tail, cranks);
        let left = self.shape_side(Side::Left, cranks);
        let right = self.shape_side(Side::Right, cranks);
        let mut legs = [self.leg.shape(End::Head, angles[0], cranks[0]); 4];
        for i in 1..4 {
            legs[i] = self.leg.shape(End::of_servo(i), angles[i], cranks[i]);
        }
        let mut type1 = [head.type2; 4];
        for (end, bars) in [(End::Head, &head), (End::Tail, &tail)] {
            let [left, right] = end.servos();
            type1[left] = bars.type1_left();
            type1[right] = bars.type1_right();
        }
        Solution {
            pose: *pose,
            head,
            tail,
            left,
            right,
            legs,
            margins: Margins {
                type2: [head.type2, tail.type2],
                type1,
                leg: [
                    legs[0].margin,
                    legs[1].margin,
                    legs[2].margin,
                    legs[3].margin,
                ],
            },
            lizard: *self,
        }
    }

    /// The five-bar of an end at crank directions in servo order (length one,
    /// chassis frame), of one robot or in several lanes; only the end's own two
    /// are read. It has a meaning only where [`FiveBar::closes`] says so.
    #[inline(always)]
    pub fn shape_end<T: Real>(&self, end: End, cranks: [Vector<T>; 4]) -> FiveBarPose<T> {
        let [left, right] = end.pick(cranks);
        self.end(end)
            .shape(AssemblyMode::Ahead, end.mirror(left), end.mirror(right))
    }

    /// The slider of a side at crank directions in servo order (length one,
    /// chassis frame), likewise.
    #[inline(always)]
    pub fn shape_side<T: Real>(&self, side: Side, cranks: [Vector<T>; 4]) -> SliderPose<T> {
        let [front, rear] = side.pick(cranks);
        self.side(side)
            .shape(side.rear_arm(rear), side.front_arm(front))
    }

    /// The margins at a pose; no arc tangents are taken.
    ///
    /// # Errors
    /// As [`Lizard::solve`].
    pub fn margins(&self, pose: &Pose) -> Result<Margins, Infeasible> {
        self.solve(pose).map(|solution| solution.margins)
    }

    /// The angles of an end's two servos (degrees in (-180, 180], chassis frame)
    /// that put its end point at a point in mm of the end's own frame, with
    /// outward elbows. In servo order: A1, A2 or A3, A4.
    ///
    /// # Errors
    /// As [`FiveBar::inverse`].
    pub fn point_angles(&self, end: End, point: Vector) -> Result<[f64; 2], Infeasible> {
        let part = Part::End(end);
        let [outward, ..] = self
            .end(end)
            .inverse(point)
            .map_err(|fault| Infeasible { part, fault })?;
        let [left, right] =
            [outward.theta_left, outward.theta_right].map(|theta| end.mirror_angle(theta));
        Ok(match end {
            End::Head => [left, right],
            End::Tail => [right, left],
        })
    }
}
