//! robot.toml as a file: its text, its tables, and the messages for all errors in them.
//!
//! People write robot.toml by hand, so most files contain mistakes at first. To make a mistake easy to find, its error
//! states the file, the line, the key, the problem and the correction. Except for `edit.rs`, this folder does not
//! depend on the meaning of the values.

pub mod edit;
mod error;
mod reader;
mod syntax;
mod text;

pub use error::Error;
pub(crate) use error::{ReadResult, format_number, suggest};
#[cfg(test)]
pub(crate) use reader::{KEY_USES, KeyUse, Range};
pub(crate) use reader::{Table, parse, read_for_each};
pub use syntax::explain_mistake;
pub use text::MAX_FILE_BYTES;
pub(crate) use text::read_text;
