//! The conditions of the guard for the head or tail five-bar over a cell: the sines at its couplers, elbows and legs.
//!
//! While the crank angles change from the cell's centre to any other pose of the cell, each crank tip moves by at
//! most crank length times angle, and the line `k` between the tips changes by at most the sum. Three bounds follow:
//!
//! * The distance of the tips is in a range, and so is the sine between the couplers, the type-2 margin;
//!   [`bounds::EndErrors::min_type2`] is its smallest value. The tips cannot cross if their distance along the base
//!   is more than the two tips can move.
//! * From `a u2 - b u3 = k`, with couplers of directions `u2` and `u3` over the line `k`: the left coupler turns by
//!   at most `|dk| / (a sin(theta3 - theta2))`, and the right one by the same with `b` instead of `a`. Each crank
//!   turns by at most half the width of its range. So the type-1 margin, a sine, is smaller than at the centre by
//!   at most the sum of the turns of crank and coupler.
//! * A leg's margin is the sine of its own crank angle, which is smallest at an end point of the angle's range.
//!
//! The guard computes with integers. Its margins are smaller than these by at most their error bounds, and must
//! still keep the guard's limits.

use lizard_core::guard::bounds::{self, MAX_DIRECTION_ERROR};
use lizard_core::numbers::limits::Limits;
use lizard_core::numbers::section::Content;
use lizard_core::numbers::units::Sine;
use lizard_kinematics::{AssemblyMode, End, FiveBar, Lizard, Vector};

use super::cell::{Cell, Condition, ROUNDING_ALLOWANCE, Span, Verdict};
use crate::units::ONE_Q15;

/// The conditions of the guard for the head or tail five-bar.
pub(super) struct EndConditions {
    end: End,
    bars: FiveBar,
    integers: bounds::RoundedBars,
    type2: f64,
    type1: f64,
    leg: f64,
}

impl EndConditions {
    pub fn new(lizard: &Lizard, numbers: &Content, end: End) -> Self {
        let integers = &numbers.ends[end as usize];
        let Limits { type2, type1, leg } = numbers.limits;
        let sine_of = |limit: Sine| f64::from(limit.0) / ONE_Q15;
        Self {
            end,
            bars: lizard.end(end),
            integers: bounds::RoundedBars {
                scale: integers.scale,
                couplers: integers.couplers,
            },
            type2: sine_of(type2),
            type1: sine_of(type1),
            leg: sine_of(leg),
        }
    }

    /// Returns the smallest sine of a leg over a range of its servo's angles, which is narrower than half a turn.
    fn least_leg_sine(&self, span: &Span) -> f64 {
        let half = span.half();
        let Vector { x: cos, y: sin } = self.end.mirror(span.direction());
        // The centre, rotated by half the range in either direction.
        sin * half.cos() - cos.abs() * half.sin()
    }
}

impl Condition for EndConditions {
    fn servos(&self) -> [usize; 2] {
        match self.end {
            End::Head => [0, 1],
            End::Tail => [2, 3],
        }
    }

    fn judge(&self, cell: &Cell) -> Verdict {
        let [left, right] = match self.end {
            End::Head => cell.0,
            End::Tail => [cell.0[1], cell.0[0]],
        };
        let directions = [left, right].map(|span| self.end.mirror(span.direction()));
        let [left_crank, right_crank] = directions;
        let Ok(pose) = self
            .bars
            .close(AssemblyMode::Ahead, left_crank, right_crank)
        else {
            return Verdict::Broken;
        };
        let type1 = [pose.type1_left(), pose.type1_right()];
        let keeps_limits = pose.gap.x > 0.0
            && pose.type2 >= self.type2
            && type1.iter().all(|margin| *margin >= self.type1)
            && directions.iter().all(|crank| crank.y >= self.leg);
        if !keeps_limits {
            return Verdict::Broken;
        }

        let crank_movement =
            self.bars.crank_left * left.half() + self.bars.crank_right * right.half();
        let tip_distance = pose.gap.length();
        let range = [
            (tip_distance - crank_movement).max(0.0),
            tip_distance + crank_movement,
        ];
        let errors = bounds::EndErrors::between(&self.bars, self.integers, range);
        let is_uncrossed = pose.gap.x - crank_movement > errors.along + ROUNDING_ALLOWANCE;
        if !(errors.is_known && is_uncrossed) {
            return Verdict::Open;
        }
        let coupler_turn = |coupler: f64| crank_movement / (coupler * errors.min_type2);
        let elbow_losses = [
            left.half() + coupler_turn(self.bars.coupler_left) + errors.type1_left,
            right.half() + coupler_turn(self.bars.coupler_right) + errors.type1_right,
        ];
        let is_kept = errors.min_type2 - errors.type2 >= self.type2 + ROUNDING_ALLOWANCE
            && type1
                .iter()
                .zip(elbow_losses)
                .all(|(margin, loss)| margin - loss >= self.type1 + ROUNDING_ALLOWANCE)
            && [left, right].iter().all(|span| {
                self.least_leg_sine(span) - MAX_DIRECTION_ERROR >= self.leg + ROUNDING_ALLOWANCE
            });
        if is_kept {
            Verdict::Kept
        } else {
            Verdict::Open
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::robot;

    /// Makes a cell of a single pose, the neutral one, for the head of a robot without symmetry, and conditions whose
    /// limits every pose keeps.
    fn neutral_cell() -> (EndConditions, Cell) {
        let robot = robot("unequal");
        let numbers = robot.content();
        let rule = EndConditions {
            type2: 0.0,
            type1: -1.0,
            leg: 0.0,
            ..EndConditions::new(robot.lizard(), numbers, End::Head)
        };
        let span_of = |servo: usize| {
            let angle = f64::from(numbers.neutral[servo].0);
            Span {
                low: angle,
                high: angle,
            }
        };
        (rule, Cell([span_of(0), span_of(1)]))
    }

    type Limit = fn(&mut EndConditions) -> &mut f64;

    #[test]
    fn a_single_pose_is_proved_if_clear_of_each_limit_by_the_rounding_error() {
        let (mut rule, cell) = neutral_cell();
        // Without limits every pose passes.
        assert_eq!(rule.judge(&cell), Verdict::Kept);
        let cranks = cell.0.map(|span| span.direction());
        let [left, right] = cranks;
        let pose = rule.bars.close(AssemblyMode::Ahead, left, right);
        let pose = pose.expect("it stands");
        let tip_distance = pose.gap.length();
        let errors = bounds::EndErrors::between(&rule.bars, rule.integers, [tip_distance; 2]);
        let (lower, bound) = if pose.type1_left() < pose.type1_right() {
            (pose.type1_left(), errors.type1_left)
        } else {
            (pose.type1_right(), errors.type1_right)
        };
        let limits: [(Limit, f64, f64); 3] = [
            (|rule| &mut rule.type2, pose.type2, errors.type2),
            (|rule| &mut rule.type1, lower, bound),
            (
                |rule| &mut rule.leg,
                left.y.min(right.y),
                MAX_DIRECTION_ERROR,
            ),
        ];
        for (limit, value, bound) in limits {
            assert!(bound > 1e-5 && bound < 0.01, "{bound}");
            let unlimited = *limit(&mut rule);
            for (clearance, verdict) in [
                (1.01 * bound, Verdict::Kept),
                (0.99 * bound, Verdict::Open),
                (0.01 * bound, Verdict::Open),
                (-0.01 * bound, Verdict::Broken),
            ] {
                *limit(&mut rule) = value - clearance;
                assert_eq!(rule.judge(&cell), verdict, "{value} {clearance}");
            }
            *limit(&mut rule) = unlimited;
        }
    }

    #[test]
    fn crank_tips_that_may_have_crossed_prove_nothing() {
        let (rule, _) = neutral_cell();
        let per_step = f64::from(rule.integers.scale.bits).exp2().recip();
        let span_at = |degrees: f64| {
            let angle = degrees * 65536.0 / 360.0;
            Span {
                low: angle,
                high: angle,
            }
        };
        // The right crank leans far to the left, so that one tip passes well above the other and the linkage closes.
        let right = span_at(165.0);
        let gap_at = |left: Span| {
            let left = left.direction();
            rule.bars
                .pose_unchecked(AssemblyMode::Ahead, left, right.direction())
                .gap
                .x
        };
        // Bisects for the left crank's angle at which one tip is directly above the other.
        let (mut apart_deg, mut crossed_deg) = (150.0, 10.0);
        assert!(gap_at(span_at(apart_deg)) > 0.0 && gap_at(span_at(crossed_deg)) < 0.0);
        for _ in 0..60 {
            let middle = (apart_deg + crossed_deg) / 2.0;
            if gap_at(span_at(middle)) > 0.0 {
                apart_deg = middle;
            } else {
                crossed_deg = middle;
            }
        }
        let judge_at = |mm: f64| {
            let slope = rule.bars.crank_left * apart_deg.to_radians().sin();
            let left = span_at(apart_deg + (mm / slope).to_degrees());
            assert!((gap_at(left) - mm).abs() < per_step);
            rule.judge(&Cell([left, right]))
        };
        assert_eq!(judge_at(-per_step), Verdict::Broken);
        assert_eq!(judge_at(per_step), Verdict::Open);
        assert_eq!(judge_at(20.0 * per_step), Verdict::Kept);
    }
}
