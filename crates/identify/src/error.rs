//! The errors of an identification.

/// A reason why the keys cannot be identified.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum IdentifyError {
    /// The robot has no such gait.
    #[error("robot.toml has no gait `{0}`; give the robot that was filmed")]
    NoSuchGait(String),
    /// The gait moves no servo.
    #[error("the gait `{0}` moves no servo, so its movement tells nothing; leave it out")]
    MovesNoServo(String),
    /// A measured value is not finite, its error is negative, or the pace is not positive.
    #[error("the movement of `{0}` has a value that is not a number; measure it again")]
    InvalidValue(String),
    /// No movement is given, or in all of them two feet pull against the other two.
    #[error(
        "in none of these gaits do three feet determine the movement; measure some that walk or turn, such as walk, trot, \
         crawl, left or right"
    )]
    NothingDetermined,
    /// The fit has no minimum.
    #[error("no robot moves like this; look for a movement with a wrong sign or unit")]
    NoFit,
    /// The text of robot.toml cannot take a new value.
    #[error("{0}; write its table as [table] with one key per line")]
    TextNotWritable(String),
    /// The robot with the new values is refused.
    #[error(
        "the robot that moves like this is refused: {0}; look for a movement with a wrong sign or unit"
    )]
    RobotRefused(String),
}
