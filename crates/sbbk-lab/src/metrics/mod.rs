//! Measuring instruments: times, the state of a world, and the error against the f64 truth.
//!
//! Times and error are always taken from the same run. What is timed, and which contacts are
//! judged at which poses, is said at [`run`] and [`Sequence`]; what counts as an error, at
//! [`ErrorCount`].

mod environment;
mod error;
mod fingerprint;
mod run;
mod sequence;
mod statistics;
mod step;
mod world_state;

pub use environment::Environment;
pub use error::{ContactErrors, ErrorCount, Judge, TrueContact, Truth, sample_indices};
pub use fingerprint::Fingerprint;
pub use run::{Run, RunPlan, Runner, Sample, run};
pub use sequence::Sequence;
pub use statistics::{Summary, geometric_mean, power_law, ratio};
pub use step::{StepTimes, judged_step, timed_step};
pub use world_state::{WorldState, solver_points};
