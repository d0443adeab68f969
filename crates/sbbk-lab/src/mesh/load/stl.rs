//! STL, text and binary, through `stl_io`.

use std::io;

use glamx::Vec3;
use stl_io::Triangle;

use super::MeshErrorCause;
use super::lines::LineReader;
use crate::mesh::Mesh;

/// Bytes of a binary file before the triangles: a free header and the number of triangles.
const HEADER: usize = 80;
const PREAMBLE: usize = HEADER + 4;

/// Bytes of a binary triangle.
const RECORD: u64 = 50;

/// The triangles of all solids in the file, three vertices each.
pub(super) fn parse(bytes: &[u8]) -> Result<Mesh, MeshErrorCause> {
    let triangles = if is_text(bytes) {
        parse_text(&String::from_utf8_lossy(bytes))?
    } else {
        parse_binary(bytes)?
    };
    let corners = triangles.iter().flat_map(|triangle| triangle.vertices);
    let vertices: Vec<Vec3> = corners.map(|corner| Vec3::from_array(corner.0)).collect();
    let count = triangles.len() as u32;
    let triangles = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Ok(Mesh::new("stl", vertices, triangles))
}

/// Binary headers may begin with `solid` too, but then a zero byte follows soon: the highest of
/// the number of triangles, if no other.
fn is_text(bytes: &[u8]) -> bool {
    let start = &bytes[..bytes.len().min(PREAMBLE)];
    start.starts_with(b"solid") && !start.contains(&0)
}

fn parse_binary(bytes: &[u8]) -> Result<Vec<Triangle>, MeshErrorCause> {
    let present = bytes.len() as u64;
    MeshErrorCause::check_length("the header of the binary STL file", PREAMBLE as u64, present)?;
    let count = bytes[HEADER..].first_chunk().copied().map_or(0, u32::from_le_bytes);
    let what = format!("the binary STL file of {count} triangles");
    let declared = PREAMBLE as u64 + RECORD * u64::from(count);
    MeshErrorCause::check_length(&what, declared, present)?;
    // The header means nothing, but `stl_io` would take one with `solid` for text.
    let headless = [&[0; HEADER], &bytes[HEADER..]].concat();
    stl_io::create_stl_reader(&mut io::Cursor::new(headless))
        .and_then(Iterator::collect)
        .map_err(|error| MeshErrorCause::Format(error.to_string()))
}

fn parse_text(text: &str) -> Result<Vec<Triangle>, MeshErrorCause> {
    let mut triangles = Vec::new();
    for Solid { lines_before, text } in solids(text) {
        let mut reader = LineReader::new(&text);
        let read: io::Result<Vec<Triangle>> =
            stl_io::create_stl_reader(&mut reader).and_then(Iterator::collect);
        triangles.extend(read.map_err(|error| reader.error(lines_before, error.to_string()))?);
    }
    Ok(triangles)
}

/// One solid of a text file, of which `stl_io` reads the first only.
struct Solid {
    /// Lines of the file before the solid.
    lines_before: usize,
    text: String,
}

/// The text cut after each `endsolid` line. The lines that open the solids are all put down as
/// `solid `: `stl_io` wants the space also where no name follows.
fn solids(text: &str) -> Vec<Solid> {
    let mut solids: Vec<Solid> = Vec::new();
    let mut open = false;
    for (index, line) in text.lines().enumerate() {
        let keyword = line.split_whitespace().next();
        if open {
            let solid = solids.last_mut().expect("a solid is open");
            solid.text.push_str(line);
            solid.text.push('\n');
            open = keyword != Some("endsolid");
        } else if keyword == Some("solid") {
            let text = "solid \n".to_owned();
            solids.push(Solid { lines_before: index, text });
            open = true;
        }
    }
    solids
}
