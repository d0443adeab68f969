//! Mesh files, good and broken: what is loaded, and what the message says.

use std::fs;
use std::path::PathBuf;

use glamx::Vec3;
use sbbk_lab::mesh::{self, Mesh, MeshErrorCause};
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

    /// The message without its start, which must name the file.
    fn problem(&self, name: &str, contents: impl AsRef<[u8]>) -> String {
        let path = self.write(name, contents);
        let message = mesh::load(&path).unwrap_err().to_string();
        let start = format!("cannot load the mesh {}: ", path.display());
        message
            .strip_prefix(&start)
            .unwrap_or_else(|| panic!("{message:?} does not name the file"))
            .to_owned()
    }
}

const CUBE_OBJ: &str = "\
# a cube of quads, one of them by relative indices, one split into two objects
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
v 1 1 1 0.5 0.5 0.5
v 0 1 1
usemtl paint
s off
l 1 2 3
f -4 -3 -2 -1
f 1 2 6 5
f 2//1 3//1 7//1 6//1
f 3 4 8 7
f 4 1 5 8
";

fn assert_unit_cube(mesh: &Mesh, name: &str) {
    assert_eq!(mesh.name, name);
    assert_eq!((mesh.vertex_count(), mesh.triangle_count()), (8, 12));
    assert_eq!(mesh.check_closed(), Ok(()));
    assert_eq!(mesh.volume(), 1.0);
}

fn unit_cube() -> Mesh {
    mesh::cuboid(Vec3::splat(0.5), 1).mapped(|v| v + 0.5)
}

/// Catches lost objects, unwelded seams between them, polylines taken for faces, and wrong fans.
#[test]
fn obj_of_several_objects_with_quads() {
    let files = Files::new();
    assert_unit_cube(&files.load("cube.obj", CUBE_OBJ), "cube");
    assert_unit_cube(&files.load("loud.OBJ", CUBE_OBJ.replace('\n', "\r\n")), "loud");
    let pentagon = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 3 0\nv 0 2 0\nf 1 2 3 4 5";
    let fan = files.load("pentagon.obj", pentagon);
    assert_eq!((fan.triangle_count(), fan.area()), (3, 5.0));
}

#[test]
fn broken_obj_names_the_line() {
    let files = Files::new();
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (lines, expected) in [
        (
            "# remark\n\nf 1 2 9\n",
            "line 6, `f 1 2 9`: vertex 9 does not exist: there are 3 vertices",
        ),
        (
            "f 1 2 3\no next\nf 1 -4 2",
            "line 6, `f 1 -4 2`: vertex -4 does not exist: there are 3 vertices",
        ),
        ("f 0 1 2\n", "line 4, `f 0 1 2`: vertex 0 does not exist: there are 3 vertices"),
        (
            "f 1/1/1 2/2/2 9/3/3",
            "line 4, `f 1/1/1 2/2/2 9/3/3`: vertex 9 does not exist: there are 3 vertices",
        ),
        ("f 1 two 3\n", "line 4, `f 1 two 3`: face parse error"),
        ("f\n", "line 4, `f`: a face without corners"),
        ("\nv 1 2\n", "line 5, `v 1 2`: position parse error"),
        ("vt 0\nv 1 2,5 3\nf 1 2 3", "line 5, `v 1 2,5 3`: position parse error"),
        ("v nan 0 0\nf 1 2 4\n", "vertex 2 is not finite: [NaN, 0.0, 0.0]"),
        ("v 0 -inf 0\nf 4 2 3\n", "vertex 0 is not finite: [0.0, -inf, 0.0]"),
        ("l 1 2 3\n", "it holds no triangles"),
    ] {
        assert_eq!(files.problem("broken.obj", format!("{triangle}{lines}")), expected);
    }
    assert_eq!(files.problem("empty.obj", ""), "it holds no triangles");
}

/// Degenerate faces are the user's affair: kept and counted.
#[test]
fn degenerate_faces_are_kept() {
    let text = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 4\nf 1 2 3\nf 1 1 2\nf 1 2\n";
    let mesh = Files::new().load("mixed.obj", text);
    assert_eq!((mesh.triangle_count(), mesh.degenerate_count()), (4, 3));
}

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

/// Catches unwelded corners, a solid without a name, binary files that begin with `solid`, and
/// trailing bytes, which some programs append.
#[test]
fn stl_text_and_binary() {
    let files = Files::new();
    let cube = unit_cube();
    for name in ["", " part"] {
        assert_unit_cube(&files.load("text.stl", text_stl(&cube, name)), "text");
    }
    for header in [&b"made by hand"[..], b"solid, but binary"] {
        let mut bytes = binary_stl(&cube, header);
        assert_unit_cube(&files.load("binary.stl", &bytes), "binary");
        bytes.extend(b"trailing");
        assert_unit_cube(&files.load("trailing.stl", &bytes), "trailing");
    }
}

/// Catches a reader that stops at the first `endsolid`.
#[test]
fn stl_text_of_several_solids() {
    let near = unit_cube();
    let far = unit_cube().mapped(|v| v + 3.0);
    let text = [text_stl(&near, " near"), text_stl(&far, "")].join("\n");
    let mesh = Files::new().load("two.stl", text);
    assert_eq!((mesh.triangle_count(), mesh.volume()), (24, 2.0));
    assert_eq!(mesh.bounds().maxs, Vec3::splat(4.0));
}

#[test]
fn broken_stl_names_the_line_or_the_length() {
    let files = Files::new();
    let text = text_stl(&unit_cube(), " cube");
    for (from, to, expected) in [
        ("vertex 0.0", "vertex zero", "invalid float literal"),
        ("vertex 0.0", "vertex nan", "expected finite f32, got NaN"),
        ("vertex 0.0", "vertex", "vertex f32 f32 f32, got"),
        ("outer loop", "outer circle", "expected [\"outer\", \"loop\"]"),
        ("facet normal", "face normal", "invalid facet header"),
    ] {
        // In the middle, so that the line is no constant.
        let line = text.lines().position(|line| line.contains(from));
        let line = line.expect("nothing to break") + 7;
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        lines[line] = lines[line].replace(from, to);
        let expected = format!("line {}, `{}`: {expected}", line + 1, lines[line].trim());
        let problem = files.problem("broken.stl", lines.join("\n"));
        assert!(problem.starts_with(&expected), "{problem:?} is not {expected:?}");
    }
    // The second solid counts its lines on from the first.
    let cut: String = text.lines().take(9).map(|line| format!("{line}\n")).collect();
    let problem = files.problem("cut.stl", format!("{text}{cut}"));
    let last = text.lines().count() + 9;
    assert!(problem.starts_with(&format!("line {last}, ")), "{problem}");
    assert!(problem.contains("EOF"), "{problem}");

    let binary = binary_stl(&unit_cube(), b"");
    assert_eq!(
        files.problem("cut.stl", &binary[..683]),
        "the binary STL file of 12 triangles is cut off: 684 bytes are declared, 683 are there"
    );
    assert_eq!(
        files.problem("short.stl", &binary[..40]),
        "the header of the binary STL file is cut off: 84 bytes are declared, 40 are there"
    );
    let mut infinite = binary;
    infinite[84 + 12 + 12..][..4].copy_from_slice(&f32::INFINITY.to_le_bytes());
    let problem = files.problem("infinite.stl", infinite);
    assert!(problem.starts_with("vertex 1 is not finite: [inf"), "{problem}");
    let nothing = Mesh::new("nothing", Vec::new(), Vec::new());
    assert_eq!(files.problem("none.stl", binary_stl(&nothing, b"")), "it holds no triangles");
    assert_eq!(files.problem("none.stl", "solid x\nendsolid x\n"), "it holds no triangles");
}

/// Positions of one triangle in the plane `z = 0`, area a half, then its indices as `u16`.
const TRIANGLE_BYTES: [u8; 42] = {
    let mut bytes = [0; 42];
    let one = 1.0f32.to_le_bytes();
    let mut i = 0;
    while i < 4 {
        bytes[12 + i] = one[i];
        bytes[28 + i] = one[i];
        i += 1;
    }
    bytes[38] = 1;
    bytes[40] = 2;
    bytes
};

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

/// Catches each of the three homes of a buffer.
#[test]
fn gltf_buffers_in_data_uris_files_and_glb() {
    let files = Files::new();
    files.write("the data.bin", TRIANGLE_BYTES);
    let node = r#"{ "mesh": 0 }"#;
    let meshes = [
        files.load("uri.gltf", gltf(node, &uri_buffer(TRIANGLE_URI))),
        files.load("file.gltf", gltf(node, &uri_buffer("the%20data.bin"))),
        files.load("whole.glb", glb(&gltf(node, r#"{ "byteLength": 42 }"#), &TRIANGLE_BYTES)),
    ];
    for mesh in &meshes {
        assert_eq!(mesh.vertices, [Vec3::ZERO, Vec3::X, Vec3::Y], "{}", mesh.name);
        assert_eq!(mesh.triangles, [[0, 1, 2]], "{}", mesh.name);
    }
}

/// Catches transforms that are not applied, applied in the wrong order, or that turn mirrored parts
/// inside out.
#[test]
fn gltf_nodes_place_their_meshes() {
    let nodes = r#"
        { "children": [ 1, 2 ], "translation": [10, 0, 0], "scale": [2, 2, 2] },
        { "mesh": 0, "translation": [0, 0, 1] },
        { "mesh": 0, "matrix": [-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,5,1] },
        { "mesh": 0, "name": "in no scene" }"#;
    let mesh = Files::new().load("tree.gltf", gltf(nodes, &uri_buffer(TRIANGLE_URI)));
    let corners: Vec<[Vec3; 3]> = (0..mesh.triangle_count()).map(|i| mesh.corners(i)).collect();
    let point = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    assert_eq!(
        corners,
        [
            [point(10.0, 0.0, 2.0), point(12.0, 0.0, 2.0), point(10.0, 2.0, 2.0)],
            [point(10.0, 0.0, 10.0), point(10.0, 2.0, 10.0), point(8.0, 0.0, 10.0)],
        ]
    );
}

/// Catches strips and fans read as lists, or with every other triangle turned round.
#[test]
fn gltf_strips_fans_and_lists_without_indices() {
    let files = Files::new();
    let square = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    let positions: Vec<u8> = square
        .iter()
        .flat_map(|&[x, y]: &[f32; 2]| [x, y, 0.0].map(f32::to_le_bytes))
        .flatten()
        .collect();
    for (mode, triangles) in
        [(4, vec![[0, 1, 2]]), (5, vec![[0, 1, 2], [1, 3, 2]]), (6, vec![[1, 2, 0], [2, 3, 0]])]
    {
        let document = gltf(r#"{ "mesh": 0 }"#, r#"{ "byteLength": 48 }"#)
            .replace(r#", "indices": 1"#, &format!(r#", "mode": {mode}"#))
            .replace(r#""byteLength": 36"#, r#""byteLength": 48"#)
            .replace(
                r#""componentType": 5126, "count": 3"#,
                r#""componentType": 5126, "count": 4"#,
            );
        let path = files.write("square.glb", glb(&document, &positions));
        let mesh = mesh::load(&path).unwrap_or_else(|error| panic!("{error}"));
        let corner = |i: usize| Vec3::new(square[i][0], square[i][1], 0.0);
        let expected: Vec<[Vec3; 3]> = triangles.iter().map(|t| t.map(corner)).collect();
        let loaded: Vec<[Vec3; 3]> = (0..mesh.triangle_count()).map(|i| mesh.corners(i)).collect();
        assert_eq!(loaded, expected, "mode {mode}");
    }
    let points = gltf(r#"{ "mesh": 0 }"#, &uri_buffer(TRIANGLE_URI))
        .replace(r#""indices": 1"#, r#""indices": 1, "mode": 0"#);
    assert_eq!(files.problem("points.gltf", points), "it holds no triangles");
}

/// Each would be a panic or a silent nonsense in the loader crate if it went unchecked.
#[test]
fn broken_gltf_names_the_cause() {
    let files = Files::new();
    let whole = gltf(r#"{ "mesh": 0 }"#, &uri_buffer(TRIANGLE_URI));
    for (from, to, expected) in [
        (r#""asset""#, r#""asset"#, "expected `:` at line 2"),
        (r#""mesh": 0"#, r#""mesh": 7"#, "invalid glTF: nodes[0].mesh: Index out of bounds"),
        ("AAAAAAAAAAAAAAAA", "AAAA", "buffer 0 is cut off: 42 bytes are declared, 24 are there"),
        (TRIANGLE_URI, "gone.bin", "cannot read "),
        (r#", "uri""#, r#", "name""#, "buffer 0: there is no binary part"),
        ("base64,", "base64,*", "buffer 0: "),
        (
            r#""byteOffset": 36, "byteLength": 6"#,
            r#""byteOffset": 38, "byteLength": 6"#,
            "mesh 0, primitive 0: accessor 1 asks for 3 items",
        ),
        (
            r#""count": 3, "type": "VEC3""#,
            r#""count": 4, "type": "VEC3""#,
            "mesh 0, primitive 0: accessor 0 asks for 4 items in 48 bytes of a view of 36",
        ),
        (
            r#""count": 3, "type": "SCALAR""#,
            r#""count": 0, "type": "SCALAR""#,
            "mesh 0, primitive 0: accessor 1 asks for 0 items",
        ),
        ("5123", "5126", "mesh 0, primitive 0: accessor 1 holds Scalar of F32"),
        (r#""indices": 1"#, r#""indices": 0"#, "mesh 0, primitive 0: accessor 0 holds Vec3 of F32"),
        ("AAABAAIA", "AAABAAkA", "triangle 0 uses vertex 9, but there are 3 vertices"),
        ("AACAPw", "AACAfw", "vertex 1 is not finite: [inf, 0.0, 0.0]"),
        (r#"{ "mesh": 0 }"#, r#"{ "mesh": 0, "children": [ 0 ] }"#, "the nodes are no tree"),
        (
            r#""asset""#,
            r#""extensionsRequired": [ "KHR_draco_mesh_compression" ], "asset""#,
            "invalid glTF: ",
        ),
    ] {
        assert!(whole.contains(from), "nothing to break: {from}");
        let problem = files.problem("broken.gltf", whole.replace(from, to));
        assert!(problem.starts_with(expected), "{problem:?} should start with {expected:?}");
    }
}

#[test]
fn broken_glb_names_the_length() {
    let files = Files::new();
    let whole = glb(&gltf(r#"{ "mesh": 0 }"#, r#"{ "byteLength": 42 }"#), &TRIANGLE_BYTES);
    let length = whole.len();
    assert_eq!(
        files.problem("cut.glb", &whole[..length - 1]),
        format!("the GLB file is cut off: {length} bytes are declared, {} are there", length - 1)
    );
    for cut in 0..length {
        let path = files.write("cut.glb", &whole[..cut]);
        assert!(mesh::load(&path).is_err(), "cut to {cut} bytes");
    }
    let mut tiny = whole;
    tiny[8..12].copy_from_slice(&3u32.to_le_bytes());
    assert_eq!(files.problem("tiny.glb", tiny), "the GLB header declares a length of 3 bytes");
}

#[test]
fn missing_files_and_unknown_extensions() {
    let files = Files::new();
    let missing = files.0.path().join("missing.obj");
    let error = mesh::load(&missing).unwrap_err();
    assert_eq!(error.path, missing);
    assert!(matches!(&error.cause, MeshErrorCause::Read { file, .. } if *file == missing));
    assert_eq!(
        files.problem("mesh.ply", "ply"),
        "unknown file extension `ply`; known are obj, stl, gltf and glb"
    );
    assert_eq!(
        files.problem("mesh", "v 0 0 0"),
        "unknown file extension ``; known are obj, stl, gltf and glb"
    );
}
