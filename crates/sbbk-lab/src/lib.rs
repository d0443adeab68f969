//! The studies that print the tables of README and docs/measurements.md, and the replay of worlds
//! in a browser.
//!
//! [`backend`] has the dispatchers, [`metrics`] measures one run, [`study`] compares the backends,
//! [`report`] shows the results, and [`replay`] writes pages that play runs.
//! [`sbbk_testkit`] has the meshes and scenes.

#![allow(missing_docs, reason = "not published; names that tell all need no sentence")]

pub mod backend;
pub mod cli;
pub mod mesh_file;
pub mod metrics;
pub mod parallel;
mod prelude;
pub mod progress;
pub mod replay;
pub mod report;
pub mod study;

pub use sbbk_testkit::{mesh, scene};
