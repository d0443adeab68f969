//! A mesh and convex shapes: one, or the parts of a compound or a polyline.
//!
//! Stock Parry asks the mesh's tree with the shape's box in the mesh's frame, which for a large
//! floor is the whole mesh, and runs its contact routine on every triangle found, in every step.
//! Here a descent compares the mesh with the shape itself ([`shape`] says how far it reaches). A
//! candidate is a triangle of the mesh and a part of the shape ([`parts`]), with a lower bound of
//! their distance and the axis that shows it: it is not looked at again until the pair has moved so
//! far that they could touch ([`query`]).
//!
//! Contacts are a function of the pose, as those of two triangles are: exact ones ([`features`]),
//! or, if the host wants that, those of Parry's routine asked as if nothing was known ([`placed`]).

mod ball;
mod features;
mod half_space;
mod near;
mod pair;
mod parts;
mod placed;
mod query;
mod shape;

pub(crate) use pair::ConvexPair;
pub(crate) use parts::Parts;
pub(super) use placed::PlacedPart;
