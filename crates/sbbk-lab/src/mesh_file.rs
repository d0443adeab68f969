//! Meshes from OBJ and STL files.

use std::io;
use std::path::{Path, PathBuf};

use glamx::Vec3;
use mesh_loader::Loader;
use thiserror::Error;

use crate::mesh::Mesh;

/// A mesh file could not be loaded. The message names the file and the fault.
#[derive(Debug, Error)]
#[error("cannot load the mesh {}: {cause}", path.display())]
pub struct MeshError {
    path: PathBuf,
    cause: Cause,
}

#[derive(Debug, Error)]
enum Cause {
    #[error(transparent)]
    Io(#[from] io::Error),
    #[error("unknown file extension; known are obj and stl")]
    Extension,
    #[error("triangle {triangle} uses vertex {vertex}, but there are {vertex_count} vertices")]
    IndexOutOfRange { triangle: usize, vertex: u32, vertex_count: usize },
    #[error("vertex {vertex} is not finite: {position}")]
    NotFinite { vertex: usize, position: Vec3 },
    #[error("the file has no triangles")]
    Empty,
}

/// Loads an `.obj` or `.stl` file as one welded mesh in the file's own units, named after the file.
/// Faces with more than three corners are cut into triangles.
///
/// Errors: the file cannot be read, its extension or contents make no sense, an index is out of
/// range, a coordinate is not finite, or there are no triangles.
pub fn load(path: &Path) -> Result<Mesh, MeshError> {
    read(path).map_err(|cause| MeshError { path: path.to_owned(), cause })
}

fn read(path: &Path) -> Result<Mesh, Cause> {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let bytes = std::fs::read(path)?;
    let loader = Loader::default();
    // The second argument is asked for materials, which are not needed.
    let scene = match &*extension {
        "obj" => loader.load_obj_from_slice_with_reader(&bytes, path, |_| {
            Err(io::ErrorKind::NotFound.into())
        })?,
        "stl" => loader.load_stl_from_slice(&bytes, path)?,
        _ => return Err(Cause::Extension),
    };
    let parts = scene.meshes.into_iter().map(|mesh| {
        let vertices = mesh.vertices.into_iter().map(Vec3::from_array).collect();
        Mesh::new(mesh.name, vertices, mesh.faces)
    });
    let parts: Vec<Mesh> = parts.collect();
    parts.iter().try_for_each(check)?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let mesh = Mesh::merged(name, &parts).welded();
    if mesh.triangles.is_empty() { Err(Cause::Empty) } else { Ok(mesh) }
}

fn check(part: &Mesh) -> Result<(), Cause> {
    let vertex_count = part.vertices.len();
    for (triangle, corners) in part.triangles.iter().enumerate() {
        if let Some(&vertex) = corners.iter().find(|&&index| index as usize >= vertex_count) {
            return Err(Cause::IndexOutOfRange { triangle, vertex, vertex_count });
        }
    }
    match part.vertices.iter().position(|position| !position.is_finite()) {
        Some(vertex) => Err(Cause::NotFinite { vertex, position: part.vertices[vertex] }),
        None => Ok(()),
    }
}
