#![doc = include_str!("../README.md")]
//!
//! # Modules
//!
//! The names at the root are enough for queries of meshes. The modules serve authors of a midphase
//! or narrow phase:
//!
//! | module | content |
//! |---|---|
//! | [`volumes`] | sphere, AABB, k-DOP, and the bounds on their rounding |
//! | [`tree`] | build and layout of a tree, and a walk over its nodes |
//! | [`traverse`] | descent of two trees, placements, slack |
//! | [`leaf`] | SIMD test of the triangles of two leaves |
//! | [`mod@contact`] | exact contact of two triangles, or of a triangle and a convex shape |
//! | [`collections`] | union-find |
//! | [`surface`] | adjacency of a mesh; solid or sheet |
//! | [`query`] | contacts, distance, overlap, casts of two meshes |
//! | [`field`] | triangles of a height field near a mesh |
//! | [`draw`] | lines for a debug renderer |
//! | [`front`], [`broad_phase`] | the paper's, to reproduce it |
//!
//! Each module uses only those above it.

// The inputs of the tests know this crate by its name.
#[cfg(test)]
extern crate self as sbbk_core;

pub mod broad_phase;
pub mod collections;
pub mod contact;
pub mod draw;
pub mod field;
pub mod front;
pub mod leaf;
pub mod query;
mod simd;
#[cfg(test)]
#[path = "../tests/support/mod.rs"]
mod support;
pub mod surface;
pub mod traverse;
pub mod tree;
pub mod volumes;

pub use contact::contact;
pub use query::{SearchScratch, cast, contacts, deepest, meeting, nearest};
pub use surface::Surface;
pub use traverse::Placement;
pub use tree::{BuildError, Tree};
