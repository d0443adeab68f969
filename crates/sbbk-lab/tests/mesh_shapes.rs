//! The procedural meshes and the helpers of `Mesh`, against geometry known by formula.

use std::collections::HashSet;
use std::f64::consts::PI;

use glamx::{DVec3, Pose3, Vec3, Vec3Swizzles};
use rapier3d::parry::query::{Ray, RayCast};
use rapier3d::parry::shape::TriMeshFlags;
use rapier3d::parry::transformation::convex_hull;
use sbbk_lab::mesh::{self, Mesh, OpenEdgeKind};

fn tetrahedron() -> Mesh {
    let vertices = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    let triangles = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    Mesh::new("tetrahedron", vertices, triangles)
}

/// Asserts what every closed shape promises; returns the volume for comparison with a formula.
fn assert_solid(mesh: &Mesh, triangle_count: usize) -> f64 {
    let name = &mesh.name;
    assert_eq!(mesh.triangle_count(), triangle_count, "{name}");
    assert_eq!(mesh.check_closed(), Ok(()), "{name}");
    assert_eq!(mesh.degenerate_count(), 0, "{name}");
    assert_eq!(mesh.welded(), *mesh, "{name} has equal or unused vertices");
    assert!(mesh.vertices.iter().all(|v| v.is_finite()), "{name}");
    assert!(mesh.volume() > 0.0, "{name} is inside out");
    mesh.volume()
}

fn assert_near(value: f64, expected: f64, tolerance: f64) {
    let error = (value - expected).abs() / expected;
    assert!(error < tolerance, "{value} should be {expected}");
}

/// Catches open seams, faces turned inwards and wrong scales.
#[test]
fn simple_solids_are_closed_and_have_their_volumes() {
    let ball = assert_solid(&mesh::ball(2.0, 24), 8 * 24 * 24);
    assert_near(ball, 4.0 / 3.0 * PI * 8.0, 0.01);
    let torus = assert_solid(&mesh::torus(2.0, 0.5, 60, 40), 2 * 60 * 40);
    assert_near(torus, 2.0 * PI * PI * 2.0 * 0.25, 0.01);
    let cuboid = assert_solid(&mesh::cuboid(Vec3::new(1.0, 2.0, 3.0), 7), 12 * 49);
    assert_near(cuboid, 48.0, 1.0e-6);
}

/// The smallest parameters, and those below them, still give solids.
#[test]
fn least_resolutions_are_solids() {
    for detail in [0, 1] {
        assert_solid(&mesh::ball(1.0, detail), 8);
        assert_solid(&mesh::cuboid(Vec3::ONE, detail), 12);
        assert_solid(&mesh::torus(1.0, 0.2, detail, detail), 18);
        assert_eq!(mesh::floor(1.0, detail).triangle_count(), 2);
    }
    for detail in 2..6 {
        assert_solid(&mesh::monkey_head_with(detail), 8 * (detail * detail) as usize);
    }
}

/// Catches sheets that face down, miss their size, or are no grid.
#[test]
fn sheets_face_up_and_have_their_size() {
    let floor = mesh::floor(6.0, 5);
    assert_eq!(floor.triangle_count(), 50);
    assert_near(floor.area(), 36.0, 1.0e-6);
    let terrain = mesh::terrain(6.0, 40, 0.3);
    let heights = terrain.bounds();
    assert!(heights.maxs.y <= 0.3 && heights.mins.y >= -0.3 && heights.extents().y > 0.3);
    for sheet in [floor, terrain] {
        assert_eq!(sheet.bounds().extents().xz(), glamx::Vec2::splat(6.0));
        for index in 0..sheet.triangle_count() {
            let [a, b, c] = sheet.corners(index);
            assert!((b - a).cross(c - a).y > 0.0, "{} {index}", sheet.name);
        }
        assert_eq!(sheet.check_closed().unwrap_err().kind, OpenEdgeKind::Rim);
    }
}

/// Catches features that got lost: a head without them is nearly its own convex hull.
#[test]
fn monkey_head_is_symmetric_and_concave() {
    let head = mesh::monkey_head();
    let volume = assert_solid(&head, 968);
    assert_eq!(head.vertex_count(), 486);
    let bounds = head.bounds();
    assert!((bounds.extents().max_element() - 2.0).abs() < 1.0e-5);
    assert!(bounds.center().length() < 1.0e-6);
    let (hull, faces) = convex_hull(&head.vertices);
    let hull_volume = Mesh::new("hull", hull, faces).volume();
    assert!(volume < 0.87 * hull_volume, "{volume} of {hull_volume}");

    let bits = |v: &Vec3| (*v + Vec3::ZERO).to_array().map(f32::to_bits);
    let points: HashSet<_> = head.vertices.iter().map(bits).collect();
    for vertex in &head.vertices {
        let mirrored = Vec3::new(-vertex.x, vertex.y, vertex.z);
        assert!(points.contains(&bits(&mirrored)), "{vertex} has no mirror image");
    }
}

/// Going up the face through an eye, the surface must recede behind both cheek and brow: the
/// sockets are hollow, and a ball can rest in them.
#[test]
fn monkey_head_has_hollow_eye_sockets() {
    let head = mesh::monkey_head();
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
}

/// Catches ears and sockets so deep that the surface runs through itself.
#[test]
fn monkey_head_does_not_cross_itself() {
    for detail in [6, 8, 11, 16] {
        let head = mesh::monkey_head_with(detail);
        assert_eq!(self_crossing(&head), None, "detail {detail}");
    }
    let balls = [0.0, 0.9].map(|x| mesh::ball(1.0, 4).mapped(|v| v + Vec3::X * x));
    assert!(self_crossing(&Mesh::merged("balls", &balls)).is_some());
}

/// An edge and a triangle without common vertices that cross, if there are.
fn self_crossing(mesh: &Mesh) -> Option<([u32; 2], usize)> {
    let point = |i: u32| mesh.vertices[i as usize].as_dvec3();
    let edges: HashSet<[u32; 2]> = mesh
        .triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
        .filter(|[from, to]| from < to)
        .collect();
    (0..mesh.triangle_count()).find_map(|index| {
        let triangle = mesh.triangles[index];
        let corners = triangle.map(point);
        let crosses = |edge: &&[u32; 2]| {
            edge.iter().all(|i| !triangle.contains(i)) && cross(edge.map(point), corners)
        };
        edges.iter().find(crosses).map(|&edge| (edge, index))
    })
}

fn cross([from, to]: [DVec3; 2], corners: [DVec3; 3]) -> bool {
    let [a, b, c] = corners;
    let normal = (b - a).cross(c - a);
    let [d0, d1] = [from, to].map(|p| (p - a).dot(normal));
    let hit = from + (to - from) * (d0 / (d0 - d1));
    let inside = |p: DVec3, q: DVec3| (q - p).cross(hit - p).dot(normal) > 0.0;
    d0 * d1 < 0.0 && inside(a, b) && inside(b, c) && inside(c, a)
}

/// Catches parts that are open, inside out, missing from the whole, or a rotor out of place.
#[test]
fn helicopter_stands_on_its_skids_below_a_free_rotor() {
    let whole = mesh::helicopter();
    let parts = mesh::helicopter_parts();
    let count = whole.triangle_count();
    assert!((1500..3000).contains(&count), "{count}");
    assert_eq!(count, parts.body.triangle_count() + parts.rotor.triangle_count());
    for part in [&whole, &parts.body, &parts.rotor] {
        assert_eq!(part.check_closed(), Ok(()), "{}", part.name);
        assert_eq!(part.degenerate_count(), 0, "{}", part.name);
        assert!(component_volumes(part).iter().all(|&volume| volume > 0.0), "{}", part.name);
    }
    // Cabin, housing, mast; boom, fin, stabiliser, axle, two blades; two skids and four struts.
    assert_eq!(component_volumes(&parts.body).len(), 15);
    assert_eq!(component_volumes(&parts.rotor).len(), 5);
    assert!(whole.bounds().mins.y.abs() < 1.0e-6);

    let rotor = parts.rotor.bounds();
    assert!((rotor.maxs.x - mesh::ROTOR_RADIUS).abs() < 1.0e-5);
    assert!((rotor.center() - Vec3::Y * mesh::ROTOR_HEIGHT).length() < 1.0e-3);
    let blocks = |v: &&Vec3| {
        let distance = v.xz().length();
        v.y > rotor.mins.y - 0.05 && (0.1..mesh::ROTOR_RADIUS + 0.05).contains(&distance)
    };
    assert_eq!(parts.body.vertices.iter().find(blocks), None);
}

/// Volumes of the parts that share no vertex.
fn component_volumes(mesh: &Mesh) -> Vec<f64> {
    let mut left = mesh.triangles.clone();
    let mut volumes = Vec::new();
    while let Some(seed) = left.pop() {
        let mut vertices = HashSet::from(seed);
        let mut part = vec![seed];
        while let Some(index) = left.iter().position(|t| t.iter().any(|i| vertices.contains(i))) {
            let triangle = left.swap_remove(index);
            vertices.extend(triangle);
            part.push(triangle);
        }
        volumes.push(Mesh::new("part", mesh.vertices.clone(), part).volume());
    }
    volumes
}

/// Each way to break a closed surface is told apart, so that `Ok` means something.
#[test]
fn broken_surfaces_are_found() {
    let whole = tetrahedron();
    assert_eq!(whole.check_closed(), Ok(()));
    let broken = |edit: fn(&mut Vec<[u32; 3]>)| {
        let mut mesh = tetrahedron();
        edit(&mut mesh.triangles);
        mesh.check_closed().unwrap_err().kind
    };
    assert_eq!(broken(|t| t.truncate(3)), OpenEdgeKind::Rim);
    assert_eq!(broken(|t| t[1].swap(0, 1)), OpenEdgeKind::Repeated);
    assert_eq!(broken(|t| t.push(t[0])), OpenEdgeKind::Repeated);
    assert_eq!(broken(|t| t.push([0, 0, 0])), OpenEdgeKind::Repeated);
    assert_eq!(whole.volume(), 1.0 / 6.0);
    assert_eq!(whole.flipped().volume(), -1.0 / 6.0);
}

/// "Positions are equal when all coordinates are (`-0` is `0`): nothing moves".
#[test]
fn welding_joins_equal_positions_and_nothing_else() {
    let next = f32::from_bits(1.0f32.to_bits() + 1);
    let vertices = vec![
        Vec3::new(9.0, 9.0, 9.0),
        Vec3::new(0.0, 0.0, 0.0),
        Vec3::new(-0.0, 0.0, -0.0),
        Vec3::new(1.0, 0.0, 0.0),
        Vec3::new(next, 0.0, 0.0),
    ];
    let welded = Mesh::new("sheet", vertices, vec![[3, 1, 4], [2, 3, 1]]).welded();
    assert_eq!(welded.triangles, [[0, 1, 2], [1, 0, 1]]);
    assert_eq!(welded.vertices, [Vec3::X, Vec3::ZERO, Vec3::new(next, 0.0, 0.0)]);
}

/// Catches an area test with an absolute tolerance: tiny triangles are no degenerate ones.
#[test]
fn degenerate_triangles_are_counted_at_every_scale() {
    for scale in [1.0e-15, 1.0, 1.0e15] {
        let vertices = [Vec3::ZERO, Vec3::X, Vec3::X * 2.0, Vec3::Y];
        let triangles = vec![[0, 1, 2], [0, 1, 1], [3, 3, 3], [0, 1, 3]];
        let mesh = Mesh::new("mixed", vertices.map(|v| v * scale).to_vec(), triangles);
        assert_eq!(mesh.degenerate_count(), 3, "scale {scale}");
    }
}

/// Catches scaling by the wrong side, and a division by zero for a mesh without extent.
#[test]
fn scaling_centring_and_posing() {
    let slab = mesh::cuboid(Vec3::new(1.0, 4.0, 2.0), 1).mapped(|v| v + Vec3::new(5.0, 6.0, 7.0));
    let fitted = slab.centred().scaled_to(2.0);
    assert_eq!(fitted.bounds().mins, Vec3::new(-0.25, -1.0, -0.5));
    assert_eq!(fitted.bounds().maxs, Vec3::new(0.25, 1.0, 0.5));
    let moved = fitted.posed(&Pose3::from_translation(Vec3::X));
    assert_eq!(moved.bounds().center(), Vec3::X);

    let point = Mesh::new("point", vec![Vec3::ONE; 3], vec![[0, 1, 2]]);
    assert_eq!(point.clone().scaled_to(2.0), point);
    let empty = Mesh::new("empty", Vec::new(), Vec::new());
    assert_eq!(empty.clone().centred().scaled_to(2.0), empty);
}

/// Catches parts that keep their own indices after merging.
#[test]
fn merged_parts_stay_apart() {
    let [near, far] = [0.0, 5.0].map(|x| tetrahedron().mapped(|v| v + Vec3::X * x));
    let both = Mesh::merged("both", [&near, &far]);
    assert_eq!(both.check_closed(), Ok(()));
    assert_eq!(component_volumes(&both).len(), 2);
    assert!((both.volume() - 2.0 / 6.0).abs() < 1.0e-6);
}

/// Catches a shape that is not what stock Rapier would have built.
#[test]
fn shapes_hold_the_mesh_as_it_is() {
    let head = mesh::monkey_head();
    let shape = head.shared_shape().unwrap();
    let trimesh = shape.as_trimesh().unwrap();
    assert_eq!(trimesh.vertices(), head.vertices);
    assert_eq!(trimesh.indices(), head.triangles);
    assert_eq!(trimesh.flags(), TriMeshFlags::empty());
    let flags = TriMeshFlags::FIX_INTERNAL_EDGES;
    assert!(head.trimesh(flags).unwrap().flags().contains(flags));
    assert!(Mesh::new("empty", Vec::new(), Vec::new()).shared_shape().is_err());
}
