//! Errors of files.

use std::fmt::Display;
use std::io;
use std::path::Path;

/// Says what could not be done with a file, and why.
pub(crate) fn file_error(task: &str, path: &Path, cause: impl Display) -> io::Error {
    io::Error::other(format!("cannot {task} {}: {cause}", path.display()))
}
