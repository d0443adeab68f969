//! Mesh files: OBJ through `tobj`, STL through `stl_io`, glTF and GLB through `gltf`.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use data_url::DataUrl;
use glamx::{Mat4, Vec3};
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::Source;
use gltf::mesh::Mode;
use gltf::{Accessor, Gltf, Node, Primitive, Semantic};
use percent_encoding::percent_decode_str;
use thiserror::Error;
use tobj::LoadOptions;

use super::Mesh;

/// A mesh file could not be loaded; the message names the file and what is wrong with it.
#[derive(Debug, Error)]
#[error("cannot load the mesh {}: {cause}", path.display())]
pub struct MeshError {
    path: PathBuf,
    cause: Cause,
}

/// Vertices and triangles are counted from zero, in each object of the file in order of use.
#[derive(Debug, Error)]
enum Cause {
    #[error(transparent)]
    Io(#[from] io::Error),
    #[error(transparent)]
    Obj(#[from] tobj::LoadError),
    #[error(transparent)]
    Gltf(#[from] gltf::Error),
    #[error("{0}")]
    Format(String),
    #[error("unknown file extension; known are obj, stl, gltf and glb")]
    Extension,
    #[error("triangle {triangle} uses vertex {vertex}, but there are {vertex_count} vertices")]
    IndexOutOfRange { triangle: usize, vertex: u32, vertex_count: usize },
    #[error("vertex {vertex} is not finite: {position}")]
    NotFinite { vertex: usize, position: Vec3 },
    #[error("it holds no triangles")]
    Empty,
}

/// Loads a mesh from an `.obj`, `.stl` (text or binary), `.gltf` or `.glb` file, in the file's own
/// units, named after the file.
///
/// All objects of the file become one mesh, faces of more than three corners are cut into
/// triangles, glTF nodes are placed as the scene places them, and equal positions are welded.
/// Degenerate triangles are kept.
///
/// Errors: the file cannot be read, its extension or contents make no sense, an index is out of
/// range, a coordinate is not finite, or there are no triangles.
pub fn load(path: &Path) -> Result<Mesh, MeshError> {
    let read = || -> Result<Mesh, Cause> {
        let extension = path.extension().unwrap_or_default().to_string_lossy();
        let parts = match extension.to_ascii_lowercase().as_str() {
            "obj" => obj(&String::from_utf8_lossy(&fs::read(path)?))?,
            "stl" => vec![stl(fs::read(path)?)?],
            "gltf" | "glb" => gltf(&fs::read(path)?, path.parent().unwrap_or(Path::new("")))?,
            _ => return Err(Cause::Extension),
        };
        parts.iter().try_for_each(check)?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let mesh = Mesh::merged(name, &parts).welded();
        if mesh.triangles.is_empty() { Err(Cause::Empty) } else { Ok(mesh) }
    };
    read().map_err(|cause| MeshError { path: path.to_owned(), cause })
}

/// Checks what every format can get wrong, in each object before they are merged.
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

/// Positions and faces only: `tobj` would take polylines for faces and look for materials.
fn obj(text: &str) -> Result<Vec<Mesh>, Cause> {
    let is_geometry = |line: &&str| matches!(line.split_whitespace().next(), Some("v" | "f"));
    let geometry = text.lines().filter(is_geometry).collect::<Vec<_>>().join("\n");
    let options = LoadOptions {
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
        ..LoadOptions::default()
    };
    let no_materials = |_: &Path| Err(tobj::LoadError::OpenFileFailed);
    let (models, _) = tobj::load_obj_buf(&mut geometry.as_bytes(), &options, no_materials)?;
    let parts = models.into_iter().map(|model| {
        let (positions, _) = model.mesh.positions.as_chunks::<3>();
        let (triangles, _) = model.mesh.indices.as_chunks::<3>();
        let vertices = positions.iter().copied().map(Vec3::from_array).collect();
        Mesh::new(model.name, vertices, triangles.to_vec())
    });
    Ok(parts.collect())
}

/// Prepares the bytes for `stl_io`, which takes a binary file whose header begins with `solid` for
/// text, reads one solid of a text, and wants a space after its keyword.
fn stl(mut bytes: Vec<u8>) -> Result<Mesh, Cause> {
    let count = bytes.get(80..).and_then(|rest| rest.first_chunk()).copied();
    let is_binary = count
        .is_some_and(|count| bytes.len() as u64 >= 84 + 50 * u64::from(u32::from_le_bytes(count)));
    if is_binary {
        bytes[..80].fill(0);
    } else if bytes.starts_with(b"solid") {
        let text = String::from_utf8_lossy(&bytes);
        let is_frame =
            |line: &&str| matches!(line.split_whitespace().next(), Some("solid" | "endsolid"));
        let facets: Vec<&str> = text.lines().filter(|line| !is_frame(line)).collect();
        bytes = format!("solid \n{}\nendsolid", facets.join("\n")).into_bytes();
    }
    let mesh = stl_io::read_stl(&mut io::Cursor::new(bytes))?;
    let vertices = mesh.vertices.iter().map(|vertex| Vec3::from_array(vertex.0)).collect();
    let triangles = mesh.faces.iter().map(|face| face.vertices.map(|index| index as u32));
    Ok(Mesh::new("stl", vertices, triangles.collect()))
}

/// The meshes of the default scene, else of the first, in its frame. Files that the document names
/// are looked up in `folder`.
fn gltf(bytes: &[u8], folder: &Path) -> Result<Vec<Mesh>, Cause> {
    let gltf = Gltf::from_slice(bytes)?;
    let buffers = buffers(&gltf, folder)?;
    let scene = gltf.default_scene().or(gltf.scenes().next());
    let scene = scene.ok_or_else(|| Cause::Format("it holds no scene".to_owned()))?;
    let mut parts = Vec::new();
    let mut open: Vec<(Node, Mat4)> = scene.nodes().map(|node| (node, Mat4::IDENTITY)).collect();
    let mut nodes_left = gltf.nodes().count();
    while let Some((node, parent)) = open.pop() {
        nodes_left = nodes_left.checked_sub(1).ok_or_else(|| {
            Cause::Format("a node is its own ancestor or has two parents".to_owned())
        })?;
        let transform = parent * Mat4::from_cols_array_2d(&node.transform().matrix());
        for primitive in node.mesh().iter().flat_map(|mesh| mesh.primitives()) {
            let mut part = primitive_mesh(&primitive, &buffers)?;
            if transform.determinant() < 0.0 {
                // Mirrored: turned inside out to face outwards again.
                part.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
            }
            parts.push(part.mapped(|point| transform.transform_point3(point)));
        }
        open.extend(node.children().map(|child| (child, transform)));
    }
    Ok(parts)
}

/// All buffers of a document: from the binary part, from data URIs, and from files in `folder`.
/// `gltf` would load them itself, but brings decoders of images along for it.
fn buffers(gltf: &Gltf, folder: &Path) -> Result<Vec<Vec<u8>>, Cause> {
    let load = |source: Source| match source {
        Source::Bin => gltf.blob.clone().ok_or_else(|| "there is no binary part".to_owned()),
        Source::Uri(uri) if uri.starts_with("data:") => {
            let url = DataUrl::process(uri).map_err(|error| format!("{error:?}"))?;
            Ok(url.decode_to_vec().map_err(|error| error.to_string())?.0)
        }
        Source::Uri(uri) => {
            let file = folder.join(&*percent_decode_str(uri).decode_utf8_lossy());
            fs::read(&file).map_err(|error| format!("cannot read {}: {error}", file.display()))
        }
    };
    let buffers = gltf.buffers().map(|buffer| {
        let index = buffer.index();
        load(buffer.source()).map_err(|cause| Cause::Format(format!("buffer {index}: {cause}")))
    });
    buffers.collect()
}

/// The triangles of a primitive in its own frame, none where it draws points or lines.
fn primitive_mesh(primitive: &Primitive, buffers: &[Vec<u8>]) -> Result<Mesh, Cause> {
    let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(Vec::as_slice));
    let positions = primitive.get(&Semantic::Positions);
    let vertices = positions
        .filter(|accessor| is_list(accessor, Dimensions::Vec3, &[DataType::F32]))
        .and_then(|_| reader.read_positions());
    let vertices = vertices.ok_or_else(|| unreadable(primitive, "positions"))?;
    let vertices: Vec<Vec3> = vertices.map(Vec3::from_array).collect();
    let indices: Vec<u32> = match primitive.indices() {
        None => (0..vertices.len() as u32).collect(),
        Some(accessor) => {
            let types = [DataType::U8, DataType::U16, DataType::U32];
            let indices = Some(accessor)
                .filter(|accessor| is_list(accessor, Dimensions::Scalar, &types))
                .and_then(|_| reader.read_indices());
            indices.ok_or_else(|| unreadable(primitive, "indices"))?.into_u32().collect()
        }
    };
    // The orders of the standard. Corners left over at the end are dropped, as it asks.
    let triangles = match primitive.mode() {
        Mode::Triangles => indices.as_chunks().0.to_vec(),
        Mode::TriangleStrip => (0..indices.len().saturating_sub(2))
            .map(|i| [i, i + 1 + i % 2, i + 2 - i % 2].map(|k| indices[k]))
            .collect(),
        Mode::TriangleFan => {
            (2..indices.len()).map(|i| [i - 1, i, 0].map(|k| indices[k])).collect()
        }
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => Vec::new(),
    };
    Ok(Mesh::new("primitive", vertices, triangles))
}

/// Whether an accessor is what `gltf` takes it for unchecked: a dense list of such numbers.
fn is_list(accessor: &Accessor, dimensions: Dimensions, types: &[DataType]) -> bool {
    let stride = accessor.view().map(|view| view.stride().unwrap_or(accessor.size()));
    accessor.dimensions() == dimensions
        && types.contains(&accessor.data_type())
        && accessor.count() > 0
        && accessor.sparse().is_none()
        && stride.is_some_and(|stride| stride >= accessor.size())
}

fn unreadable(primitive: &Primitive, what: &str) -> Cause {
    let index = primitive.index();
    Cause::Format(format!(
        "the {what} of primitive {index} are missing, sparse, out of bounds or of another type"
    ))
}
