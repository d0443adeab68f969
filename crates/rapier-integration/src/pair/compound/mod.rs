//! A mesh and a compound of convex shapes: from a pose to contact manifolds.
//!
//! Each part that comes near is a pair of the mesh and a convex shape ([`super::convex`]), with a state of its own ([`state`]);
//! [`query`] finds these parts by the compound's own hierarchy, deals the manifolds out to them and puts them together
//! again in stock order. Stock Parry asks the hierarchy of the one shape for each part of the other, in every step.

mod query;
mod state;

pub(crate) use query::CompoundPair;
