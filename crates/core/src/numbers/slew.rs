//! The slew limit: the largest speed of the servos when the robot moves from one pose to another.

lizard_avr::plain! {
    /// The slew limit of a move.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Slew {
        /// The largest turn in a frame, 1/65536 turn.
        pub per_frame: u16,
        /// Frames for each 1/65536 turn of the longest distance, Q16, rounded up.
        pub(crate) frames_per_distance: u16,
    }
}

impl Slew {
    /// The lowest limit, in 1/65536 turn per frame: below it, a move would take more frames than a 16-bit number can
    /// count.
    pub const SLOWEST: u16 = 36;

    /// A limit in 1/65536 turn per frame.
    ///
    /// # Panics
    /// If the limit is below [`Slew::SLOWEST`].
    pub const fn new(per_frame: u16) -> Self {
        assert!(per_frame >= Self::SLOWEST);
        Self {
            per_frame,
            // The peak of the speed is 3/2 of its mean, and the rounding of a smoothstep adds up to three steps per
            // frame for each half turn of the distance.
            frames_per_distance: (3u32 << 16).div_ceil(2 * (per_frame as u32 - 6)) as u16,
        }
    }
}
