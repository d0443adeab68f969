//! For users of bare trees who ask about one pair again and again, and for the SBBK paper's figures
//! 3 and 4: a descent that starts where the last one of the pair stopped. Rapier's dispatcher does
//! without it; candidates kept with a [slack](crate::traverse::Slack) serve it better.
//!
//! Bodies move little between steps, so a descent stops at nearly the same pairs of nodes as the
//! one before. A [`Front`] keeps these pairs, for one pair of trees (section 3.2 of the paper).
//! Pairs of volumes that come within the margin are replaced by the pairs of their children: the
//! front is *lowered*. [`FrontOptions::Paper`] stops there; such a front is never higher than the
//! deepest contact that ever was. [`FrontOptions::Adaptive`], the default, has in addition:
//!
//! * **Raising.** A pair whose volumes have parted stands for everything below it again, without a
//!   look at the children: what is below a separated pair is separated.
//! * **Motion bound.** A pair that was separated by a gap `g` is not tested while no point has
//!   moved by `g` less the margin (`clock.rs`), nor a pair that met before it can have parted.
//! * **Fresh descents.** Two numbers a cell tell, before anything is tested, how many tests a query
//!   needs (`policy.rs`). If a fresh descent is cheaper, there is one, and no front is kept until
//!   motion is slow again.
//!
//! # What is found
//!
//! The pairs of *triangles* within the margin, by the exact test, are those of a fresh descent. The
//! pairs of *leaves* may differ, by pairs without triangles within the margin: a pair that met is
//! visited until motion is at most four times what can part its volumes.
//!
//! The margin may differ from query to query: gaps are kept without it. Gaps and motion are bounds
//! that include all rounding (`clock.rs`, and `gaps.rs` of [`traverse`](crate::traverse)).
//!
//! # Memory
//!
//! An adaptive front has at most twice the cells with which it was last built from the roots, and
//! 64 more; 44 bytes each, and 12 for a pair of leaves that meets. The paper's has no bound but all
//! pairs that ever met.
//!
//! # What it is worth
//!
//! Two equal meshes of 288 to 12,168 triangles, 2 units across, margin 0.02; times fewer node tests
//! and times faster traversal than fresh descents, geometric means (`cargo run --release --example
//! front` prints them mesh by mesh; picture in `docs/front.svg`):
//!
//! | tests / traversal | slow | fast | resting, jitter | tumbling |
//! |---|---|---|---|---|
//! | the paper's front | 1.36 / 0.82 | 1.10 / 0.68 | 1.38 / 0.82 | 0.24 / 0.22 |
//! | adaptive | 7.05 / 2.59 | 1.54 / 1.07 | 9.64 / 3.64 | 1.00 / 0.98 |
//!
//! Slow is 0.001 units a step, fast 0.01, tumbling 0.08 radians. No pair of triangles differed. A
//! front that tests everything at each query saves the few pairs above it, a quarter of the tests,
//! and pays for that with its own keeping: the motion bound is what pays.
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
pub use options::FrontOptions;
