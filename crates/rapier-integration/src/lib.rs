//! SBBK for Rapier: a query dispatcher that answers triangle-mesh pairs from SBBK trees.

mod config;
mod dispatcher;
mod mesh;
mod pair;
mod stats;

pub use config::{ContactGenerator, SbbkConfig};
pub use dispatcher::SbbkDispatcher;
pub use pair::TriangleContacts;
pub use sbbk_core;
pub use stats::SbbkStats;
