//! The studies. Each has a plan, standard or quick, and returns a verdict, rows and tables:
//! [`Results`].
//!
//! Times are taken in one process, backends in turn. Trees are built before; in [`everyday`] they
//! are part of the steps. Wrong contacts are counted on the queries that are timed, or on
//! queries made in the same way.

use crate::prelude::*;
pub mod compare;
pub mod contacts;
pub mod convex;
pub mod everyday;
pub mod hard;
mod motion;
pub mod one_step;
mod pair;
pub mod pile;
mod turns;

use thiserror::Error;

/// A study cannot be run.
#[derive(Debug, Error)]
pub enum StudyError {
    /// A URDF file could not be loaded.
    #[error("cannot load the robot {}: {cause}", path.display())]
    Robot {
        /// The file.
        path: PathBuf,
        /// The fault.
        cause: String,
    },
    /// No scene has the name that `--scene` asks for.
    #[error("no scene of these has `{0}` in its name")]
    NoScene(String),
    /// A page could not be written.
    #[error(transparent)]
    Report(#[from] ReportError),
}
