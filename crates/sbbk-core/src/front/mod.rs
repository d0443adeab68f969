//! Temporal coherence: a descent that starts where the last one stopped.

mod cells;
mod clock;
#[cfg(test)]
mod figure;
#[allow(clippy::module_inception)]
mod front;
mod opening;
mod options;
mod policy;

pub use front::{Front, FrontStats};
pub use options::{FrontOptions, FrontOrder};
