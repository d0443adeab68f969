//! Errors of studies and of their files.

use std::path::{Path, PathBuf};

use thiserror::Error;

/// A study cannot be run.
#[derive(Debug, Error)]
pub enum StudyError {
    /// A file could not be read or written. The message names the file and the fault.
    #[error("cannot {task} {}: {cause}", path.display())]
    File { task: &'static str, path: PathBuf, cause: String },
    /// No scene has the name that `--scene` asks for.
    #[error("no scene of these has `{0}` in its name")]
    NoScene(String),
}

impl StudyError {
    pub(crate) fn file(task: &'static str, path: &Path, cause: impl ToString) -> Self {
        Self::File { task, path: path.to_owned(), cause: cause.to_string() }
    }
}
