//! Collision detection between triangle meshes with hybrid bounding volume hierarchies: a
//! **s**phere at the root, AA**BB**s in the inner layers, **k**-DOPs in the lower ones. No physics
//! engine: see `rapier-integration` for Rapier.
//!
//! The idea is that of *A Three-layer Hybrid Bounding Volume Hierarchy for Collision Detection*:
//! cheap volumes where most pairs part, tight ones where they do not, and both trees descended at
//! once.
//!
//! ```
//! use glamx::{Pose3, Vec3};
//! use sbbk_core::query::{SearchScratch, contacts};
//! use sbbk_core::traverse::Placement;
//! use sbbk_core::tree::{BuildOptions, Tree};
//!
//! // Two tetrahedra, the second one a little above the first: the top of the first, in three
//! // triangles, is near the three around the bottom corner of the second.
//! let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
//! let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
//! let tree: Tree = Tree::build(&vertices, &triangles, &BuildOptions::default())?;
//! let placement = Placement::new(&Pose3::translation(0.0, 0.0, 1.01));
//! let mut pairs = Vec::new();
//! let mut scratch = SearchScratch::default();
//! contacts((&tree, &tree), placement, 0.02, &mut scratch, |pair| pairs.push(pair));
//! assert_eq!(pairs.len(), 9);
//! # Ok::<(), sbbk_core::tree::BuildError>(())
//! ```
//!
//! * [`tree`]: [`Tree`](tree::Tree), built from a mesh once, and a read-only walk over its nodes.
//! * [`query`]: all contacts of two meshes, the nearest or deepest triangles, and when moving
//!   meshes first meet.
//! * [`contact`]: the exact contact of two triangles, and its manifold; the contact of a triangle
//!   and a convex shape.
//!
//! Below these, for a midphase or narrow phase of one's own:
//!
//! * [`volumes`]: [`Sphere`](volumes::Sphere), [`Aabb`](volumes::Aabb), [`Kdop`](volumes::Kdop).
//! * [`traverse`]: [`descend`](traverse::descend) finds the pairs of leaves that may touch at a
//!   pose; [`BoxTest`](traverse::BoxTest) compares boxes of other hierarchies.
//! * [`leaf`]: which triangles of two leaves, or of batches gathered elsewhere, may touch, over
//!   SIMD lanes.
//! * [`field`]: the triangles of a height field that may touch a mesh.
//! * [`surface`]: which triangles of a mesh are neighbours, and whether it bounds a solid.
//! * [`front`]: a descent that starts where the last one stopped.
//! * [`broad_phase`]: which of many moving objects are near each other.
//! * [`draw`]: the volumes of a layer, and the candidates of a query, as lines.
//! * [`collections`]: lists of numbers, and groups.
//! * `truth` (feature `truth`): brute force in f64, to test against.
//!
//! Modules depend one way: `simd` (lanes), [`volumes`], [`tree`], [`traverse`], [`leaf`], then
//! [`field`], [`front`] and [`query`]. [`contact`], which [`query`] uses, and [`broad_phase`] need
//! none of them; [`surface`] uses the names of features of [`contact`], and [`collections`].

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

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
