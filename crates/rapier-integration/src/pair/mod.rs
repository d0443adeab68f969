//! A pair of shapes: from a pose to contact manifolds.
//!
//! [`update`] is the pipeline. The table of steps in `ARCHITECTURE.md` says which file does what.

mod borders;
mod contours;
mod convex;
mod descents;
mod far;
mod field;
mod islands;
mod pose;
mod query;
mod reduce;
mod shapes;
mod sides;
mod surface;
mod triangle_contacts;
mod triangle_points;
mod triangles;
mod tuning;
mod update;
mod ways;
mod write;

pub(crate) use convex::{
    ConvexPair, ConvexSearch, ConvexShape, FoundTriangle, Parts, PlacedPart, WIDE, lowest,
};
pub(crate) use descents::BvhDescent;
pub(crate) use field::Field;
pub(crate) use pose::{MeshPlace, PairPose, ROUNDING, STRETCH};
pub(crate) use shapes::ShapeView;
pub use triangle_contacts::TriangleContacts;
pub(crate) use triangles::MeshPair;
pub(crate) use update::update_manifolds;
