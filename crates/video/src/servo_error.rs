//! The reasons why a video of a servo cannot be measured, each with its message to the user.

/// A reason why a video of a servo cannot be measured.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ServoError {
    /// The horn did not turn.
    #[error(
        "the horn turned by at most {turn:.1} deg: is this the right servo, and does it have power?"
    )]
    NoTurn {
        /// Largest turn, deg.
        turn: f64,
    },
    /// The video is too short.
    #[error(
        "the video lasts {seconds:.0} s, but the steps take {needed:.0} s: start before the first step and stop after \
         the last one"
    )]
    TooShort {
        /// Duration of the video, s.
        seconds: f64,
        /// Duration of all steps, s.
        needed: f64,
    },
    /// The steps take more time than planned, or less.
    #[error(
        "the steps take {ratio} times as long as expected: for a video in slow motion, give the recording's frame rate \
         with --fps"
    )]
    WrongStepInterval {
        /// Measured duration of a step divided by the planned one.
        ratio: f64,
    },
    /// The horn's angles do not match the steps.
    #[error(
        "the horn's angles do not match the steps of `lizard measure steps`: does the video show all steps, and does \
         the servo follow them?"
    )]
    StepMismatch,
    /// The video has too few frames of the turning horn.
    #[error(
        "the card is visible in too few frames while the horn turns ({rate:.0} frames per second): record at least \
         120 frames per second, in more light"
    )]
    TooFewFrames {
        /// Frames per second.
        rate: f64,
    },
    /// The slew limit of the commands, instead of the servo, may have determined the measured rate.
    #[error(
        "the servo turns at {rate:.0} deg/s, too close to the slew limit of {slew:.0} deg/s to show its own rate: \
         flash a robot with [limits] slew = 1000"
    )]
    AtSlewLimit {
        /// Measured rate, deg/s.
        rate: f64,
        /// Slew limit of the commands, deg/s.
        slew: f64,
    },
    /// The rates in both directions differ more without the load than with it.
    #[error(
        "the servo's rates in the two directions differ more without the load than with it: were the two videos \
         swapped?"
    )]
    VideosSwapped,
    /// The load does not slow the servo down enough.
    #[error(
        "the load slows the servo by {percent:.1} +- {error:.1} %, too little to compute its torque: use a heavier \
         weight, or record more frames per second"
    )]
    LoadTooSmall {
        /// Loss of rate, percent.
        percent: f64,
        /// Standard error of the loss, percent.
        error: f64,
    },
}
