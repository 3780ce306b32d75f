//! The slew limit, which is the largest speed of the servos in a point-to-point move.

lizard_avr::pod! {
    /// The slew limit of point-to-point moves.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Slew {
        /// The largest turn in a frame, 1/65536 turn.
        pub per_frame: u16,
        /// The duration of a move, in frames, per 1/65536 turn of its largest turn, Q16, rounded up.
        pub(crate) frames_per_distance: u16,
    }
}

impl Slew {
    /// The smallest limit, 1/65536 turn per frame. With a smaller limit, the number of frames of a move might not fit
    /// into 16 bits.
    pub const MIN_PER_FRAME: u16 = 36;

    /// Creates a slew limit of `per_frame`, 1/65536 turn per frame.
    ///
    /// # Panics
    /// Panics if the limit is below [`Slew::MIN_PER_FRAME`].
    pub const fn new(per_frame: u16) -> Self {
        assert!(per_frame >= Self::MIN_PER_FRAME);
        Self {
            per_frame,
            // The top speed of a smoothstep is 3/2 of its mean speed. Rounding adds at most 3/65536 turn per frame for
            // each half turn of the distance, which is at most a turn.
            frames_per_distance: (3u32 << 16).div_ceil(2 * (per_frame as u32 - 6)) as u16,
        }
    }
}
