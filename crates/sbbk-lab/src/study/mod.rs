//! The studies. Each has a plan, standard or quick, and returns a verdict, rows and tables:
//! [`Results`](crate::report::Results).
//!
//! Times are taken in one process, backends in turn. Trees are built before; in [`everyday`] they
//! are part of the steps. Wrong contacts are counted on the queries that are timed, or on
//! queries made in the same way.

pub mod compare;
pub mod contacts;
pub mod convex;
pub mod everyday;
pub mod hard;
mod kinds;
mod motion;
pub mod one_step;
mod pair;
pub mod runs;

/// Rapier's prediction distance, in units.
const PREDICTION: f32 = 0.02;
