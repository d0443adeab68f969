//! Wavefront OBJ: `v` and `f` lines through `tobj`, and the line of what is wrong.

use glamx::Vec3;
use tobj::{LoadError, LoadOptions};

use super::MeshErrorCause;
use super::lines::LineReader;
use crate::mesh::Mesh;

/// Positions and triangles of all objects in the file.
pub(super) fn parse(bytes: &[u8]) -> Result<Mesh, MeshErrorCause> {
    let text = geometry_lines(&String::from_utf8_lossy(bytes));
    let options = LoadOptions { triangulate: true, ..LoadOptions::default() };
    let mut reader = LineReader::new(&text);
    let no_materials = |_: &std::path::Path| Err(LoadError::OpenFileFailed);
    let (models, _) =
        tobj::load_obj_buf(&mut reader, &options, no_materials).map_err(|error| match error {
            // Found only after the last line: look for the face again.
            LoadError::FaceVertexOutOfBounds | LoadError::InvalidPolygon => {
                first_broken_face(&text).unwrap_or_else(|| reader.error(0, error.to_string()))
            }
            _ => reader.error(0, error.to_string()),
        })?;
    let parts: Vec<Mesh> = models
        .into_iter()
        .map(|model| {
            let (positions, _) = model.mesh.positions.as_chunks::<3>();
            let (triangles, _) = model.mesh.indices.as_chunks::<3>();
            let vertices = positions.iter().copied().map(Vec3::from_array).collect();
            Mesh::new(model.name, vertices, triangles.to_vec())
        })
        .collect();
    Ok(Mesh::merged("obj", &parts))
}

/// The text with all lines but positions and faces emptied: polylines would be taken for faces,
/// and nothing else is needed. Colours after positions go too, as `tobj` wants all or none.
fn geometry_lines(text: &str) -> String {
    let mut kept = String::with_capacity(text.len());
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["v", x, y, z, _, _, _, ..] => kept.extend(["v ", x, " ", y, " ", z]),
            ["v" | "f", ..] => kept.push_str(line),
            _ => {}
        }
        kept.push('\n');
    }
    kept
}

fn keyword(line: &str) -> Option<&str> {
    line.split_whitespace().next()
}

/// The first face with an index that no vertex has, or with no corner at all.
fn first_broken_face(text: &str) -> Option<MeshErrorCause> {
    let vertex_count = text.lines().filter(|line| keyword(line) == Some("v")).count();
    let mut vertices_before = 0;
    for (index, line) in text.lines().enumerate() {
        match keyword(line) {
            Some("v") => vertices_before += 1,
            Some("f") => {
                if let Some(problem) = face_problem(line, vertices_before, vertex_count) {
                    return Some(MeshErrorCause::Line {
                        line: index + 1,
                        text: line.trim().to_owned(),
                        problem,
                    });
                }
            }
            _ => {}
        }
    }
    None
}

/// Indices count from one; negative ones back from the last vertex before the face.
fn face_problem(line: &str, vertices_before: i64, vertex_count: usize) -> Option<String> {
    let corners: Vec<&str> = line.split_whitespace().skip(1).collect();
    if corners.is_empty() {
        return Some("a face without corners".to_owned());
    }
    corners.iter().find_map(|corner| {
        let index: i64 = corner.split('/').next()?.parse().ok()?;
        let resolved = match index {
            ..0 => vertices_before + index,
            _ => index - 1,
        };
        let exists = (0..vertex_count as i64).contains(&resolved);
        (!exists)
            .then(|| format!("vertex {index} does not exist: there are {vertex_count} vertices"))
    })
}
