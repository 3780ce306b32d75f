//! The refusal of a robot.toml, a length or a gait.

use lizard_robot::Error;
use lizard_robot::edit::KeyError;
use serde::Serialize;
use tsify::Tsify;

/// A refusal: the message for the user, and the key in robot.toml to which it refers.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Tsify)]
pub struct Refusal {
    /// The message for the user: the problem and its position.
    pub reason: String,
    /// The consequence for the robot, without keys and values; `None` if the message names no consequence.
    pub consequence: Option<String>,
    /// Line of the file, counted from 1; `None` if the refusal belongs to no line.
    pub line: Option<usize>,
    /// Full name of the key, such as `links.l2`; empty if the refusal belongs to no key.
    pub key: String,
}

impl Refusal {
    /// Creates a refusal that belongs to a key, or to no key if `key` is empty.
    pub(crate) fn for_key(key: &str, reason: String) -> Self {
        Self {
            reason,
            consequence: None,
            line: None,
            key: key.to_string(),
        }
    }

    /// Converts the error of a gait. Drops the line, because the user does not see the gait's text.
    pub(crate) fn for_gait(error: Error) -> Self {
        let subject = error.consequence.as_ref().unwrap_or(&error.key);
        Self {
            reason: format!("{subject}: {}", error.problem),
            line: None,
            ..error.into()
        }
    }
}

impl From<Error> for Refusal {
    fn from(error: Error) -> Self {
        Self {
            reason: error.to_string(),
            consequence: error.consequence,
            line: error.line,
            key: error.key,
        }
    }
}

impl From<KeyError> for Refusal {
    fn from(error: KeyError) -> Self {
        Self::for_key(&error.0, error.to_string())
    }
}
