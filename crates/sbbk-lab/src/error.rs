//! The error of studies.

use std::path::{Path, PathBuf};

use thiserror::Error;

/// A file could not be read or written. The message names the file and the fault.
#[derive(Debug, Error)]
#[error("cannot {task} {}: {cause}", path.display())]
pub struct FileError {
    task: &'static str,
    path: PathBuf,
    cause: String,
}

impl FileError {
    pub(crate) fn new(task: &'static str, path: &Path, cause: impl ToString) -> Self {
        Self { task, path: path.to_owned(), cause: cause.to_string() }
    }
}
