//! For users of bare trees, without a physics engine: all pairs of moving objects whose bounding
//! spheres and bounding boxes come within a margin. Rapier has its own broad phase and takes no
//! other.
//!
//! This is the sphere stage of "A Three-layer Hybrid Bounding Volume Hierarchy for Collision
//! Detection" for a whole world of objects. A step reports which pairs started and which ended;
//! the pairs are at every step exactly those of [`Bounds::is_pair_with`].
//!
//! ```
//! use glamx::Vec3;
//! use sbbk_core::broad_phase::{Bounds, BroadPhase, PairEvent};
//!
//! let unit_ball = |x: f32| {
//!     let centre = Vec3::new(x, 0.0, 0.0);
//!     Bounds { centre, radius: 1.0, min: centre - 1.0, max: centre + 1.0 }
//! };
//!
//! let mut broad_phase = BroadPhase::new(0.02)?;
//! let still = broad_phase.insert(&unit_ball(0.0))?;
//! let moving = broad_phase.insert(&unit_ball(5.0))?;
//! broad_phase.step(|event| panic!("too far apart for {event:?}"));
//!
//! broad_phase.update(moving, &unit_ball(2.01))?;
//! broad_phase.step(|event| assert_eq!(event, PairEvent::Started([still, moving])));
//! assert!(broad_phase.pairs().eq([[still, moving]]));
//!
//! broad_phase.remove(still)?;
//! broad_phase.step(|event| assert_eq!(event, PairEvent::Ended([still, moving])));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Choice of the structure
//!
//! A tree of eight children a node that descends into itself (`block_tree.rs`). On piles, rows,
//! clusters and mixed sizes of 2000 and 20,000 objects, sweep and prune, a hashed grid, a dynamic
//! tree of fat boxes and a rebuilt binned BVH took 1.4 to 33 times as long, but for the sweep in a
//! long row and in 2000 clustered objects (0.7 to 0.9). The repository's benchmark `broad_phase`
//! compares with the tree that Rapier uses, Parry's.
//!
//! Tried within the tree and dropped, as time over what is kept: an order along a Morton curve
//! instead of cuts across the widest axis, 1.0 in the row and 1.6 to 1.9 elsewhere; objects divided
//! by size before they are cut by place, 1.1 to 3.6 where sizes differ; four lanes instead of eight
//! on SSE2, 1.0 to 1.35.

mod block_tree;
mod bounds;
mod counting_sort;
mod handle;
mod lanes;
mod order;
mod pairs;
mod phase;

pub use bounds::{Bounds, BoundsError};
pub use handle::{CapacityExceeded, ObjectHandle, StaleHandle};
pub use phase::{BroadPhase, InsertError, MarginError, ObjectPair, PairEvent, UpdateError};
