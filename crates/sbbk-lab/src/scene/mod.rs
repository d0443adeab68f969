//! Scenes as data: examples, tests and benchmarks build the same worlds.
//!
//! Units are metres, kilograms and seconds; `y` is up; gravity, time step and all other parameters
//! are Rapier's defaults unless a scene says otherwise. Worlds come with stock Rapier's
//! dispatcher; [`Backend::install`](crate::backend::Backend::install) exchanges it.
//!
//! ```
//! use sbbk_lab::scene::{MonkeyPile, Scene};
//!
//! let mut pile = MonkeyPile::with_heads(8).build()?;
//! pile.world.step();
//! assert_eq!(pile.watched.len(), 8);
//! # Ok::<(), sbbk_lab::scene::SceneError>(())
//! ```

mod box_stack;
mod built;
mod head_on_slope;
mod heads_on_terrain;
mod helicopter;
mod pile;
mod portrait;
pub(crate) mod random;
mod soft_heads;
mod solid;
mod two_meshes;

pub use box_stack::BoxStack;
pub use built::{Scene, SceneError, SceneWorld};
pub use head_on_slope::HeadOnSlope;
pub use heads_on_terrain::{Ground, HeadsOnTerrain};
pub use helicopter::{BallKind, HelicopterBallDrop};
pub use pile::MonkeyPile;
pub use soft_heads::SoftHeads;
pub use solid::Solid;
pub use two_meshes::TwoMeshes;
