//! Collision detection between triangle meshes with hybrid bounding volume hierarchies.
//!
//! A tree has a **s**phere at the root, AA**BB**s in the upper layers and **k**-DOPs (k = 18) in
//! the lower ones. Queries descend two trees at once, after the paper *A Three-layer Hybrid
//! Bounding Volume Hierarchy for Collision Detection*. The crate has no physics:
//! `rapier-integration` is its plugin for Rapier.
//!
//! ```
//! use glamx::{Pose3, Vec3};
//! use sbbk_core::{BuildOptions, Placement, SearchScratch, Tree, contacts};
//!
//! // Two tetrahedra, the second one a little above the first: the top of the first, in three
//! // triangles, is near the three around the bottom corner of the second.
//! let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
//! let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
//! let tree = Tree::build(&vertices, &triangles, &BuildOptions::default())?;
//! let placement = Placement::new(&Pose3::translation(0.0, 0.0, 1.01));
//! let mut pairs = Vec::new();
//! let mut scratch = SearchScratch::default();
//! contacts((&tree, &tree), placement, 0.02, &mut scratch, |pair| pairs.push(pair));
//! assert_eq!(pairs.len(), 9);
//! # Ok::<(), sbbk_core::BuildError>(())
//! ```
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
//! | `truth` (feature `truth`) | brute force in f64, for tests |
//!
//! Each module uses only those above it.

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
#[cfg(feature = "truth")]
pub mod truth;
pub mod volumes;

pub use contact::contact;
pub use query::{SearchScratch, cast, contacts, deepest, meeting, nearest};
pub use surface::Surface;
pub use traverse::Placement;
pub use tree::{BuildError, BuildOptions, Tree};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
