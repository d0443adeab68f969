//! Progress of a study on the error stream.

use std::io::{self, IsTerminal, Write};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Time between two messages.
const INTERVAL: Duration = Duration::from_secs(2);

/// Shows one phase after the other: in one line that is written again on a terminal, in lines
/// elsewhere.
pub struct Progress(Option<Mutex<Phase>>);

struct Phase {
    message: String,
    done: usize,
    length: usize,
    start: Instant,
    shown: Instant,
}

impl Progress {
    /// Progress on the error stream.
    pub fn visible() -> Self {
        let start = Instant::now();
        let phase = Phase { message: String::new(), done: 0, length: 0, start, shown: start };
        Self(Some(Mutex::new(phase)))
    }

    /// No output.
    pub fn hidden() -> Self {
        Self(None)
    }

    /// Starts a phase of `length` steps.
    pub fn phase(&self, message: impl Into<String>, length: usize) {
        self.change(|phase| {
            (phase.message, phase.done, phase.length) = (message.into(), 0, length);
        });
    }

    /// Counts one step of the phase.
    pub fn step(&self) {
        self.change(|phase| phase.done += 1);
    }

    fn change(&self, change: impl FnOnce(&mut Phase)) {
        let Some(phase) = &self.0 else { return };
        let mut phase = phase.lock().unwrap_or_else(PoisonError::into_inner);
        change(&mut phase);
        if phase.shown.elapsed() < INTERVAL {
            return;
        }
        phase.shown = Instant::now();
        let Phase { message, done, length, start, .. } = &*phase;
        let (before, after) =
            if io::stderr().is_terminal() { ("\r\x1b[K", "") } else { ("", "\n") };
        let seconds = start.elapsed().as_secs();
        // A closed error stream is no reason to stop.
        let _ = write!(io::stderr(), "{before}{seconds} s: {message}, {done} of {length}{after}");
    }
}

impl Drop for Progress {
    /// Removes the line from a terminal.
    fn drop(&mut self) {
        if self.0.is_some() && io::stderr().is_terminal() {
            eprint!("\r\x1b[K");
        }
    }
}
