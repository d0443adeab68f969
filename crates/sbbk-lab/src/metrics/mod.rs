//! Times, the state of a world, and errors against the truth in f64.

mod error;
mod run;
mod sequence;
mod statistics;
mod step;

pub use error::{ContactErrors, ErrorCount, Judge, TrueContact, Truth, sample_indices};
pub use run::{Run, RunPlan, Runner, Sample, run};
pub use sbbk_testkit::world::{WorldState, solver_points};
pub use sequence::Sequence;
pub use statistics::{Summary, geometric_mean, ratio};
pub use step::{StepTimes, judged_step, timed_step};
