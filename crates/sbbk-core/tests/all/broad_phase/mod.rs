//! The broad phase against brute force, real arithmetic, bad input and an allocation counter.

mod allocation;
mod errors;
mod model;
mod operations;
mod pairs;
mod rounding;
