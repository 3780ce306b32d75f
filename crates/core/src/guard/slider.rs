//! The length of the slider, the prismatic joint on each side of the body.
//!
//! The slider has two halves and connects an arm of the front crank to an arm of the rear crank on the same side (an
//! RRPRR five-bar). The slider has no singularity: the determinant of its block in the Jacobian of the passive joints
//! is minus its length, which is never 0 within the stroke. But its halves can be pulled apart or collide.

use lizard_avr::{mul, mul_unsigned};

use crate::guard::five_bar::rounded_upper_half;
use crate::guard::trig::Direction;
use crate::numbers::slider::Slider;

impl Slider {
    /// Returns the slider mirrored in the y axis of the chassis, which converts a right slider to a left slider.
    pub const fn mirrored(self) -> Self {
        Self {
            offset: self.offset.wrapping_neg(),
            ..self
        }
    }

    /// Computes the slider's squared length, in squared steps, for these directions of the front and the rear crank.
    /// The direction of the rear crank is in the tail's own frame.
    ///
    /// Valid only for the left side, whose front arm is 90 degrees counter-clockwise from its crank; a right slider and
    /// the directions of its cranks must be mirrored first.
    #[inline(never)]
    pub fn length_sq(&self, front: &Direction, rear: &Direction) -> u32 {
        let arm_sum_x = rounded_upper_half(
            (mul(self.rear_arm, rear.sin) - mul(self.front_arm, front.sin)) << 1,
        );
        let arm_sum_y = rounded_upper_half(
            (mul(self.front_arm, front.cos) + mul(self.rear_arm, rear.cos)) << 1,
        );
        let x = self.offset.wrapping_add(arm_sum_x).unsigned_abs();
        let y = (i32::from(self.base) + i32::from(arm_sum_y)).unsigned_abs() as u16;
        mul_unsigned(x, x).wrapping_add(mul_unsigned(y, y))
    }
}

#[cfg(test)]
mod tests {
    use lizard_kinematics as kinematics;
    use proptest::prelude::*;

    use super::*;
    use crate::guard::bounds;
    use crate::numbers::units::Angle;
    use crate::sample::{Sample, slider_in_steps, steps_per_mm, to_degrees};

    /// Yields random sliders, in mm, of robots that hobby servos can move.
    fn any_slider() -> impl Strategy<Value = kinematics::Slider> {
        let lengths = [1.0..300.0, 1.0..100.0, 1.0..100.0, -40.0..40.0, 50.0..200.0];
        lengths.prop_map(|[base, front, rear, offset, nominal]| kinematics::Slider {
            front_offset: offset,
            base,
            front_arm: front,
            rear_arm: rear,
            nominal_length: nominal,
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]

        #[test]
        fn the_length_is_the_distance_between_the_arm_tips(
            slider in any_slider(),
            front: u16,
            rear: u16,
            is_mirrored: bool,
        ) {
            let rounded_slider = slider_in_steps(&slider, -10.0, 10.0);
            let [front, rear] = [front, rear].map(Angle);
            // Each crank is in the frame of its end, so the rear crank is in the tail's frame.
            let [front_crank, rear_crank] = [front, rear].map(Direction::from_angle);
            let length_sq = if is_mirrored {
                rounded_slider.mirrored().length_sq(&front_crank.mirrored(), &rear_crank.mirrored())
            } else {
                rounded_slider.length_sq(&front_crank, &rear_crank)
            };
            let (side, turn_deg) = if is_mirrored {
                (kinematics::Side::Right, -90.0)
            } else {
                (kinematics::Side::Left, 90.0)
            };
            prop_assert_eq!(side.sign() * 90.0, turn_deg);
            let pose = slider.forward(-to_degrees(rear) - turn_deg, to_degrees(front) + turn_deg).expect("the slider has a length");
            let length_mm = f64::from(length_sq).sqrt() / steps_per_mm(rounded_slider.scale);
            let max_error = bounds::slider_error(&slider, &rounded_slider);
            prop_assert!((length_mm - pose.d).abs() <= max_error, "{length_mm} mm for {} mm", pose.d);
        }

        #[test]
        fn the_displacement_from_the_nominal_length_is_in_hundredths_of_a_millimetre(
            slider in any_slider(),
            length: u16,
        ) {
            let rounded_slider = slider_in_steps(&slider, -10.0, 10.0);
            let exact = (f64::from(length) - f64::from(rounded_slider.nominal_length)) * 100.0 / steps_per_mm(rounded_slider.scale);
            prop_assert!((f64::from(rounded_slider.displacement_hundredths(length)) - exact).abs() <= 0.5);
        }

        #[test]
        fn a_stroke_includes_its_ends_but_no_step_beyond_them(
            slider in any_slider(),
            min in 1u16..60_000,
            stroke_length in 1u16..5_000,
        ) {
            let max = min + stroke_length;
            let slider = Slider { stroke_min: min, stroke_max: max, ..slider_in_steps(&slider, -10.0, 10.0) };
            let square = |length: u16| u32::from(length) * u32::from(length);
            prop_assert!(slider.allows(square(min)) && slider.allows(square(max)));
            prop_assert!(!slider.allows(square(min) - 1) && !slider.allows(square(max) + 1));
        }
    }

    #[test]
    fn mirroring_negates_the_offset_and_mirroring_twice_changes_nothing() {
        let slider = Sample::asymmetric().content.sliders[0];
        assert_ne!(slider.offset, 0);
        assert_eq!(slider.mirrored().offset, -slider.offset);
        assert_eq!(slider.mirrored().mirrored(), slider);
    }
}
