//! The errors of an identification.

/// A reason why the keys cannot be identified.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Trouble {
    /// The robot has no such gait.
    #[error("robot.toml has no gait `{0}`; give the robot that was filmed")]
    NoSuchGait(String),
    /// The gait moves no servo.
    #[error("the gait `{0}` moves no servo, so its way tells nothing; leave it out")]
    MovesNoServo(String),
    /// A figure is not finite, its error is negative, or the pace is not positive.
    #[error("the way of `{0}` has a figure that is no number; measure it again")]
    InvalidFigure(String),
    /// No movement is given, or in all of them two feet pull against the other two.
    #[error(
        "in none of these gaits three feet decide the way; measure some that walk or turn, as walk, trot, crawl, left, right"
    )]
    NothingDetermined,
    /// The fit has no minimum.
    #[error("no robot goes like this; look for a way with a wrong sign or unit")]
    NoFit,
    /// The text of robot.toml cannot take a new value.
    #[error("{0}; write its table as [table] with one key a line")]
    TextNotWritable(String),
    /// The robot with the new values is refused.
    #[error(
        "the robot that goes like this is refused: {0}; look for a way with a wrong sign or unit"
    )]
    RobotRefused(String),
}
