//! Progress bars on the error stream.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

/// One bar after the other: what is being done, how far it is, and how long it will take.
///
/// Nothing is drawn when the error stream is not a terminal.
#[derive(Clone, Debug)]
pub struct Progress(ProgressBar);

impl Progress {
    /// Bars on the error stream.
    pub fn visible() -> Self {
        let style = "{elapsed:>4} {bar:20} {pos:>5}/{len:<5} {msg}";
        let bar = ProgressBar::no_length();
        if let Ok(style) = ProgressStyle::with_template(style) {
            bar.set_style(style);
        }
        bar.enable_steady_tick(Duration::from_millis(500));
        Self(bar)
    }

    /// No bars.
    pub fn hidden() -> Self {
        Self(ProgressBar::hidden())
    }

    /// Starts the bar of a new phase of `length` steps.
    pub fn phase(&self, message: impl Into<String>, length: usize) {
        self.0.reset();
        self.0.set_length(length as u64);
        self.0.set_message(message.into());
    }

    /// One step of the phase is done.
    pub fn step(&self) {
        self.0.inc(1);
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.0.finish_and_clear();
    }
}
