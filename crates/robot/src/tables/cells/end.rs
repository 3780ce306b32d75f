//! The conditions of the guard for the head or tail five-bar over a cell: limits of the sines at its couplers, elbows
//! and legs.
//!
//! Between the cell's centre and any other pose of the cell, each crank tip moves by at most its crank's length times
//! the angle of the crank's turn, and the vector `k` between the tips changes by at most the sum `|dk|` of both. Three
//! bounds follow:
//!
//! * The tip distance is within a range, and so is the type-2 margin, the sine of the angle between the couplers;
//!   [`MarginErrors::min_type2`] is the margin's smallest value. The tips cannot cross if their distance along the base
//!   is more than the sum of both movements.
//! * The couplers close the loop: `a u2 - b u3 = k`, with their lengths `a` and `b` and their directions `u2` and `u3`.
//!   The left coupler therefore turns by at most `|dk| / (a sin(theta3 - theta2))`, and the right coupler by at most
//!   the same with `b` instead of `a`. Each crank turns by at most half the width of its range. The type-1 margin is a
//!   sine, so it is smaller than at the centre by at most the sum of both rotations.
//! * A leg's margin is the sine of its own crank angle, which is smallest at an end point of the angle's range.
//!
//! The guard computes with integers. Its margins are smaller than the true margins by at most their error bounds, and
//! must still meet the guard's limits.

use lizard_core::guard::bounds::{MAX_DIRECTION_ERROR, MarginErrors};
use lizard_core::numbers::limits::Limits;
use lizard_core::numbers::section::{Content, FiveBarLengths};
use lizard_core::numbers::units::Sine;
use lizard_kinematics::{AssemblyMode, End, FiveBar, Lizard, Vector};

use super::cell::{Cell, Condition, ROUNDING_ALLOWANCE, Span, Verdict};
use crate::units::ONE_Q15;

/// The conditions of the guard for the head or tail five-bar.
pub(super) struct EndConditions {
    end: End,
    /// The five-bar with its true lengths.
    five_bar: FiveBar,
    /// The lengths in the guard's integers.
    rounded_lengths: FiveBarLengths,
    /// Smallest type-2 margin that the guard allows, a sine.
    type2_limit: f64,
    /// Smallest type-1 margin that the guard allows, a sine.
    type1_limit: f64,
    /// Smallest margin of a leg that the guard allows, a sine.
    leg_limit: f64,
}

impl EndConditions {
    /// Creates the conditions of one end of a robot, with the guard's limits.
    pub fn new(lizard: &Lizard, numbers: &Content, end: End) -> Self {
        let Limits { type2, type1, leg } = numbers.limits;
        let to_sine = |limit: Sine| f64::from(limit.0) / ONE_Q15;
        Self {
            end,
            five_bar: lizard.end(end),
            rounded_lengths: numbers.ends[end as usize],
            type2_limit: to_sine(type2),
            type1_limit: to_sine(type1),
            leg_limit: to_sine(leg),
        }
    }

    /// Returns a leg's smallest sine over a range of its servo's angles, which must be narrower than half a turn.
    fn min_leg_sine(&self, span: &Span) -> f64 {
        let half_width = span.half_width_rad();
        let Vector { x: cos, y: sin } = self.end.mirror(span.direction());
        // The centre, rotated by half the range in either direction.
        sin * half_width.cos() - cos.abs() * half_width.sin()
    }
}

impl Condition for EndConditions {
    fn servos(&self) -> [usize; 2] {
        match self.end {
            End::Head => [0, 1],
            End::Tail => [2, 3],
        }
    }

    fn evaluate(&self, cell: &Cell) -> Verdict {
        let [left, right] = match self.end {
            End::Head => cell.0,
            End::Tail => [cell.0[1], cell.0[0]],
        };
        let directions = [left, right].map(|span| self.end.mirror(span.direction()));
        let [left_crank, right_crank] = directions;
        let Ok(pose) = self
            .five_bar
            .close(AssemblyMode::Ahead, left_crank, right_crank)
        else {
            return Verdict::Violated;
        };
        let type1 = [pose.type1_left(), pose.type1_right()];
        let meets_limits = pose.gap.x > 0.0
            && pose.type2 >= self.type2_limit
            && type1.iter().all(|margin| *margin >= self.type1_limit)
            && directions.iter().all(|crank| crank.y >= self.leg_limit);
        if !meets_limits {
            return Verdict::Violated;
        }

        let crank_movement = self.five_bar.left_crank_length * left.half_width_rad()
            + self.five_bar.right_crank_length * right.half_width_rad();
        let tip_distance = pose.gap.length();
        let tip_distance_range = [
            (tip_distance - crank_movement).max(0.0),
            tip_distance + crank_movement,
        ];
        let errors =
            MarginErrors::over_range(&self.five_bar, &self.rounded_lengths, tip_distance_range);
        let is_uncrossed = pose.gap.x - crank_movement > errors.gap_x + ROUNDING_ALLOWANCE;
        if !(errors.do_bounds_hold && is_uncrossed) {
            return Verdict::Undetermined;
        }
        let coupler_rotation = |coupler: f64| crank_movement / (coupler * errors.min_type2);
        let type1_losses = [
            left.half_width_rad()
                + coupler_rotation(self.five_bar.left_coupler_length)
                + errors.type1_left,
            right.half_width_rad()
                + coupler_rotation(self.five_bar.right_coupler_length)
                + errors.type1_right,
        ];
        let is_proven = errors.min_type2 - errors.type2 >= self.type2_limit + ROUNDING_ALLOWANCE
            && type1
                .iter()
                .zip(type1_losses)
                .all(|(margin, loss)| margin - loss >= self.type1_limit + ROUNDING_ALLOWANCE)
            && [left, right].iter().all(|span| {
                self.min_leg_sine(span) - MAX_DIRECTION_ERROR >= self.leg_limit + ROUNDING_ALLOWANCE
            });
        match is_proven {
            true => Verdict::Proven,
            false => Verdict::Undetermined,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tables::cells::cell::VERDICTS_BY_CLEARANCE;
    use crate::testing::robot;

    /// Creates conditions whose limits every pose meets, for the head of an asymmetrical robot, and a cell of the
    /// neutral pose alone.
    fn create_neutral_cell() -> (EndConditions, Cell) {
        let robot = robot("unequal");
        let numbers = robot.content();
        let conditions = EndConditions {
            type2_limit: 0.0,
            type1_limit: -1.0,
            leg_limit: 0.0,
            ..EndConditions::new(robot.lizard(), numbers, End::Head)
        };
        let spans = [0, 1].map(|servo| Span::single_angle(numbers.neutral_angles[servo].0.into()));
        (conditions, Cell(spans))
    }

    /// A function that selects one of the limits.
    type LimitSelector = fn(&mut EndConditions) -> &mut f64;

    #[test]
    fn a_single_pose_is_proven_if_it_clears_each_limit_by_the_error_bound() {
        let (mut conditions, cell) = create_neutral_cell();
        // Without limits every pose is proven.
        assert_eq!(conditions.evaluate(&cell), Verdict::Proven);
        let cranks = cell.0.map(|span| span.direction());
        let [left, right] = cranks;
        let pose = conditions.five_bar.close(AssemblyMode::Ahead, left, right);
        let pose = pose.expect("the neutral pose closes");
        let tip_distance = pose.gap.length();
        let (five_bar, lengths) = (&conditions.five_bar, &conditions.rounded_lengths);
        let errors = MarginErrors::over_range(five_bar, lengths, [tip_distance; 2]);
        let type1 = match pose.type1_left() < pose.type1_right() {
            true => (pose.type1_left(), errors.type1_left),
            false => (pose.type1_right(), errors.type1_right),
        };
        let type2 = (pose.type2, errors.type2);
        let leg = (left.y.min(right.y), MAX_DIRECTION_ERROR);
        let limits: [(LimitSelector, (f64, f64)); 3] = [
            (|conditions| &mut conditions.type2_limit, type2),
            (|conditions| &mut conditions.type1_limit, type1),
            (|conditions| &mut conditions.leg_limit, leg),
        ];
        for (select_limit, (value, bound)) in limits {
            assert!(bound > 1e-5 && bound < 0.01, "the bound is {bound}");
            let unlimited = *select_limit(&mut conditions);
            for (clearance, verdict) in VERDICTS_BY_CLEARANCE {
                *select_limit(&mut conditions) = value - clearance * bound;
                let actual = conditions.evaluate(&cell);
                assert_eq!(actual, verdict, "value {value}, {clearance} bounds");
            }
            *select_limit(&mut conditions) = unlimited;
        }
    }

    #[test]
    fn crank_tips_that_may_be_crossed_leave_a_cell_undetermined() {
        let (conditions, _) = create_neutral_cell();
        let scale_bits = f64::from(conditions.rounded_lengths.scale.bits);
        let mm_per_step = scale_bits.exp2().recip();
        let span_at = |degrees: f64| Span::single_angle(degrees * 65536.0 / 360.0);
        // The right crank leans far to the left, so that one tip passes well above the other and the linkage closes.
        let right = span_at(165.0);
        let gap_at = |left: Span| {
            let (left, right) = (left.direction(), right.direction());
            let five_bar = &conditions.five_bar;
            let pose = five_bar.pose_unchecked(AssemblyMode::Ahead, left, right);
            pose.gap.x
        };
        // Bisects for the left crank's angle at which one tip is directly above the other.
        let (mut apart_deg, mut crossed_deg) = (150.0, 10.0);
        assert!(gap_at(span_at(apart_deg)) > 0.0 && gap_at(span_at(crossed_deg)) < 0.0);
        for _ in 0..60 {
            let middle = (apart_deg + crossed_deg) / 2.0;
            match gap_at(span_at(middle)) > 0.0 {
                true => apart_deg = middle,
                false => crossed_deg = middle,
            }
        }
        let evaluate_at = |mm: f64| {
            let slope = conditions.five_bar.left_crank_length * apart_deg.to_radians().sin();
            let left = span_at(apart_deg + (mm / slope).to_degrees());
            assert!((gap_at(left) - mm).abs() < mm_per_step);
            conditions.evaluate(&Cell([left, right]))
        };
        assert_eq!(evaluate_at(-mm_per_step), Verdict::Violated);
        assert_eq!(evaluate_at(mm_per_step), Verdict::Undetermined);
        assert_eq!(evaluate_at(20.0 * mm_per_step), Verdict::Proven);
    }
}
