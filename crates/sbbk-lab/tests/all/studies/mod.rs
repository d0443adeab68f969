//! The studies on a small scale, and what reports make of them.

mod advise;
mod compare;
mod contacts;
mod convex;
mod engines;
mod everyday;
mod floor;
mod front;
mod hard;
mod layers;
mod long_runs;
mod one_step;
mod report;
mod soft;
mod support;
mod terrain;
