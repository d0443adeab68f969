//! From a path to a checked mesh.

use std::ffi::OsStr;
use std::fs;
use std::path::Path;

use super::{MeshError, MeshErrorCause, gltf, obj, stl};
use crate::mesh::Mesh;

/// Loads a mesh from an `.obj`, `.stl` (text or binary), `.gltf` or `.glb` file, in the file's own
/// units, named after the file.
///
/// All objects of the file become one mesh, faces of more than three corners are cut into
/// triangles, glTF nodes are placed as the default scene places them, and equal positions are
/// welded. Degenerate triangles are kept; [`Mesh::degenerate_count`] tells how many.
///
/// Errors: the file cannot be read, its extension or contents make no sense, or it holds no
/// triangles; see [`MeshErrorCause`].
pub fn load(path: &Path) -> Result<Mesh, MeshError> {
    read(path).map_err(|cause| MeshError { path: path.to_owned(), cause })
}

/// The bytes of a file, or which could not be read.
pub(super) fn bytes(path: &Path) -> Result<Vec<u8>, MeshErrorCause> {
    fs::read(path).map_err(|source| MeshErrorCause::Read { file: path.to_owned(), source })
}

fn read(path: &Path) -> Result<Mesh, MeshErrorCause> {
    let text = |part: Option<&OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    let extension = text(path.extension());
    let mesh = match extension.to_ascii_lowercase().as_str() {
        "obj" => obj::parse(&bytes(path)?)?,
        "stl" => stl::parse(&bytes(path)?)?,
        "gltf" | "glb" => gltf::parse(&bytes(path)?, path.parent().unwrap_or(Path::new("")))?,
        _ => return Err(MeshErrorCause::UnknownExtension { extension }),
    };
    check(&mesh)?;
    Ok(mesh.welded().named(text(path.file_stem())))
}

fn check(mesh: &Mesh) -> Result<(), MeshErrorCause> {
    match mesh.triangles.is_empty() {
        true => Err(MeshErrorCause::NoTriangles),
        false => check_geometry(mesh),
    }
}

/// Checks that all vertices that triangles use exist, and that all vertices are finite.
pub(super) fn check_geometry(mesh: &Mesh) -> Result<(), MeshErrorCause> {
    let vertex_count = mesh.vertices.len();
    for (triangle_index, triangle) in mesh.triangles.iter().enumerate() {
        if let Some(&vertex_index) = triangle.iter().find(|&&i| i as usize >= vertex_count) {
            return Err(MeshErrorCause::IndexOutOfRange {
                triangle_index,
                vertex_index,
                vertex_count,
            });
        }
    }
    match mesh.vertices.iter().position(|v| !v.is_finite()) {
        None => Ok(()),
        Some(vertex_index) => Err(MeshErrorCause::NotFinite {
            vertex_index,
            position: mesh.vertices[vertex_index].to_array(),
        }),
    }
}
