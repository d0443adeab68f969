//! A dispatcher around another one that counts, times and records its queries.
//!
//! Comparisons install every dispatcher behind the same [`Timed`] wrapper, so that the clock costs
//! each of them the same. The [`Probe`] is read beside the running world.

mod answer;
mod counters;
mod timed;

pub use answer::{Answer, Question, Reported, shape_address};
pub use counters::{PairKind, Probe, Tally, clock_cost};
pub use timed::Timed;
