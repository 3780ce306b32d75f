//! robot.toml as a file: its text, its tables, and the sentence for every mistake in them.
//!
//! People write robot.toml by hand, so most files are wrong at first. A mistake should cost
//! them one look: the error names the file, the line, the key, what is wrong and what would
//! be right. Nothing here knows what a value means.

mod error;
mod reader;
mod syntax;
mod text;

pub(crate) use error::{Checked, Fault};
pub use error::{Error, Hint, Problem};
pub(crate) use reader::{Section, line};
pub use syntax::mistake;
pub use text::LONGEST;
pub(crate) use text::read;
