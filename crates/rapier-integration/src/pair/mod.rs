//! A pair of shapes: from a pose to contact manifolds.
//!
//! [`update`] is the pipeline. The table of steps in `ARCHITECTURE.md` says which file does what.

mod borders;
mod bvh_descent;
mod chunks;
mod contour;
mod convex;
mod deep;
mod far;
mod field;
mod islands;
mod mesh_field;
mod mesh_mesh;
mod passed;
mod pose;
mod query;
mod ranges;
mod reduce;
mod state;
mod surface;
mod triangle_contacts;
mod triangle_shapes;
mod triangles;
mod update;
mod write;

pub(crate) use bvh_descent::BvhDescent;
pub(crate) use convex::{
    ConvexPair, ConvexSearch, ConvexShape, FoundCast, FoundTriangle, Parts, PlacedPart,
};
pub(crate) use mesh_field::FieldPair;
pub(crate) use mesh_mesh::MeshPair;
pub(crate) use pose::{MeshPlace, PairPose};
pub use triangle_contacts::TriangleContacts;
pub(crate) use update::{QueryOutcome, update_manifolds};
