//! A mesh and a convex shape: from a pose to contact manifolds.
//!
//! Stock Parry asks the mesh's tree with the shape's box in the mesh's frame, which for a large floor is the whole mesh, and
//! runs its contact routine on every triangle found, in every step. Here a descent compares the mesh with the shape itself
//! ([`shape`] says how far it reaches), and [`query`] keeps what it found with a lower bound of each triangle's distance:
//! a triangle is not looked at again until the pair has moved so far that it could touch. The contacts are those of
//! Parry's routine ([`contacts`], [`refresh`]), called as stock calls it, or had without it where they leave nothing to choose: over a
//! face of a cuboid ([`face`]) and beside a half-space.

mod contacts;
mod face;
mod half_space;
mod query;
mod refresh;
mod shape;

pub(super) use contacts::NearTriangle;
pub(crate) use query::ConvexPair;
pub(crate) use shape::ConvexShape;
pub(super) use shape::Fingerprint;
