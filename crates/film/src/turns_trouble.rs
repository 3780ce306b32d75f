//! The reasons why a film of a servo cannot be measured, each as the sentence that the user sees.

/// A reason why a film of a servo cannot be measured.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum TurnsTrouble {
    /// The horn did not turn.
    #[error(
        "the horn did not turn: {turn:.1} deg at most; is this the right servo, and has it power?"
    )]
    NotTurned {
        /// Largest turn, deg.
        turn: f64,
    },
    /// The film is too short.
    #[error(
        "the film lasts {seconds:.0} s and the steps take {needed:.0} s: film from before the first to after the last"
    )]
    TooShort {
        /// Length of the film, s.
        seconds: f64,
        /// Time of the steps, s.
        needed: f64,
    },
    /// The steps take another time.
    #[error(
        "the steps take {times} times as long as they should: for a film in slow motion, give the rate at which it \
         was taken with --fps"
    )]
    AnotherPace {
        /// The multiple.
        times: f64,
    },
    /// The angles are not those of the steps.
    #[error(
        "the horn does not turn in the steps of `lizard measure steps`: does the film show all of them, and does the \
         servo follow?"
    )]
    NotTheSteps,
    /// Too few pictures of the turning horn.
    #[error(
        "the card is seen in too few pictures while the horn turns ({rate:.0} pictures a second): film at 120 pictures a \
         second or more, in more light"
    )]
    FewPictures {
        /// Pictures in a second.
        rate: f64,
    },
    /// The servo is held back by the slew limit.
    #[error(
        "the servo turns at {rate:.0} deg/s, and the orders at {slew:.0} deg/s: it shows the orders' rate and not its \
         own; flash a robot with [limits] slew = 1000"
    )]
    Ordered {
        /// Measured rate, deg/s.
        rate: f64,
        /// Slew limit of the orders, deg/s.
        slew: f64,
    },
    /// The servo without load is slower to one side than with it.
    #[error(
        "the servo turns less evenly to both sides without the load than with it: were the two films swapped?"
    )]
    Swapped,
    /// The load does not slow the servo down enough.
    #[error(
        "the load makes the servo slower by {percent:.1} % with an error of {error:.1} %: too little to tell its torque; \
         take a heavier weight, or film more pictures a second"
    )]
    LoadNotSeen {
        /// Loss of rate, percent.
        percent: f64,
        /// Its standard error.
        error: f64,
    },
}
