//! Progress bars on standard error, which are hidden if that is not a terminal.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

/// A bar of this length, drawn by a template of indicatif.
///
/// # Panics
/// Panics if the template is not well formed.
pub fn progress_bar(length: usize, template: &str) -> ProgressBar {
    let style = ProgressStyle::with_template(template).expect("the template is well formed");
    ProgressBar::new(length as u64).with_style(style)
}

/// A display of the time that a computation without steps has taken so far; removed when dropped.
pub struct Spinner(ProgressBar);

impl Spinner {
    /// Starts to show the time, after this message.
    pub fn new(message: &'static str) -> Self {
        let spinner = progress_bar(0, "{spinner} {msg}, {elapsed}").with_message(message);
        spinner.enable_steady_tick(Duration::from_millis(100));
        Self(spinner)
    }
}

impl Drop for Spinner {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
