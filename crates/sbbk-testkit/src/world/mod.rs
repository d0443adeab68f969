//! Worlds described by numbers: contacts, heights and energy, and a hash of all bits.

mod fingerprint;
mod state;

pub use fingerprint::Fingerprint;
pub use state::{WorldState, solver_points};
