//! A mesh and a height field: from a pose to contact manifolds.
//!
//! Stock Parry takes the field for a convex shape here and finds no contacts at all. [`query`] is the way of two meshes, but
//! for the descent: [`sbbk_core::field`] goes down the tree of the mesh and reads the cells under it. [`field`] says what Parry's
//! field is to that descent, [`shapes`] what the pair is to the generator of contacts.
//!
//! Triangles of the field have the numbers that Parry gives them in contacts with convex shapes. Manifolds are in the order in
//! which Parry walks a field and a compound: cell by cell along z, then x, the left triangle first; then by the place of the
//! mesh's triangle in Parry's hierarchy.
//!
//! # Edits
//!
//! Nothing of a field is kept but the candidates of a pair. Rapier drops them when a shape was edited. Should a host not do so,
//! another field, another scale, another flag and a removed triangle are noticed; that a triangle was added, or a cell
//! divided along its other diagonal, only where the pair descends next.

mod field;
mod query;
mod shapes;

pub(crate) use query::FieldPair;
