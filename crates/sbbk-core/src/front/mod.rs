//! Temporal coherence: a descent that starts where the last one stopped.
//!
//! Bodies move little between steps, so a descent stops at nearly the same pairs of nodes as the one before. A [`Front`] keeps
//! these pairs, for one pair of trees (the SBBK paper, section 3.2, figures 3 and 4). Pairs of volumes that come within the margin
//! are replaced by the pairs of their children: the front is *lowered*. The paper stops there; its front is never
//! higher than the deepest contact that ever was. Here, in addition:
//!
//! * **Raising.** A pair whose volumes have parted stands for everything below it again. The rule needs no look
//!   at the children: what is below a separated pair is separated.
//! * **Motion bound.** A pair that was separated by a gap `g` stays so while no point has moved by `g` less the margin
//!   (`clock.rs`); until then it is not tested. A pair of volumes that met is not asked to have parted before it can have.
//! * **Cached axis.** A pair is tested first on the axis that separated it last.
//! * **Adaptive.** Two numbers a cell tell, before anything is tested, how many tests a query needs (`policy.rs`). If
//!   a fresh descent is cheaper, there is one, and no front is kept until motion is slow again.
//!
//! # What is found
//!
//! The margin may differ from query to query: gaps are kept without it. Gaps and motion are bounds that include all
//! rounding (`clock.rs`, and `gaps.rs` of [`traverse`](crate::traverse)), so that every pair of leaves with triangles within
//! the margin is visited. Pairs of leaves that are not are left out if they, or a pair above them, are known to be
//! beyond the margin; the others are visited, at most until motion is four times what can part their volumes. So the
//! pairs of *leaves* may differ from those of a fresh descent, by pairs without triangles within the margin; the
//! pairs of *triangles* within it, by the exact test, do not.
//!
//! # Bound
//!
//! A raised front has at most twice the cells with which it was last built from the roots, and 64 more; 44 bytes each, and
//! 12 for a pair of leaves that meets. A front that only goes down has no bound but all pairs that ever met.
//!
//! # What the parts are worth
//!
//! Two equal meshes of 288 to 12,168 triangles, 2 units across, margin 0.02; times fewer and times faster than fresh
//! descents, geometric means (`cargo run --release --example front` prints them, mesh by mesh;
//! picture in `docs/front.svg`):
//!
//! | tests / traversal | slow | fast | resting, jitter | tumbling |
//! |---|---|---|---|---|
//! | the paper's front | 1.36 / 0.82 | 1.10 / 0.68 | 1.38 / 0.82 | 0.24 / 0.22 |
//! | + raising | 1.00 / 0.71 | 0.99 / 0.69 | 1.00 / 0.70 | 0.88 / 0.54 |
//! | + raising, cached axis | 1.00 / 0.66 | 0.99 / 0.61 | 1.00 / 0.65 | 0.87 / 0.48 |
//! | + raising, motion bound | 8.25 / 2.75 | 2.28 / 1.05 | 12.0 / 3.96 | 1.02 / 0.51 |
//! | + raising, both | 8.18 / 2.60 | 2.26 / 0.97 | 11.9 / 3.77 | 1.01 / 0.47 |
//! | + raising, motion bound, adaptive: the default | 7.05 / 2.59 | 1.54 / 1.07 | 9.64 / 3.64 | 1.00 / 0.98 |
//!
//! Slow is 0.001 units a step, fast 0.01, tumbling 0.08 radians. No pair of triangles differed. (With raising, the pairs
//! above the front are tested along with those in it, and count.)
//!
//! A front that tests everything at each query saves the few pairs above it, a quarter of the tests, and pays for that with
//! its own keeping. The motion bound is what pays. The cached axis does not: four pairs are tested at once, and rarely one axis
//! separates all. Nor does it matter whether the highest or the deepest pairs come first.
//!
//! ```
//! use glamx::{Pose3, Vec3};
//! use sbbk_core::front::Front;
//! use sbbk_core::traverse::{DescentScratch, LeafPairs, PairFrame};
//! use sbbk_core::tree::{BuildOptions, Tree};
//!
//! let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
//! let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
//! let options = BuildOptions { leaf_size: 1, ..BuildOptions::default() };
//! let tree: Tree = Tree::build(&vertices, &triangles, &options)?;
//!
//! let mut front = Front::default();
//! let mut scratch = DescentScratch::default();
//! for step in 0..10 {
//!     let pos12 = Pose3::translation(0.0, 0.0, 0.9 + 1e-4 * step as f32);
//!     let mut frame = PairFrame::new(&tree, &tree, &pos12, 0.02);
//!     let mut found = LeafPairs::default();
//!     front.visit((&tree, &tree), &mut frame, &mut scratch, (), &mut found);
//!     assert!(!found.0.is_empty());
//! }
//! assert_eq!(front.stats().reused, 8);
//! # Ok::<(), sbbk_core::tree::BuildError>(())
//! ```

mod cells;
mod clock;
#[cfg(test)]
mod figure;
#[allow(clippy::module_inception)]
mod front;
mod opening;
mod options;
mod policy;

pub use front::{Front, FrontStats};
pub use options::{FrontOptions, FrontOrder};
