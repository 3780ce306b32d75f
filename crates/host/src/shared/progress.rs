//! Progress bars on standard error. They are hidden if standard error is not a terminal.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

/// Creates a progress bar for `length` steps from an indicatif template.
///
/// # Panics
/// Panics if the template is not well formed.
pub fn create_progress_bar(length: usize, template: &str) -> ProgressBar {
    let style = ProgressStyle::with_template(template).expect("the template is well formed");
    ProgressBar::new(length as u64).with_style(style)
}

/// Shows `message` and the elapsed time, for a computation without steps. Dropping the value clears the display.
pub fn create_spinner(message: &'static str) -> ProgressBar {
    let spinner = create_progress_bar(0, "{spinner} {msg}, {elapsed}").with_message(message);
    spinner.enable_steady_tick(Duration::from_millis(100));
    spinner
}
