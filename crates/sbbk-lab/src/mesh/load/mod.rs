//! Mesh files: OBJ, STL, glTF and GLB.
//!
//! Each format has a reader that turns bytes into positions and triangles as they stand in the
//! file, with the errors of that format; [`load`] then checks indices and coordinates in one
//! place and welds equal positions.

mod error;
mod file;
mod gltf;
mod gltf_buffers;
mod lines;
mod obj;
mod stl;

pub use error::{MeshError, MeshErrorCause};
pub use file::load;
