//! What can be wrong with a mesh file.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

/// A mesh file could not be loaded.
#[derive(Debug, Error)]
#[error("cannot load the mesh {}: {cause}", path.display())]
pub struct MeshError {
    /// The file asked for.
    pub path: PathBuf,
    /// What is wrong with it.
    pub cause: MeshErrorCause,
}

/// What is wrong with a mesh file. Vertices and triangles are counted from zero in the order of
/// the file, in glTF of the primitive, and lines from one.
#[derive(Debug, Error)]
pub enum MeshErrorCause {
    /// The file, or one that it names, cannot be read.
    #[error("cannot read {}: {source}", file.display())]
    Read {
        /// The file that cannot be read.
        file: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The extension tells no known format.
    #[error("unknown file extension `{extension}`; known are obj, stl, gltf and glb")]
    UnknownExtension {
        /// What follows the last dot of the file name.
        extension: String,
    },
    /// A line of a text format makes no sense.
    #[error("line {line}, `{text}`: {problem}")]
    Line {
        /// Number of the line, from one.
        line: usize,
        /// The line itself.
        text: String,
        /// What is wrong with it.
        problem: String,
    },
    /// Data ends before what was announced.
    #[error("{what} is cut off: {declared} bytes are declared, {present} are there")]
    Truncated {
        /// The file itself or the part of it that is too short.
        what: String,
        /// Bytes that there should be.
        declared: u64,
        /// Bytes that there are.
        present: u64,
    },
    /// The file breaks the rules of its format in another way.
    #[error("{0}")]
    Format(String),
    /// A triangle uses a vertex that does not exist.
    #[error(
        "triangle {triangle_index} uses vertex {vertex_index}, \
         but there are {vertex_count} vertices"
    )]
    IndexOutOfRange {
        /// The triangle, from zero.
        triangle_index: usize,
        /// The vertex it asks for, from zero.
        vertex_index: u32,
        /// Number of vertices in the file.
        vertex_count: usize,
    },
    /// A coordinate is infinite or not a number.
    #[error("vertex {vertex_index} is not finite: {position:?}")]
    NotFinite {
        /// The vertex, from zero.
        vertex_index: usize,
        /// Its coordinates.
        position: [f32; 3],
    },
    /// There is nothing to collide with.
    #[error("it holds no triangles")]
    NoTriangles,
}

impl MeshErrorCause {
    /// An error when fewer bytes of `what` are present than declared.
    pub(super) fn check_length(what: &str, declared: u64, present: u64) -> Result<(), Self> {
        if present < declared {
            return Err(Self::Truncated { what: what.to_owned(), declared, present });
        }
        Ok(())
    }
}
