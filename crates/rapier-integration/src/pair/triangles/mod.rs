//! Pairs of which both shapes are made of triangles: two meshes ([`meshes`]), a mesh and a height
//! field ([`heightfield`]).
//!
//! Candidates are pairs of triangles. Their contacts are exact ([`sbbk_core::contact`]), or Parry's
//! if the host wants those.

mod exact;
mod field;
mod heightfield;
mod inside;
mod judge;
mod meshes;
mod query;
mod regions;
mod walk;

pub use exact::TriangleContacts;
pub(crate) use heightfield::FieldPair;
pub(crate) use meshes::MeshPair;
pub(super) use query::Found;
pub(crate) use regions::Regions;
pub(crate) use walk::walk;
