//! The prismatic joint in each side of the body.
//!
//! Between the arm of a front crank and the arm of the rear crank on the same
//! side lies a slider of two halves (the RRPRR five-bar). It has no singularity
//! of its own, since its block of the passive Jacobian is just its length; but the
//! halves can be pulled apart or run into each other.

use lizard_avr::{mul, mul_unsigned};

use crate::guard::five_bar::upper;
use crate::guard::trig::Direction;
use crate::numbers::slider::Slider;

impl Slider {
    /// The slider mirrored in the y axis of the chassis: a right one as a left one.
    pub const fn mirrored(self) -> Self {
        Self {
            offset: self.offset.wrapping_neg(),
            ..self
        }
    }

    /// The slider's squared length in steps, with the front crank and the rear
    /// one (in the tail's own frame) in these directions.
    ///
    /// Valid for the left side, where the front arm is a right angle ahead of its crank,
    /// counter-clockwise; the right side has to be mirrored first.
    #[inline(never)]
    pub fn length_sq(&self, front: &Direction, rear: &Direction) -> u32 {
        let arms_x = upper((mul(self.rear, rear.sin) - mul(self.front, front.sin)) << 1);
        let arms_y = upper((mul(self.front, front.cos) + mul(self.rear, rear.cos)) << 1);
        let x = self.offset.wrapping_add(arms_x).unsigned_abs();
        let y = (i32::from(self.base) + i32::from(arms_y)).unsigned_abs() as u16;
        mul_unsigned(x, x).wrapping_add(mul_unsigned(y, y))
    }
}

#[cfg(test)]
mod tests {
    use lizard_kinematics as kinematics;
    use proptest::prelude::*;

    use super::*;
    use crate::numbers::units::Angle;
    use crate::sample::{bounds, degrees, per_mm, side_of};

    /// The slider of any robot that hobby servos move, mm.
    fn any_side() -> impl Strategy<Value = kinematics::Slider> {
        (
            1.0..300.0f64,
            1.0..100.0f64,
            1.0..100.0f64,
            -40.0..40.0f64,
            50.0..200.0f64,
        )
            .prop_map(|(base, front, rear, offset, nominal)| kinematics::Slider {
                offset,
                base,
                front,
                rear,
                nominal,
            })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]

        #[test]
        fn the_length_is_the_distance_of_the_arm_tips(
            side in any_side(),
            front: u16,
            rear: u16,
            is_mirrored: bool,
        ) {
            let integers = side_of(&side, -10.0, 10.0);
            let [front, rear] = [front, rear].map(Angle);
            // Each crank in the frame of its end, so the rear one in the tail's.
            let length = if is_mirrored {
                let [front, rear] = [front, rear].map(|angle| Direction::of(angle).mirrored());
                integers.mirrored().length_sq(&front, &rear)
            } else {
                integers.length_sq(&Direction::of(front), &Direction::of(rear))
            };
            let (expected_side, turn) = if is_mirrored {
                (kinematics::Side::Right, -90.0)
            } else {
                (kinematics::Side::Left, 90.0)
            };
            prop_assert_eq!(expected_side.sign() * 90.0, turn);
            let pose = side.forward(-degrees(rear) - turn, degrees(front) + turn).expect("a length");
            let length_mm = f64::from(length).sqrt() / per_mm(integers.scale);
            let max_error = bounds::slider_error(&side, &integers);
            prop_assert!((length_mm - pose.d).abs() <= max_error, "{length_mm} for {} mm", pose.d);
        }

        #[test]
        fn the_travel_is_printed_from_nominal_in_hundredths_of_a_millimetre(
            side in any_side(),
            length: u16,
        ) {
            let side = side_of(&side, -10.0, 10.0);
            let exact = (f64::from(length) - f64::from(side.nominal)) * 100.0 / per_mm(side.scale);
            prop_assert!((f64::from(side.travel(length)) - exact).abs() <= 0.5);
        }

        #[test]
        fn a_stroke_has_its_ends_and_not_a_step_more(
            min in 1u16..60_000,
            stroke_length in 1u16..5_000,
        ) {
            let max = min + stroke_length;
            let side = Slider { min, max, ..side_of(&sample_side(), -10.0, 10.0) };
            let square_of = |length: u16| u32::from(length) * u32::from(length);
            prop_assert!(side.allows(square_of(min)) && side.allows(square_of(max)));
            prop_assert!(!side.allows(square_of(min) - 1) && !side.allows(square_of(max) + 1));
        }
    }

    fn sample_side() -> kinematics::Slider {
        kinematics::Slider {
            offset: 3.0,
            base: 141.0,
            front: 28.0,
            rear: 33.0,
            nominal: 91.0,
        }
    }

    #[test]
    fn a_mirrored_side_is_itself_again_and_only_its_offset_changes_sign() {
        let side = side_of(&sample_side(), -10.0, 10.0);
        assert_eq!(side.mirrored().offset, -side.offset);
        assert_eq!(side.mirrored().mirrored(), side);
    }
}
