//! Why a robot.toml or a length will not do.

use serde::Serialize;

use crate::edit::NoSuchLength;

/// A refusal: the sentence that the user sees, and what is to blame.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Refused {
    /// The sentence.
    pub refused: String,
    /// Line of the file, from 1, where one is to blame.
    pub line: Option<usize>,
    /// The key to blame, such as `links.l2`; may be empty.
    pub key: String,
}

impl Refused {
    /// Of what is wrong with a robot.toml.
    pub(crate) fn of(error: &lizard_robot::Error) -> Self {
        Self {
            refused: error.to_string(),
            line: error.line,
            key: error.key.clone(),
        }
    }
}

impl From<NoSuchLength> for Refused {
    fn from(error: NoSuchLength) -> Self {
        Self {
            refused: error.to_string(),
            line: None,
            key: error.0,
        }
    }
}
