//! Times, and errors against the truth in f64.

mod sequence;
mod statistics;
mod truth;

pub use sbbk_testkit::world::solver_points;
pub use sequence::Sequence;
pub use statistics::{Summary, geometric_mean};
pub use truth::{Errors, Truth, sample};
