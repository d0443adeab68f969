//! glTF 2.0, as JSON or GLB, through `gltf`: the scene's meshes, placed by their nodes.

use std::path::Path;

use glamx::Mat4;
use gltf::{Document, Gltf, Node};

use super::gltf_buffers::Buffers;
use super::{MeshErrorCause, file};
use crate::mesh::Mesh;

/// Bytes of a GLB file before its first chunk; the last four are the length of the file.
const GLB_HEADER: usize = 12;

/// The triangles of the default scene, else of the first, else of all nodes, in its frame. Files
/// that the document names are looked up in `folder`.
pub(super) fn parse(bytes: &[u8], folder: &Path) -> Result<Mesh, MeshErrorCause> {
    check_glb_length(bytes)?;
    let gltf =
        Gltf::from_slice(bytes).map_err(|error| MeshErrorCause::Format(error.to_string()))?;
    let buffers = Buffers::load(&gltf, folder)?;
    let mut parts = Vec::new();
    for (node, transform) in placed_nodes(&gltf)? {
        let Some(mesh) = node.mesh() else { continue };
        for primitive in mesh.primitives() {
            let part = buffers.primitive(&primitive).map_err(|problem| {
                let place = format!("mesh {}, primitive {}", mesh.index(), primitive.index());
                MeshErrorCause::Format(format!("{place}: {problem}"))
            })?;
            // Before parts and transforms mix what is wrong with one into others.
            file::check_geometry(&part)?;
            parts.push(placed(part, transform));
        }
    }
    Ok(Mesh::merged("gltf", &parts))
}

/// `gltf` subtracts the header from the declared length before it has looked at either.
fn check_glb_length(bytes: &[u8]) -> Result<(), MeshErrorCause> {
    let header = match bytes.first_chunk::<GLB_HEADER>() {
        Some(header) if header.starts_with(b"glTF") => header,
        _ => return Ok(()),
    };
    let [.., a, b, c, d] = *header;
    let declared = u64::from(u32::from_le_bytes([a, b, c, d]));
    let present = bytes.len() as u64;
    if declared < GLB_HEADER as u64 {
        let problem = format!("the GLB header declares a length of {declared} bytes");
        return Err(MeshErrorCause::Format(problem));
    }
    MeshErrorCause::check_length("the GLB file", declared, present)
}

fn roots(document: &Document) -> Vec<Node<'_>> {
    match document.default_scene().or(document.scenes().next()) {
        Some(scene) => scene.nodes().collect(),
        None => {
            let children: Vec<usize> = document
                .nodes()
                .flat_map(|node| node.children().map(|child| child.index()))
                .collect();
            let is_root = |node: &Node| !children.contains(&node.index());
            document.nodes().filter(is_root).collect()
        }
    }
}

/// All nodes below the roots, parents first, each with the transform to the scene's frame.
fn placed_nodes(document: &Document) -> Result<Vec<(Node<'_>, Mat4)>, MeshErrorCause> {
    let local = |node: &Node| Mat4::from_cols_array_2d(&node.transform().matrix());
    let node_count = document.nodes().count();
    let mut placed: Vec<(Node, Mat4)> = Vec::with_capacity(node_count);
    placed.extend(roots(document).into_iter().map(|node| {
        let transform = local(&node);
        (node, transform)
    }));
    let mut next = 0;
    while let Some((node, transform)) = placed.get(next).cloned() {
        let children = node.children().map(|child| {
            let transform = transform * local(&child);
            (child, transform)
        });
        placed.extend(children);
        next += 1;
        if placed.len() > node_count {
            let problem = "the nodes are no tree: one is its own ancestor or has two parents";
            return Err(MeshErrorCause::Format(problem.to_owned()));
        }
    }
    Ok(placed)
}

/// The mesh in the scene's frame, facing outwards again if the transform mirrors it.
fn placed(mesh: Mesh, transform: Mat4) -> Mesh {
    let placed = mesh.mapped(|point| transform.transform_point3(point));
    match transform.determinant() < 0.0 {
        true => placed.flipped(),
        false => placed,
    }
}
