//! Meshes from OBJ and STL files.

use std::path::Path;
use std::{fs, io};

use glamx::Vec3;
use mesh_loader::Loader;

use crate::mesh::Mesh;
use crate::report::file_error;

/// Loads an `.obj` or `.stl` file as one welded mesh in the file's own units, named after the file.
/// Faces with more than three corners are cut into triangles.
///
/// Errors: the file cannot be read, or its extension or contents make no sense. A coordinate is not
/// finite, or there are no triangles.
pub fn load(path: &Path) -> io::Result<Mesh> {
    read(path).map_err(|cause| file_error("load the mesh", path, cause))
}

fn read(path: &Path) -> Result<Mesh, String> {
    // Materials are not needed.
    let reader = |file: &Path| match file == path {
        true => fs::read(file),
        false => Err(io::ErrorKind::NotFound.into()),
    };
    let scene = Loader::default().load_with_reader(path, reader);
    let scene = scene.map_err(|error| error.to_string())?;
    let parts = scene.meshes.into_iter().map(|mesh| {
        let vertices = mesh.vertices.into_iter().map(Vec3::from_array).collect();
        Mesh::new(mesh.name, vertices, mesh.faces)
    });
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let mesh = Mesh::merged(name, &parts.collect::<Vec<Mesh>>()).welded();
    if mesh.triangles.is_empty() {
        return Err("the file has no triangles".to_owned());
    }
    let is_bad = |vertex: &&Vec3| !vertex.is_finite();
    match mesh.vertices.iter().find(is_bad) {
        Some(vertex) => Err(format!("a vertex is not finite: {vertex}")),
        None => Ok(mesh),
    }
}
