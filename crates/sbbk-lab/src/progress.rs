//! Progress of a study on the error stream.

use std::io::{self, IsTerminal, Write};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// Time between two lines of a pipe or file, and between two updates on a terminal.
const PIPED: Duration = Duration::from_secs(5);
const ON_TERMINAL: Duration = Duration::from_millis(300);
/// Characters of the bar.
const BAR: usize = 20;

/// Shows one phase after the other: a bar on a terminal, a line every few seconds elsewhere.
///
/// Clones share their state.
#[derive(Clone, Default)]
pub struct Progress(Option<Arc<Mutex<Phase>>>);

struct Phase {
    message: String,
    done: usize,
    length: usize,
    start: Instant,
}

impl Progress {
    /// Progress on the error stream, as long as the result lives.
    pub fn visible() -> Self {
        let start = Instant::now();
        let phase = Phase { message: String::new(), done: 0, length: 0, start };
        let shared = Arc::new(Mutex::new(phase));
        let weak = Arc::downgrade(&shared);
        let is_terminal = io::stderr().is_terminal();
        thread::spawn(move || {
            loop {
                thread::sleep(if is_terminal { ON_TERMINAL } else { PIPED });
                let Some(phase) = weak.upgrade() else { return };
                phase.lock().unwrap_or_else(PoisonError::into_inner).show(is_terminal);
            }
        });
        Self(Some(shared))
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

    /// Removes the bar.
    pub fn finish(&self) {
        self.change(|phase| {
            phase.length = 0;
            if io::stderr().is_terminal() {
                eprint!("\r\x1b[K");
            }
        });
    }

    fn change(&self, change: impl FnOnce(&mut Phase)) {
        if let Some(phase) = &self.0 {
            change(&mut phase.lock().unwrap_or_else(PoisonError::into_inner));
        }
    }
}

impl Phase {
    fn show(&self, is_terminal: bool) {
        let Self { message, done, length, start } = self;
        if *length == 0 {
            return;
        }
        let seconds = start.elapsed().as_secs();
        let mut out = io::stderr().lock();
        // A closed error stream is no reason to stop.
        let _ = if is_terminal {
            let full = BAR * done / length;
            let bar = "#".repeat(full.min(BAR)) + &".".repeat(BAR.saturating_sub(full));
            write!(out, "\r\x1b[K{seconds:>4} s {bar} {done}/{length} {message:.60}")
        } else {
            writeln!(out, "{seconds} s: {message}, {done} of {length}")
        };
        let _ = out.flush();
    }
}
