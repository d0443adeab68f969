//! The procedural meshes against geometry known by formula.

use std::collections::HashSet;
use std::f64::consts::PI;

use glamx::{Vec2, Vec3, Vec3Swizzles};
use rapier3d::parry::query::{Ray, RayCast};
use rapier3d::parry::shape::TriMeshFlags;
use rapier3d::parry::transformation::convex_hull;
use sbbk_testkit::mesh::{self, Gear, Mesh, Rack, Thread};

/// Counts the half-edges without one that runs the other way.
fn borders(mesh: &Mesh) -> usize {
    let edges = mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let edges: HashSet<[u32; 2]> = edges.collect();
    edges.iter().filter(|&&[a, b]| !edges.contains(&[b, a])).count()
}

/// Would catch open seams, faces turned inwards, and wrong scales.
#[test]
fn solids_are_closed_and_have_their_volumes() {
    let thread = Thread::BOLT;
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(Vec2::from_array);
    let ring = [[1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 0.0]].map(Vec2::from_array);
    let gear = Gear { teeth: 20, module: 0.1, thinned: 0.01, half_width: 0.2 };
    let bolt = 0.93 * 0.93 * 1.2 * PI;
    let rack = Rack { gear, teeth: 10, depth: 0.3 };
    let solids = [
        (mesh::ball(2.0, 24), 4.0 / 3.0 * PI * 8.0),
        (mesh::torus(2.0, 0.5, 60, 40), 2.0 * PI * PI * 2.0 * 0.25),
        (mesh::cuboid(Vec3::new(1.0, 2.0, 3.0), 7), 48.0),
        (mesh::uneven_box(Vec3::ONE, [4; 6]), 8.0),
        (mesh::tiles(4.0, 4, 0.5), 8.0),
        (mesh::prism(&corners, 0.5), 4.0),
        (mesh::revolved(&ring, 64), 3.0 * PI),
        // Teeth are thinner above the pitch circle than gaps are below it.
        (gear.mesh(), 0.96 * 0.4 * PI),
        (rack.mesh(), 0.4 * (0.3 * 9.84 * 0.1 * PI - 0.01)),
        (thread.bolt(), bolt),
        (thread.nut(1.2), 1.44 * 1.2 * PI - bolt),
    ];
    for (mesh, volume) in solids {
        assert_eq!(borders(&mesh), 0, "{}", mesh.name);
        assert!((mesh.volume() / volume - 1.0).abs() < 0.04, "{}: {}", mesh.name, mesh.volume());
    }
}

/// Would catch flaws that change the volume, or that are missing.
#[test]
fn flawed_meshes_have_their_volumes_and_flaws() {
    let walled = mesh::walled_box(Vec3::ONE, 2);
    let uneven = mesh::uneven_box(Vec3::ONE, [5, 4, 4, 1, 2, 3]);
    let skirted = mesh::skirted(&mesh::floor(2.0, 6), -1.0);
    assert!(borders(&uneven) > 20 && borders(&skirted) == 4 * 6 + 4);
    for (mesh, volume) in [(walled, 8.0), (uneven, 8.0), (skirted, 4.0)] {
        assert!((mesh.volume() - volume).abs() < 1e-4, "{}: {}", mesh.name, mesh.volume());
    }
    let strips = mesh::strips(8.0, 8, 1);
    let corners = (0..strips.triangle_count()).map(|index| strips.corners(index));
    let area: f32 = corners.map(|[a, b, c]| 0.5 * (b - a).cross(c - a).y).sum();
    assert!((area - 64.0).abs() < 1e-3 && borders(&strips) > 100);
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

/// Would catch lost features, filled eye sockets, and a head that differs from the head of all
/// results. A head without features is nearly its own convex hull. Up the face, the surface must
/// recede behind both cheek and brow.
#[test]
fn monkey_head_is_symmetric_concave_and_the_same_to_the_bit() {
    let head = mesh::monkey_head();
    let volume = head.volume();
    assert_eq!((head.triangle_count(), head.vertices.len()), (968, 486));
    assert!((head.bounds().extents().max_element() - 2.0).abs() < 1.0e-5);
    let (hull, faces) = convex_hull(&head.vertices);
    let hull_volume = Mesh::new("hull", hull, faces).volume();
    assert!(volume < 0.87 * hull_volume, "{volume} of {hull_volume}");

    let bits = |v: Vec3| (v + Vec3::ZERO).to_array().map(f32::to_bits);
    let points: HashSet<_> = head.vertices.iter().map(|&v| bits(v)).collect();
    let mirrored = |v: &Vec3| bits(v.with_x(-v.x));
    assert!(head.vertices.iter().all(|v| points.contains(&mirrored(v))));

    let shape = head.trimesh(TriMeshFlags::empty());
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
    assert_eq!((helicopter.triangle_count(), borders(&helicopter)), (2596, 0));
    let bounds = helicopter.bounds();
    assert!(bounds.mins.y.abs() < 1.0e-6 && (bounds.maxs.x - 2.4).abs() < 1.0e-5, "{bounds:?}");
    let flags = TriMeshFlags::CONNECTED_COMPONENTS | TriMeshFlags::HALF_EDGE_TOPOLOGY;
    let shape = helicopter.trimesh(flags);
    // Cabin, housing, mast; boom, fin, stabiliser, axle, two blades; two skids and four struts;
    // hub and four blades.
    assert_eq!(shape.connected_components().unwrap().num_connected_components(), 20);
}
