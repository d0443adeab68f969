//! All tests of the crate's interface, in one binary.

mod allowances;
mod broad_phase;
mod contact_truth;
mod convex_contact;
mod descent;
mod draw;
mod field;
mod front;
mod lateral;
mod long_rings;
mod penetration;
mod placement;
mod prelude;
mod query;
mod sides;
mod slack;
#[path = "../support/mod.rs"]
mod support;
mod surface;
mod tree;
mod volumes;
