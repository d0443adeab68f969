//! The experiments. Each has a plan, standard or quick, carries it out, and returns rows, tables
//! and a picture: [`Results`](crate::report::Results).
//!
//! Times are taken in one process, backends in turn, and without what happens only once: trees that
//! SBBK builds unasked are built before (but in [`everyday`], where they are part of the steps).
//! Wrong contacts are counted on the queries that are timed, or on such ones.

pub mod compare;
pub mod contacts;
pub mod convex;
pub mod cost;
pub mod determinism;
pub mod everyday;
pub mod floor;
pub mod front;
pub mod hard;
mod helicopter;
pub mod layers;
mod meshes;
mod motion;
pub mod one_step;
mod pair;
mod pile;
mod progress;
pub mod queries;
pub mod soak;
pub mod soft;
pub mod terrain;
mod turns;

pub use helicopter::{HelicopterPlan, frames, helicopter};
pub use motion::STEP_COUNT;
pub use pile::{PilePlan, SamePosesPlan, pile, runs};
pub use progress::Progress;

use std::path::PathBuf;

use rapier3d::geometry::{SharedShape, TriMeshFlags};
use sbbk_core::tree::{BuildOptions, LayerPlan, Tree};
use thiserror::Error;

use crate::mesh::Mesh;
use crate::report::ReportError;
use crate::scene;

/// A robot cannot be loaded, a scene is not there, or a page cannot be written.
#[derive(Debug, Error)]
pub enum StudyError {
    /// A URDF file could not be loaded.
    #[error("cannot load the robot {}: {cause}", path.display())]
    Robot {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        cause: String,
    },
    /// No scene has the name that is wanted.
    #[error("no scene of these has `{0}` in its name")]
    NoScene(String),
    /// A page could not be written.
    #[error(transparent)]
    Report(#[from] ReportError),
}

/// Parry's shape of a mesh without flags.
fn shape(mesh: &Mesh) -> SharedShape {
    scene::shape(mesh, TriMeshFlags::empty())
}

/// The tree of a mesh.
fn tree(mesh: &Mesh, layers: Option<LayerPlan>) -> Tree {
    let options = BuildOptions { layers, ..BuildOptions::default() };
    Tree::build(&mesh.vertices, &mesh.triangles, &options).expect("meshes of the studies are sound")
}
