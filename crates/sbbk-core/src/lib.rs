//! Collision detection between triangle meshes with hybrid bounding volume hierarchies: a **s**phere at the root,
//! AA**BB**s in the inner layers, **k**-DOPs in the lower ones. No physics engine: see `rapier-integration` for
//! Rapier.
//!
//! The idea is that of *A Three-layer Hybrid Bounding Volume Hierarchy for Collision Detection*: cheap volumes where
//! most pairs part, tight ones where they do not, and both trees descended at once.
//!
//! * [`volumes`]: [`Sphere`](volumes::Sphere), [`Aabb`](volumes::Aabb), [`Kdop`](volumes::Kdop).
//! * [`tree`]: [`Tree`](tree::Tree), built from a mesh once.
//! * [`traverse`]: [`descend`](traverse::descend) finds the pairs of leaves that may touch at a pose.
//! * [`front`]: the same, from where the last descent stopped.
//! * [`field`]: the triangles of a height field that may touch a mesh.
//! * [`leaf`]: which triangles of two leaves may touch, over SIMD lanes.
//! * [`contact`]: the exact contact of two triangles, and its manifold.
//! * [`query`]: the nearest or deepest triangles of two meshes, and when moving meshes first meet.
//! * [`broad_phase`]: which of many moving objects are near each other.
//! * `truth` (feature `truth`): brute force in f64, to test against.
//!
//! ```
//! use glamx::{Pose3, Vec3};
//! use sbbk_core::contact::contact;
//! use sbbk_core::leaf::LeafTest;
//! use sbbk_core::traverse::{Descent, DescentScratch, LeafPairs, PairFrame, descend};
//! use sbbk_core::tree::{BuildOptions, Tree};
//!
//! // Two tetrahedra, the second one a little above the first.
//! let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
//! let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
//! let tree: Tree = Tree::build(&vertices, &triangles, &BuildOptions::default())?;
//! let pos12 = Pose3::translation(0.0, 0.0, 1.01);
//!
//! let mut frame = PairFrame::new(&tree, &tree, &pos12, 0.02);
//! let mut found = LeafPairs::default();
//! let mut scratch = DescentScratch::default();
//! descend((&tree, &tree), &mut frame, Descent::Simultaneous, &mut scratch, (), &mut found);
//!
//! let test = LeafTest::new(&frame);
//! let mut touching = 0;
//! for (leaf1, leaf2) in found.0 {
//!     let (batch1, batch2) = (tree.leaf(leaf1), tree.leaf(leaf2));
//!     test.survivors(batch1, batch2, |lane1, lane2| {
//!         let origin = batch1.corners(lane1)[0];
//!         let t1 = batch1.corners(lane1).map(|x| (x - origin).as_dvec3());
//!         let t2 = batch2.corners(lane2).map(|x| frame.placement().to_frame1(x, origin));
//!         touching += u32::from(contact(&t1, &t2, 0.02).is_some());
//!     });
//! }
//! // The top of the first one, in three triangles, with the three around the bottom corner of the second one.
//! assert_eq!(touching, 9);
//! # Ok::<(), sbbk_core::tree::BuildError>(())
//! ```

pub mod broad_phase;
pub mod contact;
pub mod field;
pub mod front;
pub mod leaf;
#[cfg(feature = "nalgebra")]
mod nalgebra_conversions;
pub mod query;
pub mod traverse;
pub mod tree;
#[cfg(feature = "truth")]
pub mod truth;
pub mod volumes;
