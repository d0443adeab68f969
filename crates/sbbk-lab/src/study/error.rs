//! Why an experiment could not be done.

use sbbk_core::tree::BuildError;
use thiserror::Error;

use crate::scene::SceneError;

/// A mesh does not serve.
#[derive(Debug, Error)]
pub enum StudyError {
    /// A scene could not be built.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A mesh could not have a tree.
    #[error("no tree can be built for the mesh `{mesh}`: {cause}")]
    Tree {
        /// Name of the mesh.
        mesh: String,
        /// What is wrong with it.
        #[source]
        cause: BuildError,
    },
}
