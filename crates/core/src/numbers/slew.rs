//! The slew limit: the speed of servos when the robot goes from one pose to another.

lizard_avr::plain! {
    /// The slew limit of a move.
    #[derive(Debug, PartialEq, Eq)]
    pub struct Slew {
        /// The largest turn in a frame, 1/65536 turn.
        pub per_frame: u16,
        /// Frames for each 1/65536 turn of the longest distance, Q16, rounded up.
        pub(crate) frames_per_way: u16,
    }
}

impl Slew {
    /// The lowest limit, 1/65536 turn in a frame: below it, a move would take more frames than
    /// sixteen bits count.
    pub const SLOWEST: u16 = 36;

    /// A limit in 1/65536 turn a frame.
    ///
    /// # Panics
    /// If the limit is below [`Slew::SLOWEST`].
    pub const fn new(per_frame: u16) -> Self {
        assert!(per_frame >= Self::SLOWEST);
        Self {
            per_frame,
            // 3/2 of the mean pace is the peak, and the roundings of a smoothstep add
            // up to three steps to a frame for each half turn of the way.
            frames_per_way: (3u32 << 16).div_ceil(2 * (per_frame as u32 - 6)) as u16,
        }
    }
}
