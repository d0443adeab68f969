//! A mesh and convex shapes: one, or the parts of a compound or a polyline.
//!
//! Stock Parry asks its hierarchy of the mesh with the shape's box in the mesh's frame, which for a
//! large floor is the whole mesh, and runs its contact routine on every triangle found, in every
//! step. Here the same hierarchy is asked with the box of the shape in the shape's own frame, or
//! with the plane of a half-space ([`near`]). A candidate is a triangle of the mesh and a part of
//! the shape ([`parts`]). Its contact gives a lower bound of their distance: it is not looked at
//! again until the pair has moved so far that they could touch ([`query`]). Contacts at edges
//! within the surface are turned ([`surface`]).
//!
//! Contacts are a function of the pose, as those of two triangles are: exact ones ([`features`],
//! [`ball`], [`half_space`]), or, if the host wants that, those of Parry's routine asked as if
//! nothing was known ([`placed`]). Where Parry's GJK has seen that the two are apart, the direction
//! is the candidate's hint, and shows it at the next query by how far the shape reaches along it
//! ([`shape`]).

mod ball;
mod cast;
mod features;
mod half_space;
mod inside;
mod near;
mod nearest;
mod pair;
mod parts;
mod placed;
mod query;
mod shape;
mod surface;
mod touch;

pub(crate) use cast::FoundCast;
pub(crate) use nearest::{ConvexSearch, FoundTriangle};
pub(crate) use pair::ConvexPair;
pub(crate) use parts::Parts;
pub(crate) use placed::PlacedPart;
pub(super) use touch::Touch;
