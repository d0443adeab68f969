use std::error::Error;
use std::fmt;

use sbbk_core::tree::BuildError;

/// Says why a mesh cannot be prepared.
#[derive(Clone, Debug, PartialEq)]
pub struct PrepareError {
    cause: BuildError,
}

impl From<BuildError> for PrepareError {
    fn from(cause: BuildError) -> Self {
        Self { cause }
    }
}

impl fmt::Display for PrepareError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cannot prepare this mesh: {}. ", self.cause)?;
        f.write_str(match self.cause {
            BuildError::NotFinite { .. } => {
                "Remove or repair the triangles of that vertex. Until then their contacts are lost"
            }
            BuildError::NoTriangles => "Leave out its collider",
            BuildError::TooManyTriangles { .. } => "Split it into several colliders",
            BuildError::IndexOutOfRange { .. } => "Check how its index buffer was made",
            _ => "Use the default `SbbkConfig::layers`",
        })
    }
}

impl Error for PrepareError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        Some(&self.cause)
    }
}
