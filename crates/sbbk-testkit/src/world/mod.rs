//! Worlds described by numbers: contacts and heights, and a hash of all bits.

mod fingerprint;
mod state;

pub use fingerprint::fingerprint;
pub use state::{WorldState, solver_points};
