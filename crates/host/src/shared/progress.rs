//! Progress bars on standard error; they hide themselves if that is not a terminal.

use indicatif::{ProgressBar, ProgressStyle};

/// A bar of this length, drawn by a template of indicatif.
///
/// # Panics
/// The template is not well formed.
#[must_use]
pub fn bar(length: usize, template: &str) -> ProgressBar {
    let style = ProgressStyle::with_template(template).expect("the template is well formed");
    ProgressBar::new(length as u64).with_style(style)
}
