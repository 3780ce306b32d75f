//! robot.toml as a file: its text, its tables, and the message for every mistake in them.
//!
//! People write robot.toml by hand, so most files have mistakes at first. So that a mistake is found quickly, the error
//! names the file, the line, the key, the mistake and its correction. This module does not know the meaning of any
//! value.

pub mod edit;
mod error;
mod reader;
mod syntax;
mod text;

pub use error::Error;
pub(crate) use error::{Checked, UnlocatedError, format_number, hint};
#[cfg(test)]
pub(crate) use reader::{KEY_READS, KeyRead};
pub(crate) use reader::{Section, parse};
pub use syntax::explain_mistake;
pub use text::MAX_FILE_BYTES;
pub(crate) use text::read_text;
