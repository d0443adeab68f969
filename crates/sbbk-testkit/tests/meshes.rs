//! The procedural meshes and the helpers of `Mesh`, against geometry known by formula.

use std::collections::HashSet;
use std::f64::consts::PI;

use glamx::{Pose3, Vec2, Vec3, Vec3Swizzles};
use rapier3d::parry::query::{Ray, RayCast};
use rapier3d::parry::shape::TriMeshFlags;
use rapier3d::parry::transformation::convex_hull;
use sbbk_testkit::mesh::{self, Mesh};

/// Panics if a mesh is open, inside out, not welded or has triangles without area; its volume.
fn solid_volume(mesh: &Mesh, triangle_count: usize) -> f64 {
    let name = &mesh.name;
    assert_eq!(mesh.triangle_count(), triangle_count, "{name}");
    // Fails where neighbours disagree about which side is out.
    let shape = mesh.trimesh(TriMeshFlags::HALF_EDGE_TOPOLOGY).expect(name);
    let half_edges = &shape.topology().unwrap().half_edges;
    assert!(half_edges.iter().all(|edge| edge.twin != u32::MAX), "{name} is open");
    assert!(shape.triangles().all(|triangle| triangle.area() > 0.0), "{name}");
    assert!(mesh.volume() > 0.0, "{name} is inside out");
    mesh.volume()
}

/// Would catch open seams, faces turned inwards and wrong scales, also at the least resolutions
/// and those below.
#[test]
fn solids_are_closed_and_have_their_volumes() {
    let cases = [
        (mesh::ball(2.0, 24), 8 * 24 * 24, 4.0 / 3.0 * PI * 8.0),
        (mesh::torus(2.0, 0.5, 60, 40), 2 * 60 * 40, 2.0 * PI * PI * 2.0 * 0.25),
        (mesh::cuboid(Vec3::new(1.0, 2.0, 3.0), 7), 12 * 49, 48.0),
    ];
    for (mesh, triangle_count, volume) in cases {
        let ratio = solid_volume(&mesh, triangle_count) / volume;
        assert!((ratio - 1.0).abs() < 0.01, "{}: {ratio}", mesh.name);
        assert_eq!(mesh.welded(), mesh);
    }
    for detail in [0, 1] {
        solid_volume(&mesh::ball(1.0, detail), 8);
        solid_volume(&mesh::cuboid(Vec3::ONE, detail), 12);
        solid_volume(&mesh::torus(1.0, 0.2, detail, detail), 18);
        assert_eq!(mesh::floor(1.0, detail).triangle_count(), 2);
    }
    for detail in 2..6 {
        solid_volume(&mesh::monkey_head_with(detail), 8 * (detail * detail) as usize);
    }
}

/// Would catch sheets that face down or miss their size.
#[test]
fn sheets_face_up_and_have_their_size() {
    for (sheet, height) in [(mesh::floor(6.0, 5), 0.0), (mesh::terrain(6.0, 40, 0.3), 0.3)] {
        let bounds = sheet.bounds();
        assert_eq!(bounds.extents().xz(), Vec2::splat(6.0));
        assert!(bounds.maxs.y <= height && -bounds.mins.y <= height);
        assert!(bounds.extents().y >= height);
        for index in 0..sheet.triangle_count() {
            let [a, b, c] = sheet.corners(index);
            assert!((b - a).cross(c - a).y > 0.0, "{} {index}", sheet.name);
        }
    }
}

/// Would catch features that got lost (a head without them is nearly its own convex hull), eye
/// sockets that are not hollow (going up the face, the surface must recede behind both cheek and
/// brow), and a head that is not the one that all results are about.
#[test]
fn monkey_head_is_symmetric_concave_and_the_same_to_the_bit() {
    let head = mesh::monkey_head();
    let volume = solid_volume(&head, 968);
    assert_eq!(head.vertices.len(), 486);
    assert!((head.bounds().extents().max_element() - 2.0).abs() < 1.0e-5);
    let (hull, faces) = convex_hull(&head.vertices);
    let hull_volume = Mesh::new("hull", hull, faces).volume();
    assert!(volume < 0.87 * hull_volume, "{volume} of {hull_volume}");

    let bits = |v: Vec3| (v + Vec3::ZERO).to_array().map(f32::to_bits);
    let points: HashSet<_> = head.vertices.iter().map(|&v| bits(v)).collect();
    let mirrored = |v: &Vec3| bits(v.with_x(-v.x));
    assert!(head.vertices.iter().all(|v| points.contains(&mirrored(v))));

    let shape = head.trimesh(TriMeshFlags::empty()).unwrap();
    let surface = |y: f32| {
        let ray = Ray::new(Vec3::new(0.22, y, 2.0), Vec3::NEG_Z);
        shape.cast_local_ray(&ray, 2.0, true).map(|distance| 2.0 - distance)
    };
    let face: Vec<f32> = (-60..60).filter_map(|i| surface(0.01 * i as f32)).collect();
    let highest = |part: &[f32]| part.iter().copied().fold(f32::MIN, f32::max);
    let hollow = |i: usize| highest(&face[..i]).min(highest(&face[i + 1..])) - face[i];
    let deepest = (1..face.len() - 1).map(hollow).fold(f32::MIN, f32::max);
    assert!(deepest > 0.1, "{deepest}");

    // FNV-1a over the bits of all coordinates and indices.
    let coordinates = head.vertices.iter().flat_map(|v| v.to_array()).map(f32::to_bits);
    let words = coordinates.chain(head.triangles.iter().flatten().copied());
    let hash = words.fold(0xcbf2_9ce4_8422_2325_u64, |hash, word| {
        (hash ^ u64::from(word)).wrapping_mul(0x0000_0100_0000_01b3)
    });
    assert_eq!(hash, 0x35cd_4ca5_c4c9_3fc1, "{hash:#x}");
}

/// Would catch parts that are open, and ones that are left out.
#[test]
fn helicopter_stands_on_its_skids() {
    let helicopter = mesh::helicopter();
    solid_volume(&helicopter, 2596);
    let bounds = helicopter.bounds();
    assert!(bounds.mins.y.abs() < 1.0e-6 && (bounds.maxs.x - 2.4).abs() < 1.0e-5, "{bounds:?}");
    let flags = TriMeshFlags::CONNECTED_COMPONENTS | TriMeshFlags::HALF_EDGE_TOPOLOGY;
    let shape = helicopter.trimesh(flags).unwrap();
    // Cabin, housing, mast; boom, fin, stabiliser, axle, two blades; two skids and four struts;
    // hub and four blades.
    assert_eq!(shape.connected_components().unwrap().num_connected_components(), 20);
}

/// "Positions are equal when all coordinates are (`-0` is `0`)"
#[test]
fn welding_joins_equal_positions_and_nothing_else() {
    let next = 1f32.next_up();
    let vertices = vec![
        Vec3::splat(9.0),
        Vec3::ZERO,
        Vec3::new(-0.0, 0.0, -0.0),
        Vec3::X,
        Vec3::new(next, 0.0, 0.0),
    ];
    let welded = Mesh::new("sheet", vertices, vec![[3, 1, 4], [2, 3, 1]]).welded();
    assert_eq!(welded.triangles, [[0, 1, 2], [1, 0, 1]]);
    assert_eq!(welded.vertices, [Vec3::X, Vec3::ZERO, Vec3::new(next, 0.0, 0.0)]);
}

/// Would catch scaling by the wrong side, a division by zero for a mesh without extent, and a shape
/// that is not what stock Rapier would have built.
#[test]
fn meshes_are_scaled_centred_posed_and_made_shapes() {
    let slab = mesh::cuboid(Vec3::new(1.0, 4.0, 2.0), 1).mapped(|v| v + Vec3::new(5.0, 6.0, 7.0));
    let fitted = slab.centred().scaled_to(2.0);
    assert_eq!(fitted.bounds().mins, Vec3::new(-0.25, -1.0, -0.5));
    assert_eq!(fitted.bounds().maxs, Vec3::new(0.25, 1.0, 0.5));
    let moved = fitted.posed(&Pose3::from_translation(Vec3::X));
    assert_eq!(moved.bounds().center(), Vec3::X);
    let shape = moved.shape();
    let trimesh = shape.as_trimesh().unwrap();
    assert_eq!((trimesh.vertices(), trimesh.indices()), (&*moved.vertices, &*moved.triangles));
    assert_eq!(trimesh.flags(), TriMeshFlags::empty());

    let point = Mesh::new("point", vec![Vec3::ONE; 3], vec![[0, 1, 2]]);
    assert_eq!(point.clone().scaled_to(2.0), point);
    let empty = Mesh::new("empty", Vec::new(), Vec::new());
    assert_eq!(empty.clone().centred().scaled_to(2.0), empty);
    assert!(empty.trimesh(TriMeshFlags::empty()).is_err());
}

/// Would catch parts of machines with holes, inside out, or of the wrong size.
#[test]
fn parts_of_machines_are_closed_and_have_their_volume() {
    use sbbk_testkit::mesh::{Gear, Rack, Thread, prism, revolved};

    let thread = Thread::BOLT;
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(Vec2::from_array);
    let ring = [[1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 0.0]].map(Vec2::from_array);
    let gear = Gear { teeth: 20, module: 0.1, thinned: 0.01, half_width: 0.2 };
    let bolt = 0.93 * 0.93 * 1.2 * PI;
    let rack = Rack { gear, teeth: 10, depth: 0.3 };
    let parts: [(Mesh, f64); 6] = [
        (prism(&corners, 0.5), 4.0),
        (revolved(&ring, 64), 3.0 * PI),
        // Teeth are thinner above the pitch circle than gaps are below it.
        (gear.mesh(), 0.96 * 0.4 * PI),
        (rack.mesh(), 0.4 * (0.3 * 9.84 * 0.1 * PI - 0.01)),
        (thread.bolt(), bolt),
        (thread.nut(1.2), 1.44 * 1.2 * PI - bolt),
    ];
    for (mesh, volume) in parts {
        let edges = mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let edges: HashSet<[u32; 2]> = edges.collect();
        assert!(edges.iter().all(|&[a, b]| edges.contains(&[b, a])), "{}", mesh.name);
        assert_eq!(edges.len(), 3 * mesh.triangle_count(), "{}", mesh.name);
        assert!((mesh.volume() / volume - 1.0).abs() < 0.04, "{}: {}", mesh.name, mesh.volume());
    }
}
