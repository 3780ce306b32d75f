//! The refusal of a robot.toml, of a length or of a gait.

use lizard_robot::Error;
use lizard_robot::edit::NoSuchKey;
use serde::Serialize;
use tsify::Tsify;

/// A refusal: the message that the user sees, and the key in robot.toml to which it refers.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Tsify)]
pub struct Refused {
    /// The message for the user: what is wrong, and where.
    pub refused: String,
    /// The consequence for the robot, without keys and figures; `None` if the message names no consequence.
    pub consequence: Option<String>,
    /// Line of the file, counted from 1; `None` if the refusal belongs to no line.
    pub line: Option<usize>,
    /// Full name of the key, such as `links.l2`; empty if the refusal belongs to no key.
    pub key: String,
}

impl Refused {
    /// Creates a refusal that belongs to a key, or to none if `key` is empty.
    pub(crate) fn of_key(key: &str, refused: String) -> Self {
        Self {
            refused,
            consequence: None,
            line: None,
            key: key.to_string(),
        }
    }

    /// Converts the error of a gait; drops the line, since the user does not see the gait's text.
    pub(crate) fn of_gait(error: Error) -> Self {
        let Error {
            consequence,
            problem,
            key,
            ..
        } = error;
        Self {
            refused: format!("{}: {problem}", consequence.as_ref().unwrap_or(&key)),
            consequence,
            line: None,
            key,
        }
    }
}

impl From<Error> for Refused {
    fn from(error: Error) -> Self {
        Self {
            refused: error.to_string(),
            consequence: error.consequence,
            line: error.line,
            key: error.key,
        }
    }
}

impl From<NoSuchKey> for Refused {
    fn from(error: NoSuchKey) -> Self {
        Self::of_key(&error.0, error.to_string())
    }
}
