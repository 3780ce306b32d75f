//! The errors of an identification.

/// The error of a failed identification.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum IdentifyError {
    /// The robot has no such gait.
    #[error("robot.toml has no gait `{0}`; give the robot.toml of the recorded robot")]
    NoSuchGait(String),
    /// The gait moves no servo.
    #[error("the gait `{0}` moves no servo, so its movement has no information; leave it out")]
    MovesNoServo(String),
    /// A measured value is not finite, an error is negative, or the pace is not positive.
    #[error("the movement of `{0}` has an invalid value; measure the gait again")]
    InvalidValue(String),
    /// No movement is given, or in all movements two feet pull against the other two.
    #[error(
        "in none of these gaits do three feet determine the movement; measure gaits that walk or turn, such as walk, \
         trot, crawl, left or right"
    )]
    NothingDetermined,
    /// The fit has no minimum.
    #[error("the model cannot fit these movements; check their signs and units")]
    NoFit,
    /// A new value cannot be written into the text of robot.toml.
    #[error("{0}; write the key's table as [table] with one key per line")]
    TextNotWritable(String),
    /// The new values make robot.toml invalid.
    #[error(
        "the identified values make robot.toml invalid: {0}; check the signs and units of the movements"
    )]
    InvalidRobot(String),
}
