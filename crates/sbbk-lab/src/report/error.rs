//! Why a report could not be written.

use std::path::{Path, PathBuf};

use thiserror::Error;

/// A file could not be written.
#[derive(Debug, Error)]
#[error("cannot write `{}`: {cause}", path.display())]
pub struct ReportError {
    /// The file.
    pub path: PathBuf,
    /// What the system, or the format's writer, says.
    pub cause: String,
}

impl ReportError {
    pub(super) fn new(path: &Path, cause: impl ToString) -> Self {
        Self { path: path.to_owned(), cause: cause.to_string() }
    }
}
