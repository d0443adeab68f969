//! A dispatcher around another one that records its answers about two meshes.

mod answer;
mod recording;

pub use answer::{Answer, Question, Reported, shape_address};
pub use recording::{Probe, Recording};
