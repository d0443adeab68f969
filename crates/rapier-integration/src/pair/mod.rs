//! A pair of shapes: from a pose to contact manifolds.
//!
//! | file | holds |
//! |---|---|
//! | [`update`], [`query`] | the pipeline, and the traits of a kind of pair |
//! | [`state`] | what a host keeps with a pair: candidates, slack |
//! | [`mesh_mesh`], [`mesh_field`] | the kinds whose shapes are both made of triangles |
//! | [`triangles`], [`triangle_shapes`] | contacts of these kinds, in one pass or two |
//! | [`chunks`] | chunks of a heavy pair, on several threads |
//! | [`bvh_descent`] | candidates from Parry's BVHs |
//! | [`ranges`] | how far contacts are searched and filtered |
//! | [`far`] | contacts beyond the reach |
//! | [`surface`], [`borders`], [`islands`], [`passed`] | contacts of surfaces from contacts of triangles |
//! | [`deep`], [`contour`] | contacts of solids deep in each other |
//! | [`field`], [`pose`], [`triangle_contacts`] | height fields, poses, points of two triangles |
//! | [`convex`] | a mesh and convex shapes |
//! | [`reduce`], [`write`](mod@write) | contact reduction, manifolds |

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
