//! The slider on each side of the body: its lengths, and the stroke that it may use.

use lizard_avr::mul_unsigned;

use crate::numbers::units::Scale;

/// The limit of two lengths of a side, in steps: the sum of base, arms and offset, and the slider's length.
pub const MAX_STEPS: f64 = 255.0 * 256.0;

/// The largest sum of both arms and the offset, in steps; it has to fit a signed number.
pub const MAX_ARM_STEPS: f64 = 127.0 * 256.0;

lizard_avr::plain! {
    /// One side of the body, with its lengths in steps of `scale`.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Slider {
        /// The step of all lengths.
        pub scale: Scale,
        /// The x coordinate of the front shaft minus that of the rear shaft.
        pub offset: i16,
        /// The distance between the two shafts along y.
        pub base: u16,
        /// The arm at the front crank, at a right angle to it.
        pub front: i16,
        /// The arm at the rear crank, at a right angle to it.
        pub rear: i16,
        /// The slider's nominal length.
        pub nominal: u16,
        /// The shortest length within the stroke.
        pub min: u16,
        /// The longest length within the stroke.
        pub max: u16,
    }
}

impl Slider {
    /// A slider without length.
    pub const NONE: Self = Self {
        scale: Scale { bits: 0 },
        offset: 0,
        base: 0,
        front: 0,
        rear: 0,
        nominal: 0,
        min: 0,
        max: 0,
    };

    /// True if a squared length is within the stroke.
    pub fn allows(&self, length_sq: u32) -> bool {
        let square = |length| mul_unsigned(length, length);
        square(self.min) <= length_sq && length_sq <= square(self.max)
    }

    /// The difference of a length from nominal, in hundredths of a millimetre.
    #[inline(always)]
    pub fn travel(&self, length: u16) -> i32 {
        self.scale
            .hundredths(i32::from(length) - i32::from(self.nominal))
    }
}
