//! The lengths and the stroke of the slider on each side of the body.

use lizard_avr::mul_unsigned;

use crate::numbers::units::Scale;

/// The upper limit, in steps, of the sum of base, arms and offset, and of the slider's longest length.
pub const MAX_LENGTH_STEPS: f64 = 255.0 * 256.0;

/// The upper limit, in steps, of the sum of both arms and the offset, which must fit into a signed 16-bit number.
pub const MAX_ARM_STEPS: f64 = 127.0 * 256.0;

lizard_avr::pod! {
    /// The slider of a side of the body, with lengths in steps of `scale`.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Slider {
        /// The scale of all lengths.
        pub scale: Scale,
        /// The x coordinate of the front shaft minus that of the rear shaft.
        pub offset: i16,
        /// The distance between the two shafts along y.
        pub base: u16,
        /// The arm at the front crank, at a right angle to it.
        pub front_arm: i16,
        /// The arm at the rear crank, at a right angle to it.
        pub rear_arm: i16,
        /// The slider's nominal length.
        pub nominal_length: u16,
        /// The shortest length within the stroke.
        pub stroke_min: u16,
        /// The longest length within the stroke.
        pub stroke_max: u16,
    }
}

impl Slider {
    /// True if a squared length, in squared steps, is within the stroke.
    pub fn allows(&self, length_sq: u32) -> bool {
        let square = |length| mul_unsigned(length, length);
        square(self.stroke_min) <= length_sq && length_sq <= square(self.stroke_max)
    }

    /// Computes a slider's length minus its nominal length, in hundredths of a millimetre. `length` is in steps.
    #[inline(always)]
    pub fn displacement_hundredths(&self, length: u16) -> i32 {
        self.scale
            .hundredths(i32::from(length) - i32::from(self.nominal_length))
    }
}
