//! SBBK for Rapier: fast and exact collision of triangle meshes, as a drop-in query dispatcher.
//!
//! ```
//! use rapier_integration::SbbkDispatcher;
//! use rapier3d::prelude::*;
//!
//! let mut world = PhysicsWorld::new();
//! world.narrow_phase.set_query_dispatcher(SbbkDispatcher::default()); // the one line
//! ```
//!
//! Colliders stay plain triangle meshes, and nothing else in a scene changes. Two meshes get the
//! contacts of their surfaces: stacks stand, gears turn, and solids push out bodies that have sunk
//! in.
//!
//! * The [`guide`] says how to prepare meshes, what to set where a scene is difficult, and when not
//!   to use SBBK.
//! * [`SbbkDispatcher::prepare_shape`] registers large meshes.
//! * [`SbbkConfig`] selects contacts and pairs, [`SbbkDispatcher::stats`] counts them, and [`draw`]
//!   shows them.
//! * [`TriangleContacts`] computes the contact of two triangles, for hosts with a midphase of their
//!   own.
//!
//! # Features
//!
//! * `parallel`, `enhanced-determinism`, `serde-serialize`: features of Rapier and Parry with these
//!   names. The last one also serializes [`SbbkConfig`].
//! * `rapier3d`: passes these features on to Rapier. No code needs it.

mod config;
mod dispatcher;
pub mod draw;
pub mod guide;
mod mesh;
mod pair;
mod query;
mod stats;

pub use config::{ContactDetail, ContactSet, Kinds, SbbkConfig};
pub use dispatcher::{PrepareError, PreparedTree, SbbkDispatcher};
pub use pair::TriangleContacts;
pub use sbbk_core;
pub use sbbk_core::surface::SurfaceKind;
pub use stats::{SbbkInternals, SbbkStats};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
