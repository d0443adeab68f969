//! Mesh files, good and broken: what is loaded, and what the message says.

use std::fs;
use std::path::PathBuf;

use glamx::Vec3;
use sbbk_lab::mesh::{self, Mesh};
use tempfile::TempDir;

/// A folder for one test's files.
struct Files(TempDir);

impl Files {
    fn new() -> Self {
        Self(TempDir::new().unwrap())
    }

    fn write(&self, name: &str, contents: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.path().join(name);
        fs::write(&path, contents).unwrap();
        path
    }

    fn load(&self, name: &str, contents: impl AsRef<[u8]>) -> Mesh {
        mesh::load(&self.write(name, contents)).unwrap_or_else(|error| panic!("{error}"))
    }

    /// Panics unless loading fails with this at the start of the message, after the file's name.
    fn check_broken(&self, name: &str, contents: impl AsRef<[u8]>, problem: &str) {
        let path = self.write(name, contents);
        let message = mesh::load(&path).unwrap_err().to_string();
        let expected = format!("cannot load the mesh {}: {problem}", path.display());
        assert!(message.starts_with(&expected), "{message:?} should start with {expected:?}");
    }
}

fn unit_cube() -> Mesh {
    mesh::cuboid(Vec3::splat(0.5), 1).mapped(|v| v + 0.5)
}

fn assert_unit_cube(mesh: &Mesh, name: &str) {
    assert_eq!(mesh.name, name);
    assert_eq!((mesh.vertex_count(), mesh.triangle_count()), (8, 12), "{name}");
    assert_eq!(mesh.volume(), 1.0, "{name}");
}

/// A cube of quads in two objects, one face by relative indices, with all that is not geometry.
const CUBE_OBJ: &str = "\
# a cube
mtllib missing.mtl
o lower
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
vt 0 0
f 4/1 3/1 2/1 1/1
o upper
v 0 0 1
v 1 0 1 1.0
v 1 1 1
v 0 1 1
usemtl paint
s off
l 1 2 3
p 1
f -4 -3 -2 -1
f 1 2 6 5
f 2//1 3//1 7//1 6//1
f 3 4 8 7
f 4 1 5 8
";

fn text_stl(mesh: &Mesh, name: &str) -> String {
    let mut text = format!("solid{name}\n");
    for index in 0..mesh.triangle_count() {
        text += " facet normal 0 0 0\n  outer loop\n";
        for corner in mesh.corners(index) {
            text += &format!("   vertex {:?} {:?} {:?}\n", corner.x, corner.y, corner.z);
        }
        text += "  endloop\n endfacet\n";
    }
    text + &format!("endsolid{name}\n")
}

fn binary_stl(mesh: &Mesh, header: &[u8]) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, b' ');
    bytes.extend((mesh.triangle_count() as u32).to_le_bytes());
    for index in 0..mesh.triangle_count() {
        bytes.extend([0; 12]);
        for corner in mesh.corners(index) {
            bytes.extend(corner.to_array().map(f32::to_le_bytes).as_flattened());
        }
        bytes.extend([0; 2]);
    }
    bytes
}

/// Would catch lost objects and solids, unwelded seams, polylines taken for faces, wrong fans, and
/// binary files that begin with `solid` taken for text.
#[test]
fn obj_and_stl_files_are_loaded() {
    let files = Files::new();
    assert_unit_cube(&files.load("cube.obj", CUBE_OBJ), "cube");
    assert_unit_cube(&files.load("loud.OBJ", CUBE_OBJ.replace('\n', "\r\n")), "loud");
    let pentagon = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 3 0\nv 0 2 0\nf 1 2 3 4 5\nf 1 1 2\nf 1 2";
    let fan = files.load("pentagon.obj", pentagon);
    assert_eq!(fan.triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 0, 1]]);

    let cube = unit_cube();
    for name in ["", " part"] {
        assert_unit_cube(&files.load("text.stl", text_stl(&cube, name)), "text");
    }
    for header in [&b"made by hand"[..], b"solid, but binary"] {
        let bytes = [&binary_stl(&cube, header)[..], b"trailing"].concat();
        assert_unit_cube(&files.load("binary.stl", bytes), "binary");
    }
    let far = text_stl(&cube.clone().mapped(|v| v + 3.0), "");
    let two = files.load("two.stl", text_stl(&cube, " near") + &far);
    assert_eq!((two.triangle_count(), two.bounds().maxs), (24, Vec3::splat(4.0)));
}

/// Positions of a triangle in the plane `z = 0`, then its indices as `u16`.
fn triangle_bytes() -> Vec<u8> {
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let mut bytes = positions.map(|p| p.to_array().map(f32::to_le_bytes)).as_flattened().concat();
    bytes.extend([0, 0, 1, 0, 2, 0]);
    bytes
}

/// The same as a data URI in base 64.
const TRIANGLE_URI: &str = "data:application/octet-stream;base64,\
    AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA";

/// A document with the triangle as its mesh 0, placed by `nodes`; `buffer` is its first buffer.
fn gltf(nodes: &str, buffer: &str) -> String {
    format!(
        r#"{{
  "asset": {{ "version": "2.0" }}, "scene": 0, "scenes": [ {{ "nodes": [ 0 ] }} ],
  "nodes": [ {nodes} ],
  "meshes": [ {{ "primitives": [ {{ "attributes": {{ "POSITION": 0 }}, "indices": 1 }} ] }} ],
  "accessors": [
    {{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0] }},
    {{ "bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR" }} ],
  "bufferViews": [
    {{ "buffer": 0, "byteOffset": 0, "byteLength": 36 }},
    {{ "buffer": 0, "byteOffset": 36, "byteLength": 6 }} ],
  "buffers": [ {buffer} ]
}}"#
    )
}

const NODE: &str = r#"{ "mesh": 0 }"#;

fn uri_buffer(uri: &str) -> String {
    format!(r#"{{ "byteLength": 42, "uri": "{uri}" }}"#)
}

fn glb(document: &str, binary: &[u8]) -> Vec<u8> {
    let padded = |data: &[u8], kind: &[u8; 4], filler: u8| {
        let length = data.len().next_multiple_of(4);
        let mut chunk = [&(length as u32).to_le_bytes()[..], kind, data].concat();
        chunk.resize(8 + length, filler);
        chunk
    };
    let chunks = [padded(document.as_bytes(), b"JSON", b' '), padded(binary, b"BIN\0", 0)].concat();
    let length = (12 + chunks.len()) as u32;
    [&b"glTF"[..], &2u32.to_le_bytes(), &length.to_le_bytes(), &chunks].concat()
}

/// Would catch a home of buffers that is not looked at, transforms that are not applied, applied in
/// the wrong order or that turn mirrored parts inside out, and strips and fans read as lists.
#[test]
fn gltf_files_are_loaded() {
    let files = Files::new();
    files.write("the data.bin", triangle_bytes());
    let binary = gltf(NODE, r#"{ "byteLength": 42 }"#);
    for mesh in [
        files.load("uri.gltf", gltf(NODE, &uri_buffer(TRIANGLE_URI))),
        files.load("file.gltf", gltf(NODE, &uri_buffer("the%20data.bin"))),
        files.load("whole.glb", glb(&binary, &triangle_bytes())),
    ] {
        assert_eq!(mesh.vertices, [Vec3::ZERO, Vec3::X, Vec3::Y], "{}", mesh.name);
        assert_eq!(mesh.triangles, [[0, 1, 2]], "{}", mesh.name);
    }

    let nodes = r#"
        { "children": [ 1, 2 ], "translation": [10, 0, 0], "scale": [2, 2, 2] },
        { "mesh": 0, "translation": [0, 0, 1] },
        { "mesh": 0, "matrix": [-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,5,1] },
        { "mesh": 0, "name": "in no scene" }"#;
    let tree = files.load("tree.gltf", gltf(nodes, &uri_buffer(TRIANGLE_URI)));
    let place = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    let mirrored = [place(10.0, 0.0, 10.0), place(10.0, 2.0, 10.0), place(8.0, 0.0, 10.0)];
    let moved = [place(10.0, 0.0, 2.0), place(12.0, 0.0, 2.0), place(10.0, 2.0, 2.0)];
    assert_eq!([0, 1].map(|index| tree.corners(index)), [mirrored, moved]);
    assert_eq!(tree.triangle_count(), 2);

    // Four corners of a square, without indices.
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ONE];
    let bytes = positions.map(|p| p.to_array().map(f32::to_le_bytes)).as_flattened().concat();
    let modes: [(u8, &[[usize; 3]]); 3] =
        [(4, &[[0, 1, 2]]), (5, &[[0, 1, 2], [1, 3, 2]]), (6, &[[1, 2, 0], [2, 3, 0]])];
    for (mode, triangles) in modes {
        let document = gltf(NODE, r#"{ "byteLength": 48 }"#)
            .replace(r#", "indices": 1"#, &format!(r#", "mode": {mode}"#))
            .replace(r#""byteLength": 36"#, r#""byteLength": 48"#)
            .replace(r#"5126, "count": 3"#, r#"5126, "count": 4"#);
        let mesh = files.load("square.glb", glb(&document, &bytes));
        let loaded: Vec<[Vec3; 3]> = (0..mesh.triangle_count()).map(|i| mesh.corners(i)).collect();
        let expected: Vec<_> = triangles.iter().map(|t| t.map(|i| positions[i])).collect();
        assert_eq!(loaded, expected, "mode {mode}");
    }
}

/// Would catch messages that do not say which file is broken and why, panics, and silent nonsense.
#[test]
fn broken_files_are_named_with_the_cause() {
    let files = Files::new();
    let missing = mesh::load(&files.0.path().join("missing.obj")).unwrap_err().to_string();
    assert!(missing.contains("missing.obj: ") && missing.contains("os error"), "{missing}");
    files.check_broken("mesh.ply", "ply", "unknown file extension; known are obj, stl");
    files.check_broken("mesh", "v 0 0 0", "unknown file extension");

    let obj = |lines: &str| format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{lines}");
    for (lines, problem) in [
        ("f 1 2 9", "face vertex index out of bounds"),
        ("f 1 -4 2", "face vertex index out of bounds"),
        ("f 1 two 3", "face parse error"),
        ("v 1 2", "position parse error"),
        ("v nan 0 0\nf 1 2 4", "vertex 2 is not finite: [NaN, 0, 0]"),
        ("l 1 2 3", "it holds no triangles"),
    ] {
        files.check_broken("broken.obj", obj(lines), problem);
    }

    let text = text_stl(&unit_cube(), " cube");
    let binary = binary_stl(&unit_cube(), b"");
    let mut infinite = binary.clone();
    infinite[84 + 12 + 12..][..4].copy_from_slice(&f32::INFINITY.to_le_bytes());
    for (contents, problem) in [
        (text.replacen("vertex 0.0", "vertex zero", 1).into_bytes(), "invalid float literal"),
        (text.replacen("vertex 0.0", "vertex nan", 1).into_bytes(), "expected finite f32, got NaN"),
        (text.as_bytes()[..text.len() - 24].to_vec(), "expected [\"endfacet\"]"),
        (binary[..683].to_vec(), "failed to fill whole buffer"),
        (infinite, "vertex 1 is not finite: [inf, "),
        (b"solid x\nendsolid x\n".to_vec(), "it holds no triangles"),
    ] {
        files.check_broken("broken.stl", contents, problem);
    }

    let whole = gltf(NODE, &uri_buffer(TRIANGLE_URI));
    let indices = "the indices of primitive 0 are missing, sparse, out of bounds";
    let positions = "the positions of primitive 0 are missing, sparse, out of bounds";
    for (from, to, problem) in [
        (r#""asset""#, r#""asset"#, "expected `:` at line 2"),
        (r#""mesh": 0"#, r#""mesh": 7"#, "invalid glTF: nodes[0].mesh: Index out of bounds"),
        ("AAAAAAAAAAAAAAAA", "AAAA", positions),
        (TRIANGLE_URI, "gone.bin", "buffer 0: cannot read "),
        (r#", "uri""#, r#", "name""#, "buffer 0: there is no binary part"),
        ("base64,", "base64,*", "buffer 0: "),
        (r#"et": 36, "byteLength": 6"#, r#"et": 38, "byteLength": 6"#, indices),
        (r#""count": 3, "type": "VEC3""#, r#""count": 4, "type": "VEC3""#, positions),
        (r#""count": 3, "type": "SCALAR""#, r#""count": 0, "type": "SCALAR""#, indices),
        ("5123", "5126", indices),
        (r#""indices": 1"#, r#""indices": 0"#, indices),
        ("AAABAAIA", "AAABAAkA", "triangle 0 uses vertex 9, but there are 3 vertices"),
        ("AACAPw", "AACAfw", "vertex 1 is not finite: [inf, "),
        (NODE, r#"{ "mesh": 0, "children": [ 0 ] }"#, "a node is its own ancestor"),
        (r#""indices": 1"#, r#""indices": 1, "mode": 0"#, "it holds no triangles"),
    ] {
        assert!(whole.contains(from), "nothing to break: {from}");
        files.check_broken("broken.gltf", whole.replace(from, to), problem);
    }
    let whole = glb(&gltf(NODE, r#"{ "byteLength": 42 }"#), &triangle_bytes());
    for length in 0..whole.len() {
        files.check_broken("cut.glb", &whole[..length], "");
    }
}
