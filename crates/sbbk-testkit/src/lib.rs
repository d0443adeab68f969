//! Meshes and scenes that the tests and measurements of SBBK for Rapier share.
//!
//! [`mesh`] makes triangle meshes, and [`scene`] builds worlds from them. [`world`] describes a
//! world by numbers. [`truth`] converts shapes for brute force, and [`judge`] compares contacts
//! with it.

#![allow(missing_docs, reason = "not published; names that tell all need no sentence")]

pub mod judge;
pub mod mesh;
pub mod scene;
pub mod truth;
pub mod world;
