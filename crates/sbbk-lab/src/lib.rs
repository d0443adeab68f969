//! Scenes, meshes, measurements and replays shared by the examples, tests and benchmarks of SBBK
//! for Rapier.
//!
//! [`mesh`] makes and loads meshes, [`scene`] builds worlds from them, [`backend`] chooses who
//! answers a world's contact queries, [`metrics`] measures one run, [`study`] compares the backends
//! on the paper's experiments, [`report`] shows the results, and [`replay`] plays runs in a browser.

#[macro_use]
mod named;

pub mod backend;
pub mod cli;
pub mod mesh;
pub mod metrics;
pub mod replay;
pub mod report;
pub mod scene;
pub mod study;
