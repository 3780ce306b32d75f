//! Checks that the slider of one side stays within its stroke at every pose of a cell.
//!
//! Between the cell's centre and any other pose of the cell, each arm tip moves by at most the arm's length times the
//! arm's rotation, and the slider's length changes by at most the sum of the movements of both tips. With the error
//! bound of the guard's integers added, the length must still be within the guard's stroke.

use lizard_core::guard::bounds;
use lizard_core::numbers::section::Content;
use lizard_kinematics::{Lizard, Side, Slider};

use super::cell::{Cell, Condition, ROUNDING_ALLOWANCE, Verdict};
use crate::config::scale;

/// The condition that a side's slider stays within its stroke.
pub(super) struct StrokeCondition {
    side: Side,
    slider: Slider,
    /// Error bound of the guard's integers, mm.
    error_bound: f64,
    /// Smallest length of the slider within its stroke, mm.
    min_length: f64,
    /// Largest length of the slider within its stroke, mm.
    max_length: f64,
}

impl StrokeCondition {
    /// Creates the condition of one side of a robot, with the guard's stroke.
    pub fn new(lizard: &Lizard, numbers: &Content, side: Side) -> Self {
        let core_slider = &numbers.sliders[side as usize];
        let slider = lizard.side(side);
        let to_mm = |steps: u16| f64::from(steps) / scale::steps_per_mm(core_slider.scale);
        Self {
            side,
            slider,
            error_bound: bounds::slider_error(&slider, core_slider),
            min_length: to_mm(core_slider.stroke_min),
            max_length: to_mm(core_slider.stroke_max),
        }
    }

    /// The slider's length at the centre of a cell, mm.
    fn length(&self, cell: &Cell) -> f64 {
        let [front, rear] = cell.0.map(|span| span.direction());
        let (rear, front) = (self.side.rear_arm(rear), self.side.front_arm(front));
        self.slider.pose_unchecked(rear, front).d
    }
}

impl Condition for StrokeCondition {
    fn servos(&self) -> [usize; 2] {
        self.side.servos()
    }

    fn evaluate(&self, cell: &Cell) -> Verdict {
        let [front, rear] = cell.0;
        let length = self.length(cell);
        let clearance = (length - self.min_length).min(self.max_length - length);
        if clearance < 0.0 {
            return Verdict::Violated;
        }
        let arm_movement = self.slider.front_arm * front.half_width_rad()
            + self.slider.rear_arm * rear.half_width_rad();
        if clearance - arm_movement - self.error_bound >= ROUNDING_ALLOWANCE {
            Verdict::Proven
        } else {
            Verdict::Undetermined
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tables::cells::cell::{Span, VERDICTS_BY_CLEARANCE};
    use crate::testing::robot;

    #[test]
    fn a_single_pose_is_proven_if_its_slider_clears_both_ends_by_the_error_bound() {
        let robot = robot("unequal");
        let numbers = robot.content();
        for side in Side::ALL {
            let mut condition = StrokeCondition::new(robot.lizard(), numbers, side);
            let neutral_span =
                |servo: usize| Span::single_angle(numbers.neutral_angles[servo].0.into());
            let cell = Cell(side.servos().map(neutral_span));
            assert_eq!(condition.evaluate(&cell), Verdict::Proven);
            let length = condition.length(&cell);
            for (clearance, verdict) in VERDICTS_BY_CLEARANCE {
                let (min, max) = (condition.min_length, condition.max_length);
                let distance = clearance * condition.error_bound;
                for (end, range) in [
                    ("shortest", (length - distance, max)),
                    ("longest", (min, length + distance)),
                ] {
                    (condition.min_length, condition.max_length) = range;
                    let case =
                        format!("{side} side, {clearance} error bounds from the {end} length");
                    assert_eq!(condition.evaluate(&cell), verdict, "{case}");
                }
                (condition.min_length, condition.max_length) = (min, max);
            }
        }
    }
}
