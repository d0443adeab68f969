//! Times, and errors against the truth in f64.

mod sequence;
mod statistics;

pub use sbbk_testkit::judge::{Errors, Truth};
pub use sbbk_testkit::world::solver_points;
pub use sequence::Sequence;
pub use statistics::{Summary, geometric_mean, sample};
