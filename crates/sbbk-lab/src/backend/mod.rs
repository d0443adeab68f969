//! Who answers the narrow phase: stock Parry, SBBK, and the comparisons between them.
//!
//! Every backend is installed behind the same [`Timed`] wrapper, so that the clock costs each of
//! them the same. The wrapper's [`Probe`] is read beside the running world:
//!
//! ```
//! use rapier3d::prelude::*;
//! use sbbk_lab::backend::{Backend, PairKind};
//!
//! let mut world = PhysicsWorld::new();
//! let installed = Backend::Sbbk.install(&mut world);
//! world.step();
//! assert_eq!(installed.probe.tally(PairKind::MeshMesh).calls, 0);
//! ```

mod answer;
mod kind;
mod memory;
mod primed;
mod probe;
mod tape;
mod timed;

pub use answer::{Answer, Question, Reported, shape_address};
pub use kind::{Backend, Dispatcher, Installed, SharedDispatcher};
pub use memory::Memory;
pub use primed::Primed;
pub use probe::{PairKind, Probe, Tally, clock_cost};
pub use tape::{Tape, Taped};
pub use timed::Timed;
