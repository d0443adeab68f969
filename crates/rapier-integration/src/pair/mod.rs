//! A pair of shapes: from a pose to contact manifolds.
//!
//! [`update`] is the pipeline. The table of steps in `ARCHITECTURE.md` says which file does what.

mod borders;
mod chunks;
mod convex;
mod deep;
mod descents;
mod far;
mod field;
mod inside;
mod islands;
mod mesh_pair;
mod passed;
mod pose;
mod query;
mod reduce;
mod sheets;
mod state;
mod surface;
mod triangle_contacts;
mod triangle_shape;
mod triangle_shapes;
mod triangles;
mod update;
mod write;

pub(crate) use convex::{
    ConvexPair, ConvexSearch, ConvexShape, FoundCast, FoundTriangle, Parts, PlacedPart,
};
pub(crate) use descents::BvhDescent;
pub(crate) use field::Field;
pub(crate) use mesh_pair::{MeshPair, ShapeView};
pub(crate) use pose::{MeshPlace, PairPose};
pub use triangle_contacts::TriangleContacts;
pub(crate) use update::{QueryOutcome, update_manifolds};
