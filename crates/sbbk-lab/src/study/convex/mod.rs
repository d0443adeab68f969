//! A mesh against convex shapes and compounds of them, stock Parry beside SBBK: what queries cost, and whether a contact is lost or added.
//!
//! The mesh comes towards a shape of each kind along random directions and is stopped at five places around the first
//! touch; the pair is asked there for the first time, and in slow and faster motion through these places, with what the query
//! before left. Both make contacts by the same routine of Parry's. Which triangles must have one is told by that routine
//! itself, run afresh on every triangle of the mesh and every part of the shape.

mod errors;
mod kinds;
mod places;
mod plan;
mod race;

pub use kinds::{Kind, kinds};
pub use plan::{Convex, ConvexPlan, ConvexRow, convex};
