//! The forward kinematics of the complete robot: all joints from four servo angles (the paper's Algorithm 1).

use crate::angle::sin_cos_all;
use crate::end::End;
use crate::fault::{Fault, InfeasiblePose, Mechanism};
use crate::five_bar::{AssemblyMode, FiveBar, FiveBarPose};
use crate::leg::{Leg, LegPose};
use crate::links::Links;
use crate::margins::Margins;
use crate::real::Real;
use crate::side::Side;
use crate::slider::{Slider, SliderPose};
use crate::vector::Vector;

/// A pose of the robot: four servo angles in degrees, chassis frame, declared in servo order. Each may be any finite
/// angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Angle of A1, left front.
    pub theta1: f64,
    /// Angle of A2, right front.
    pub theta4: f64,
    /// Angle of A3, right hind.
    pub theta8: f64,
    /// Angle of A4, left hind.
    pub theta5: f64,
}

impl From<[f64; 4]> for Pose {
    /// Creates a pose from the angles of A1, A2, A3, A4.
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
    /// Returns the angles of A1, A2, A3, A4.
    fn from(pose: Pose) -> Self {
        [pose.theta1, pose.theta4, pose.theta8, pose.theta5]
    }
}

/// The dimensions of a robot. The chassis is a rectangle with a shaft near each corner, so
/// l10 = l15; every leg is a parallelogram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lizard {
    /// Links of the body.
    pub links: Links,
    /// Links of each leg.
    pub leg: Leg,
}

/// The positions of all joints of the robot in a pose, and its margins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solution {
    /// The servo angles of this solution.
    pub pose: Pose,
    /// The head's five-bar in its own frame, which has the axes of the chassis frame and its
    /// origin in the middle of l0.
    pub head: FiveBarPose,
    /// The tail's five-bar in its own frame: origin in the middle of l5, y backward. Its left
    /// crank is that of A4. See [`Solution::point`] for the chassis frame.
    pub tail: FiveBarPose,
    /// The slider between A1 and A4, in the axes of the chassis frame.
    pub left: SliderPose,
    /// The slider between A2 and A3, in the axes of the chassis frame.
    pub right: SliderPose,
    /// The legs in servo order: left front, right front, right hind, left hind.
    pub legs: [LegPose; 4],
    /// The margins from all singularities and change points.
    pub margins: Margins,
    /// The robot that was solved.
    lizard: Lizard,
}

impl Solution {
    /// theta2: angle of the head's left coupler, degrees, chassis frame.
    pub fn theta2(&self) -> f64 {
        self.coupler_directions(End::Head)[0].angle()
    }

    /// theta3: angle of the head's right coupler, degrees, chassis frame.
    pub fn theta3(&self) -> f64 {
        self.coupler_directions(End::Head)[1].angle()
    }

    /// theta6: angle of the tail's left coupler, degrees, chassis frame.
    pub fn theta6(&self) -> f64 {
        self.coupler_directions(End::Tail)[0].angle()
    }

    /// theta7: angle of the tail's right coupler, degrees, chassis frame.
    pub fn theta7(&self) -> f64 {
        self.coupler_directions(End::Tail)[1].angle()
    }

    /// The five-bar of an end, in the end's own frame.
    pub const fn end(&self, end: End) -> &FiveBarPose {
        match end {
            End::Head => &self.head,
            End::Tail => &self.tail,
        }
    }

    /// The slider of a side.
    pub const fn side(&self, side: Side) -> &SliderPose {
        match side {
            Side::Left => &self.left,
            Side::Right => &self.right,
        }
    }

    /// The point of the head or the tail, mm, chassis frame.
    pub fn point(&self, end: End) -> Vector {
        self.lizard.to_chassis(end, self.end(end).end_point)
    }

    /// The head point, mm, chassis frame.
    pub fn head_point(&self) -> Vector {
        self.point(End::Head)
    }

    /// The tail point, mm, chassis frame.
    pub fn tail_point(&self) -> Vector {
        self.point(End::Tail)
    }

    /// The directions of an end's left and right couplers, length one, chassis frame.
    pub fn coupler_directions(&self, end: End) -> [Vector; 2] {
        let pose = self.end(end);
        [pose.left_coupler, pose.right_coupler].map(|coupler| end.mirror(coupler))
    }

    /// The tips of the four cranks in servo order, mm, chassis frame.
    pub fn crank_tips(&self) -> [Vector; 4] {
        let mut tips = [self.head.left_tip; 4];
        for end in End::ALL {
            let ([left, right], pose) = (end.servos(), self.end(end));
            tips[left] = self.lizard.to_chassis(end, pose.left_tip);
            tips[right] = self.lizard.to_chassis(end, pose.right_tip);
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
            End::Head => FiveBar::new([l.l0, l.l1, l.l2, l.l3, l.l4]),
            End::Tail => FiveBar::new([l.l5, l.l6, l.l7, l.l8, l.l9]),
        }
    }

    /// The slider of a side.
    #[inline]
    pub const fn side(&self, side: Side) -> Slider {
        let l = &self.links;
        let (base, front, rear, nominal) = match side {
            Side::Left => (l.l10, l.l14, l.l11, l.l12 + l.l13),
            Side::Right => (l.l15, l.l19, l.l16, l.l17 + l.l18),
        };
        Slider {
            front_offset: side.sign() * (l.l5 - l.l0) / 2.0,
            base,
            front_arm: front,
            rear_arm: rear,
            nominal_length: nominal,
        }
    }

    /// The y coordinate of the middle of an end's base, mm, chassis frame.
    #[inline]
    pub const fn base_y(&self, end: End) -> f64 {
        end.sign() * self.links.l10 / 2.0
    }

    /// Converts a point from an end's own frame to the chassis frame, mm.
    #[inline(always)]
    pub fn to_chassis<T: Real>(&self, end: End, point: Vector<T>) -> Vector<T> {
        end.mirror(point) + Vector::constant(Vector::new(0.0, self.base_y(end)))
    }

    /// Converts a point from the chassis frame to an end's own frame, mm.
    #[inline(always)]
    pub fn to_end<T: Real>(&self, end: End, point: Vector<T>) -> Vector<T> {
        end.mirror(point - Vector::constant(Vector::new(0.0, self.base_y(end))))
    }

    /// The shafts of A1, A2, A3, A4, mm, chassis frame.
    pub fn shafts(&self) -> [Vector; 4] {
        let mut shafts = [Vector::default(); 4];
        for end in End::ALL {
            let ([left, right], five_bar) = (end.servos(), self.end(end));
            shafts[left] = self.to_chassis(end, five_bar.left_shaft());
            shafts[right] = self.to_chassis(end, five_bar.right_shaft());
        }
        shafts
    }

    /// Solves the complete robot at a pose.
    ///
    /// # Errors
    /// Returns the first loop that does not close, and its fault: see [`FiveBar::forward`] and [`Slider::forward`].
    #[inline]
    pub fn solve(&self, pose: &Pose) -> Result<Solution, InfeasiblePose> {
        let solution = self.solve_unchecked(pose);
        self.check_loops(&solution)?;
        Ok(solution)
    }

    /// Checks that every loop of a solution closes.
    #[inline]
    fn check_loops(&self, solution: &Solution) -> Result<(), InfeasiblePose> {
        let infeasible_at =
            |mechanism: Mechanism| move |fault: Fault| InfeasiblePose { mechanism, fault };
        for end in End::ALL {
            let closure = self.end(end).check_pose(solution.end(end));
            closure.map_err(infeasible_at(Mechanism::End(end)))?;
        }
        for side in Side::ALL {
            let closure = self.side(side).check_pose(solution.side(side));
            closure.map_err(infeasible_at(Mechanism::Side(side)))?;
        }
        Ok(())
    }

    /// Evaluates all closed forms, without a check that the loops close.
    #[inline]
    fn solve_unchecked(&self, pose: &Pose) -> Solution {
        let angles: [f64; 4] = (*pose).into();
        let (sines, cosines) = sin_cos_all(angles);
        let cranks = core::array::from_fn(|i| Vector::new(cosines[i], sines[i]));
        let head = self.end_pose_unchecked(End::Head, cranks);
        let tail = self.end_pose_unchecked(End::Tail, cranks);
        let leg_pose = |i: usize| self.leg.pose_at(End::from_servo(i), angles[i], cranks[i]);
        let legs: [LegPose; 4] = core::array::from_fn(leg_pose);
        let mut type1 = [head.type2; 4];
        for (end, pose) in [(End::Head, &head), (End::Tail, &tail)] {
            let [left, right] = end.servos();
            type1[left] = pose.type1_left();
            type1[right] = pose.type1_right();
        }
        Solution {
            pose: *pose,
            head,
            tail,
            left: self.side_pose_unchecked(Side::Left, cranks),
            right: self.side_pose_unchecked(Side::Right, cranks),
            legs,
            margins: Margins {
                type2: [head.type2, tail.type2],
                type1,
                leg: legs.map(|leg| leg.margin),
            },
            lizard: *self,
        }
    }

    /// The five-bar of an end at four crank directions in servo order (length one, chassis frame), of which only the
    /// end's own two are used. It is meaningless if the loop does not close: see [`FiveBar::are_loops_closed`].
    #[inline(always)]
    pub fn end_pose_unchecked<T: Real>(&self, end: End, cranks: [Vector<T>; 4]) -> FiveBarPose<T> {
        let [left, right] = end.pick(cranks);
        self.end(end)
            .pose_unchecked(AssemblyMode::Ahead, end.mirror(left), end.mirror(right))
    }

    /// The slider of a side at four crank directions in servo order (length one, chassis frame), of which only the
    /// side's own two are used. It is meaningless if the slider has no direction: see [`Slider::are_loops_closed`].
    #[inline(always)]
    pub fn side_pose_unchecked<T: Real>(
        &self,
        side: Side,
        cranks: [Vector<T>; 4],
    ) -> SliderPose<T> {
        let [front, rear] = side.pick(cranks);
        self.side(side)
            .pose_unchecked(side.rear_arm(rear), side.front_arm(front))
    }

    /// The margins of a pose.
    ///
    /// # Errors
    /// Fails as [`Lizard::solve`] does.
    pub fn margins(&self, pose: &Pose) -> Result<Margins, InfeasiblePose> {
        self.solve(pose).map(|solution| solution.margins)
    }

    /// The angles of an end's two servos ((-180, 180] degrees, chassis frame) that put its end point at `point` (mm,
    /// the end's own frame) with both elbows outward. In servo order: A1, A2 for the head; A3, A4 for the tail.
    ///
    /// # Errors
    /// Fails as [`FiveBar::inverse`] does.
    pub fn point_angles(&self, end: End, point: Vector) -> Result<[f64; 2], InfeasiblePose> {
        let mechanism = Mechanism::End(end);
        let solutions = self.end(end).inverse(point);
        let [solution, ..] = solutions.map_err(|fault| InfeasiblePose { mechanism, fault })?;
        let angles = [solution.theta_left, solution.theta_right];
        let [left, right] = angles.map(|theta| end.mirror_angle(theta));
        Ok(match end {
            End::Head => [left, right],
            End::Tail => [right, left],
        })
    }
}
