//! The reasons why a film of a servo cannot be measured, each as the sentence that the user sees.

/// A reason why a film of a servo cannot be measured.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ServoTrouble {
    /// The horn did not turn.
    #[error(
        "the horn did not turn: {turn:.1} deg at most; is this the right servo, and does it have power?"
    )]
    NoTurn {
        /// Largest turn, deg.
        turn: f64,
    },
    /// The film is too short.
    #[error(
        "the film lasts {seconds:.0} s and the steps take {needed:.0} s: start before the first step and stop after the last"
    )]
    TooShort {
        /// Length of the film, s.
        seconds: f64,
        /// Duration of all steps, s.
        needed: f64,
    },
    /// The steps take more time, or less, than planned.
    #[error(
        "the steps take {ratio} times as long as they should: for a film in slow motion, give with --fps the rate at \
         which it was taken"
    )]
    WrongStepInterval {
        /// Measured time of a step divided by the planned one.
        ratio: f64,
    },
    /// The horn's angles do not match the steps.
    #[error(
        "the horn's angles do not match the steps of `lizard measure steps`: does the film show all of them, and does \
         the servo follow?"
    )]
    StepMismatch,
    /// The film has too few pictures of the turning horn.
    #[error(
        "the card is visible in too few pictures while the horn turns ({rate:.0} pictures a second): film at 120 pictures a \
         second or more, in more light"
    )]
    TooFewPictures {
        /// Pictures per second.
        rate: f64,
    },
    /// The measured rate is that of the orders, which the slew limit sets, and not the servo's own.
    #[error(
        "the servo turns at {rate:.0} deg/s, too close to the slew limit of {slew:.0} deg/s to show its own rate; flash \
         a robot with [limits] slew = 1000"
    )]
    AtSlewLimit {
        /// Measured rate, deg/s.
        rate: f64,
        /// Slew limit of the orders, deg/s.
        slew: f64,
    },
    /// The rates in both directions differ more without the load than with it.
    #[error(
        "the servo's rates in the two directions differ more without the load than with it: were the two films swapped?"
    )]
    FilmsSwapped,
    /// The load does not slow the servo down enough.
    #[error(
        "the load slows the servo by {percent:.1} % with an error of {error:.1} %: too little to compute its torque; \
         take a heavier weight, or film more pictures a second"
    )]
    LoadTooSmall {
        /// Loss of rate, percent.
        percent: f64,
        /// Standard error of the loss, percent.
        error: f64,
    },
}
