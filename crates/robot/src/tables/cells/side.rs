//! The condition of a side over a cell: its slider stays within its stroke.
//!
//! While the servo angles change from the cell's centre to any other pose of the cell, the tip of each arm moves by
//! at most arm length times angle, and the slider's length changes by at most the sum. With the error bound of the
//! guard's integers added, the length must still be within the guard's stroke.

use lizard_core::guard::bounds;
use lizard_core::numbers::section::Content;
use lizard_kinematics::{Lizard, Side, Slider};

use super::cell::{Cell, Condition, ROUNDING_ALLOWANCE, Verdict};
use crate::measures::scale;

/// The condition that a side's slider stays within its stroke.
pub(super) struct StrokeCondition {
    side: Side,
    slider: Slider,
    /// Error bound of the integers, mm.
    error: f64,
    /// Smallest length of the slider within its stroke, mm; `max` is the largest.
    min: f64,
    max: f64,
}

impl StrokeCondition {
    pub fn new(lizard: &Lizard, numbers: &Content, side: Side) -> Self {
        let integers = &numbers.sides[side as usize];
        let slider = lizard.side(side);
        let mm_of = |steps: u16| f64::from(steps) / scale::steps_per_mm(integers.scale);
        Self {
            side,
            slider,
            error: bounds::slider_error(&slider, integers),
            min: mm_of(integers.min),
            max: mm_of(integers.max),
        }
    }

    /// Length of the slider at the centre of a cell, mm.
    fn length(&self, cell: &Cell) -> f64 {
        let [front, rear] = cell.0.map(|span| span.direction());
        let (rear, front) = (self.side.rear_arm(rear), self.side.front_arm(front));
        self.slider.shape(rear, front).d
    }
}

impl Condition for StrokeCondition {
    fn servos(&self) -> [usize; 2] {
        self.side.servos()
    }

    fn judge(&self, cell: &Cell) -> Verdict {
        let [front, rear] = cell.0;
        let length = self.length(cell);
        let clearance = (length - self.min).min(self.max - length);
        if clearance < 0.0 {
            return Verdict::Broken;
        }
        let arm_movement = self.slider.front * front.half() + self.slider.rear * rear.half();
        if clearance - arm_movement - self.error >= ROUNDING_ALLOWANCE {
            Verdict::Kept
        } else {
            Verdict::Open
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tables::cells::cell::Span;
    use crate::testing::robot;

    #[test]
    fn a_single_pose_is_proved_if_its_slider_clears_both_ends_by_the_rounding() {
        let robot = robot("unequal");
        let numbers = robot.content();
        for side in Side::ALL {
            let mut rule = StrokeCondition::new(robot.lizard(), numbers, side);
            let spans = side.servos().map(|servo| {
                let angle = f64::from(numbers.neutral[servo].0);
                Span {
                    low: angle,
                    high: angle,
                }
            });
            let cell = Cell(spans);
            assert_eq!(rule.judge(&cell), Verdict::Kept);
            let length = rule.length(&cell);
            for (clearance, verdict) in [
                (1.01, Verdict::Kept),
                (0.99, Verdict::Open),
                (0.01, Verdict::Open),
                (-0.01, Verdict::Broken),
            ] {
                let (min, max) = (rule.min, rule.max);
                rule.min = length - clearance * rule.error;
                assert_eq!(
                    rule.judge(&cell),
                    verdict,
                    "{side} {clearance} from the shortest"
                );
                rule.min = min;
                rule.max = length + clearance * rule.error;
                assert_eq!(
                    rule.judge(&cell),
                    verdict,
                    "{side} {clearance} from the longest"
                );
                rule.max = max;
            }
        }
    }
}
