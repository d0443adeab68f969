//! Queries about two meshes at a pose: all contacts, the nearest or deepest pair of triangles, a
//! pair that meets, the first impact of moving meshes.
//!
//! [`contacts`] is a descent. The queries with one result share a best-first search (`seek.rs`): it
//! descends both trees at once, the pair of nodes with the least lower bound first. Pairs that
//! cannot beat the best pair of triangles so far are pruned. The bound is the signed distance of
//! volumes for [`nearest`], and the earliest time of approach for [`cast`]; [`meeting`] has none.
//! Pairs of triangles are compared exactly, in f64 ([`contact`](mod@crate::contact)).
//!
//! ```
//! use glamx::{Pose3, Vec3};
//! use sbbk_core::query::{SearchScratch, nearest};
//! use sbbk_core::traverse::{PairFrame, Placement};
//! use sbbk_core::tree::Tree;
//!
//! let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
//! let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
//! let tree = Tree::build(&vertices, &triangles, None)?;
//!
//! let placement = Placement::new(&Pose3::translation(0.0, 0.0, 3.0));
//! let mut scratch = SearchScratch::default();
//! let found = nearest((&tree, &tree), placement, f64::INFINITY, &mut scratch);
//! assert_eq!(found.expect("no limit").contact.distance, 2.0);
//! # Ok::<(), sbbk_core::tree::BuildError>(())
//! ```
//!
//! Meshes are surfaces: one inside another is apart from it. A pose or velocity that is not finite
//! has no answer. Answers depend on the trees and the pose only.

mod advance;
mod cast;
mod contacts;
mod nearest;
mod seek;
mod triangles;

pub use advance::{
    Advance, AdvanceOptions, Bodies, MeshBodies, PartPair, advance, advance_from_contact,
};
pub use cast::{Cast, CastOptions, cast, first_minimum, first_that_counts};
pub use contacts::{contacts, meeting};
pub use nearest::{deepest, nearest};
pub use seek::{SearchScratch, best_first};
pub use triangles::{FoundPair, TrianglePair};
