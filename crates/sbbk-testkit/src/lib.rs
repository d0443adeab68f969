//! Meshes, scenes and probes that the tests and measurements of SBBK for Rapier share.
//!
//! [`mesh`] makes triangle meshes, and [`scene`] builds worlds from them. [`probe`] records the
//! queries of a world, and [`world`] describes a world by numbers. [`truth`] converts shapes for
//! brute force, and [`judge`] compares contacts with it.

#![allow(missing_docs, reason = "not published; names that tell all need no sentence")]

pub mod judge;
pub mod mesh;
pub mod probe;
pub mod scene;
pub mod truth;
pub mod world;
