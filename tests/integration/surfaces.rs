//! The contacts of surfaces.

use crate::prelude::*;
use std::f32::consts::FRAC_PI_4;

fn ask(query: &Question) -> Vec<Manifold> {
    query.fresh(&every())
}

/// A cube of edge length 1 about the origin, of 12 triangles.
fn cube() -> TriMesh {
    shape(&mesh::cuboid(Vec3::splat(0.5), 1))
}

/// Panics unless all contacts point one way, up to `sine`, and there are some.
fn assert_along(manifolds: &[Manifold], direction: Vector, sine: Real) {
    assert!(!manifolds.is_empty(), "no contacts");
    for manifold in manifolds {
        let off = (manifold.local_n1 - direction).length();
        assert!(off <= sine, "{:?} points along {}", triangles(manifold), manifold.local_n1);
    }
}

/// Would catch contacts that push sideways or down, corners without a point, and wrong depths.
#[test]
fn a_cube_that_has_sunk_a_little_is_pushed_up() {
    let cube = cube();
    for (sunk, [x, z]) in
        [(0.0007, [0.0, 0.0]), (0.0007, [0.2, 0.1]), (1e-6, [0.3, 0.0]), (0.05, [0.1, 0.2])]
    {
        let found = ask(&Question::new(&cube, &cube, Pose::translation(x, 1.0 - sunk, z)));
        assert_along(&found, Vector::Y, 1e-6);
        for corner in [[x - 0.5, z - 0.5], [x - 0.5, 0.5], [0.5, z - 0.5], [0.5, 0.5]] {
            let [x, z] = corner;
            let points = found.iter().flat_map(|manifold| &manifold.points);
            let away =
                points.map(|point| (point.local_p1 - Vector::new(x, point.local_p1.y, z)).length());
            let nearest = away.fold(Real::INFINITY, Real::min);
            assert!(nearest < 1e-4, "the nearest to {corner:?} is {nearest} away, sunk by {sunk}");
        }
        for manifold in &found {
            assert!((distance(manifold) + sunk).abs() < 1e-5, "{}", distance(manifold));
        }
    }
}

/// Would catch a cube pushed through another one to the far side: it leaves by the nearer one.
#[test]
fn a_cube_sunk_halfway_leaves_by_the_nearer_side() {
    let cube = cube();
    for (height, [x, z]) in [(0.7, [0.1, 0.05]), (0.55, [0.1, 0.05]), (0.6, [0.3, -0.2])] {
        for sign in [1.0, -1.0] {
            let found = ask(&Question::new(&cube, &cube, Pose::translation(x, sign * height, z)));
            // A triangle at the rim of the overlap may see less of it sideways.
            let up = |manifold: &Manifold| sign * manifold.local_n1.y;
            let count_up = found.iter().filter(|manifold| up(manifold) > 1.0 - 1e-6).count();
            assert!(found.iter().all(|manifold| up(manifold) > -1e-6));
            assert!(count_up >= 3 && found.len() <= count_up + 1, "{count_up} of {}", found.len());
            // Depths end at a tenth of the radius.
            let expected = (1.0 - height).min(0.1 * 0.75_f32.sqrt());
            let depth = -found.iter().map(distance).fold(0.0, Real::min);
            assert!((depth - expected).abs() < 1e-5, "{depth} at {height}");
        }
    }
}

/// Boxes that overlap by more than a row of their triangles, clean and dirty. Would catch contacts
/// of the sides, along which the boxes are pushed aside or spun. Would catch soups whose contours
/// count as open.
#[test]
fn boxes_deep_in_each_other_part_the_way_they_came() {
    let soup = |mesh: &Mesh| mesh::unwelded(mesh, 2e-5, 7);
    let doubled = |mesh: &Mesh| mesh::doubled(mesh, 2);
    let kinds: [(&str, Dirt); 3] =
        [("clean", &Mesh::clone), ("soup", &soup), ("doubled", &doubled)];
    for (name, dirt) in kinds {
        let [aside, count] = count_aside(dirt);
        println!("{name}: {aside} of {count} aside");
        assert!(aside <= count / 100, "{name}: {aside} of {count} are pushed aside");
    }
}

/// Makes a mesh dirty.
type Dirt<'a> = &'a dyn Fn(&Mesh) -> Mesh;

/// Puts boxes deep in each other. Returns how many are pushed aside, and the number of all.
fn count_aside(dirt: Dirt<'_>) -> [usize; 2] {
    let mut random = Rand32::new(5);
    let (mut count, mut aside) = (0, 0);
    for [one, other] in [[0.4, 0.58], [1.0, 1.0], [1.6, 1.0], [4.0, 1.0]] {
        for cells in [1, 3, 8] {
            let boxes = [(one, cells), (other, cells + 1)];
            let [floor, body] =
                boxes.map(|(size, n)| shape(&dirt(&mesh::cuboid(Vec3::splat(0.5 * size), n))));
            for share in [0.1, 0.15, 0.2, 0.3, 0.4].repeat(4) {
                let mut near = || 2.0 * random.rand_float() - 1.0;
                let depth = share * Real::min(one, other);
                let height = 0.5 * (one + other) - depth;
                let at = Vec3::new(0.02 * near(), height, 0.02 * near());
                let turn = 0.02 * Vec3::new(near(), near(), near());
                let pose = Pose::from_parts(at, Quat::from_scaled_axis(turn));
                let found = ask(&Question::new(&floor, &body, pose));
                let depths = found.iter().flat_map(|manifold| {
                    let sine = manifold.local_n1.cross(Vector::Y).length();
                    let deep = manifold.points.iter().map(|point| -point.dist.min(0.0));
                    deep.map(move |deep| (deep * manifold.local_n1.y, deep * sine))
                });
                let [up, sideways] = depths
                    .fold([0.0; 2], |[up, sideways], (one, other)| [up + one, sideways + other]);
                count += 1;
                aside += usize::from(sideways > 0.4 * up);
            }
        }
    }
    [aside, count]
}

/// Balls with T-junctions deep in each other, coarse and cut into fine triangles. Would catch
/// overlaps whose contour counts as open at a gap, so that only the crossing triangles are parted.
#[test]
fn balls_with_gaps_part_along_their_overlap_however_fine_they_are() {
    let [one, other] = [[9, 7, 8, 6, 9, 8], [8, 9, 6, 7, 10, 9]];
    for times in [0, 1, 2] {
        let [one, other] =
            [one, other].map(|cells| shape(&split(mesh::cube_ball(0.5, cells), times)));
        for turn in [0.3, 0.7, 1.1] {
            let turn = Quat::from_scaled_axis(turn * Vec3::new(0.6, 0.5, 0.4));
            let query = Question::new(&one, &other, Pose::from_parts(0.7 * Vec3::X, turn));
            let found = ask(&query);
            let deepest = found.iter().map(distance).fold(0.0, Real::min);
            assert!(deepest <= -4.0 * query.prediction, "{deepest}, cut {times} times");
        }
    }
}

/// Would catch faces that have passed each other, and no longer cross, taken for two that are
/// apart: the cube would be held inside.
#[test]
fn faces_that_have_passed_each_other_part_the_way_they_came() {
    let (floor, small) = (cube(), shape(&mesh::cuboid(Vec3::splat(0.2), 1)));
    for sunk in [1e-5, 0.001, 0.01] {
        // No triangle of the small cube crosses one of the large face but at its sides.
        let found = ask(&Question::new(&floor, &small, Pose::translation(0.05, 0.7 - sunk, 0.02)));
        assert_along(&found, Vector::Y, 1e-6);
        assert!(found.iter().all(|manifold| (distance(manifold) + sunk).abs() < 1e-5));
    }
}

/// Would catch bodies as small as the prediction distance pushed out on their far sides.
#[test]
fn small_bodies_are_not_pushed_out_on_their_far_sides() {
    let bodies = [
        shape(&mesh::torus(0.02, 0.008, 24, 12)),
        shape(&mesh::monkey_head_with(8).centred().scaled_to(0.05)),
        shape(&mesh::cuboid(Vec3::new(0.03, 0.02, 0.012), 6)),
    ];
    // By this way back they part. Deep overlaps are as deep as along the ray from their middle.
    let depth = 0.03;
    let mut random = Rand32::new(31);
    for i in 0..90 {
        let (one, other) = (&bodies[i % 3], &bodies[i / 3 % 3]);
        let query = Question::new(one, other, touching(&mut random, [one, other], depth));
        let deepest = ask(&query).iter().map(distance).fold(0.0, Real::min);
        assert!(deepest > -1.1 * depth, "{deepest}");
    }
}

/// Would catch contacts of edges within a floor: the points of a cube that lies on many small
/// triangles all push up.
#[test]
fn a_cube_on_a_fine_floor_is_pushed_one_way() {
    let (floor, cube) = (shape(&mesh::floor(4.0, 40)), cube());
    let slab = shape(&mesh::cuboid(Vec3::new(2.0, 0.5, 2.0), 20).mapped(|v| v - 0.5 * Vec3::Y));
    let mut random = Rand32::new(1);
    for _ in 0..40 {
        let [x, z] = [(); 2].map(|()| random.rand_float() - 0.5);
        let turn = Quat::from_rotation_y(random.rand_float());
        for ground in [&floor, &slab] {
            for height in [0.5 + 0.01, 0.5, 0.5 - 0.0007] {
                // A crossed sheet keeps all contacts of triangles.
                let is_crossing = height < 0.5;
                if is_crossing && std::ptr::eq(ground, &floor) {
                    continue;
                }
                let pose = Pose::from_parts(Vec3::new(x, height, z), turn);
                let found = ask(&Question::new(ground, &cube, pose));
                // Apart, points of neighbours that are hardly farther count as well.
                let sine = if height > 0.5 { 0.08 } else { 1e-3 };
                assert_along(&found, Vector::Y, sine);
            }
        }
    }
}

/// A sheet has no inside: a cube is pushed to the side on which most of it is. Would catch a side
/// taken from the order of vertices.
#[test]
fn a_cube_is_pushed_to_its_own_side_of_a_sheet() {
    let (floor, cube) = (shape(&mesh::floor(4.0, 8)), cube());
    for sign in [1.0, -1.0] {
        for height in [0.51, 0.495, 0.45, 0.3] {
            let pose = Pose::translation(0.1, sign * height, 0.17);
            let found = ask(&Question::new(&floor, &cube, pose));
            let lifts = found.iter().map(|m| sign * m.local_n1.y);
            let sideways = lifts.clone().filter(|lift| lift.abs() < 0.9).count();
            assert!(found.iter().all(|m| sign * m.local_n1.y > -1e-6), "{height} {sign}");
            assert!(2 * sideways < found.len(), "{sideways} of {} at {height}", found.len());
        }
    }
}

/// Would catch a mesh whose normals point inwards and that pulls bodies in: two of them part along
/// the line of their middles.
#[test]
fn inside_out_meshes_push_each_other_apart() {
    let inside = shape(&turned_inside_out(mesh::ball(0.8, 6)));
    let mut random = Rand32::new(3);
    let mut count = 0;
    for depth in [0.02, 0.1].repeat(8) {
        let pose = touching(&mut random, [&inside; 2], depth);
        for manifold in ask(&Question::new(&inside, &inside, pose)) {
            let along = manifold.local_n1.dot(pose.translation.normalize());
            assert!(along > 0.0, "{along} at {pose:?}");
            count += 1;
        }
    }
    assert!(count > 50, "{count}");
}

/// Would catch a side that the winding of a closed mesh decides, rather than where its body is. One
/// of two contacts that are nearly as deep may be deeper, as the corners have another order.
#[test]
fn inside_out_meshes_have_the_contacts_of_their_bodies() {
    let bodies = [mesh::ball(0.8, 6), mesh::cuboid(Vec3::splat(0.6), 2), mesh::monkey_head()];
    let mut random = Rand32::new(8);
    let deepest = |one: &TriMesh, two: &TriMesh, pose: Pose| {
        let found = ask(&Question::new(one, two, pose));
        let found = found.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        found.map(|manifold| (distance(manifold), manifold.local_n1))
    };
    let (mut same, mut count) = (0, 0);
    for (one, two) in bodies.iter().flat_map(|one| bodies.iter().map(move |two| (one, two))) {
        let turned = [one, two].map(|mesh| shape(&turned_inside_out(mesh.clone())));
        let [one, two] = [one, two].map(shape);
        for depth in [-0.01, 0.003, 0.03, 0.1].repeat(10) {
            let pose = touching(&mut random, [&one, &two], depth);
            let sound = deepest(&one, &two, pose).expect("the meshes meet");
            for [one, two] in [[&turned[0], &two], [&one, &turned[1]], [&turned[0], &turned[1]]] {
                let found = deepest(one, two, pose).expect("the meshes meet");
                let (off, along) = ((found.0 - sound.0).abs(), found.1.dot(sound.1));
                assert!(off < 1e-3 && along > 0.95, "{depth}: {found:?} {sound:?}");
                same += usize::from(off < 1e-5 && along > 0.9999);
                count += 1;
            }
        }
    }
    assert!(count == 1080 && same > 1070, "{same} of {count}");
}

/// Solids and sheets, of few and of many triangles.
fn meshes() -> Vec<Mesh> {
    vec![
        mesh::monkey_head_with(7),
        mesh::ball(0.8, 6),
        mesh::torus(0.8, 0.35, 20, 10),
        mesh::cuboid(Vec3::splat(0.6), 3),
        mesh::terrain(3.0, 12, 0.5),
        turned_inside_out(mesh::ball(0.7, 4)),
    ]
}

/// Poses of all pairs of `meshes`, from apart to deep.
fn for_each_pose(seed: u64, mut check: impl FnMut([&TriMesh; 2], Pose)) {
    let shapes: Vec<TriMesh> = meshes().iter().map(shape).collect();
    let mut random = Rand32::new(seed);
    for (i, one) in shapes.iter().enumerate() {
        for two in &shapes[..=i] {
            for depth in [-0.01, 0.0, 0.003, 0.03, 0.2, 0.5] {
                check([one, two], touching(&mut random, [one, two], depth));
            }
        }
    }
}

/// Would catch contacts that triangles alone do not have, another order, and wrong gaps.
#[test]
fn surfaces_have_some_of_the_contacts_of_triangles_and_normals_of_length_one() {
    let [mut some, mut all] = [0; 2];
    for_each_pose(4, |[one, two], pose| {
        let query = Question::new(one, two, pose);
        let (found, expected) = (ask(&query), query.fresh(&per_triangle()));
        let is_unit = |normal: Vector| (normal.length() - 1.0).abs() < 1e-5;
        assert!(found.iter().all(|m| is_unit(m.local_n1) && is_unit(m.local_n2)), "{pose:?}");
        for gap in found.iter().filter(|manifold| distance(manifold) > 1e-6) {
            let same = expected.iter().find(|other| triangles(other) == triangles(gap));
            let same = same.map_or(Real::NAN, distance);
            assert!((distance(gap) - same).abs() < 1e-5, "{} for {same}", distance(gap));
        }
        let [found, expected] = [found, expected].map(|manifolds| sequence(&manifolds));
        let mut rest = expected.iter();
        assert!(found.iter().all(|pair| rest.any(|other| other == pair)), "{found:?}");
        some += found.len();
        all += expected.len();
    });
    // A third of the poses are deep, and need most contacts.
    assert!(some > 500 && 3 * some < 2 * all, "{some} of {all}");
}

/// Cubes edge over edge, alone and with blocks beside them that nearly touch. Would catch edges
/// that lack a contact though nothing is nearer. Would catch edges that hold each other, too.
#[test]
fn edges_pass_each_other_if_something_is_nearer() {
    let edge_up = Quat::from_rotation_x(FRAC_PI_4);
    let cube = |turn: Quat, height: Real| {
        mesh::cuboid(Vec3::splat(0.5), 1).mapped(|vertex| turn * vertex + height * Vec3::Y)
    };
    let block = |height: Real| {
        mesh::cuboid(Vec3::splat(0.2), 1).mapped(|vertex| vertex + Vec3::new(3.0, height, 0.0))
    };
    for (gap, prediction) in [(0.004, 0.02), (0.006, 0.02), (0.019, 0.02), (0.019, 0.1)] {
        let upper = cube(Quat::from_rotation_y(0.5) * edge_up, 2.0_f32.sqrt() + gap);
        let alone = [cube(edge_up, 0.0), upper];
        let blocks = [block(0.0), block(0.402)];
        let beside = [0, 1].map(|i| Mesh::merged("both", &[alone[i].clone(), blocks[i].clone()]));
        let has_edges = |meshes: &[Mesh; 2], is_flipped: bool| {
            let [one, two] = meshes.each_ref().map(shape);
            let query = Question::new(&one, &two, Pose::IDENTITY).within(prediction);
            let found = ask(&query.flipped(is_flipped));
            found.iter().any(|manifold| (distance(manifold) - gap).abs() < 1e-4)
        };
        for is_flipped in [false, true] {
            assert!(has_edges(&alone, is_flipped), "{gap} within {prediction}");
            let is_near = gap <= 0.25 * prediction;
            assert_eq!(has_edges(&beside, is_flipped), is_near, "{gap} within {prediction}");
        }
    }
}

/// A cube that leans over a floor of small triangles. Would catch its edges held up by those within
/// the floor, along normals that are neither the floor's nor the cube's.
#[test]
fn edges_within_a_flat_side_hold_no_edges() {
    let (cube, floor) = (cube(), shape(&mesh::floor(4.0, 40)));
    let mut random = Rand32::new(17);
    let [mut count, mut odd] = [0; 2];
    for lean in [0.005, 0.01, 0.02, 0.04] {
        for _ in 0..20 {
            let turn = Quat::from_rotation_y(6.0 * random.rand_float());
            let turn = turn * Quat::from_rotation_x(lean) * Quat::from_rotation_z(0.4 * lean);
            let lowest = cube.vertices().iter().map(|&vertex| (turn * vertex).y).reduce(Real::min);
            let place = nudge(&mut random, 0.3).translation.with_y(0.003 - lowest.unwrap());
            let query = Question::new(&floor, &cube, Pose::from_parts(place, turn));
            for Manifold { local_n1, .. } in ask(&query) {
                let is_of_face = |normal: Vector| (local_n1 - normal).length() < 1e-5;
                count += 1;
                odd += usize::from(!is_of_face(Vector::Y) && !is_of_face(turn * Vector::Y));
            }
        }
    }
    // At corners of the floor's triangles that are below an edge of the cube.
    assert!(count > 500 && odd < count / 50, "{odd} of {count}");
}

/// Meshes that cross have a contact. Would catch bodies that fall through each other where no
/// contact leads out.
#[test]
fn crossing_meshes_have_a_contact() {
    let mut count = 0;
    for seed in 5..15 {
        for_each_pose(seed, |[one, two], pose| {
            let query = Question::new(one, two, pose);
            let all = query.fresh(&per_triangle());
            if all.iter().any(|manifold| distance(manifold) < -1e-6) {
                let parts = |manifold: &Manifold| manifold.local_n1 != Vector::ZERO;
                assert!(ask(&query).iter().any(parts), "{} pairs at {pose:?}", all.len());
                count += 1;
            }
        });
    }
    assert!(count > 500, "{count} pairs cross");
}

/// Would catch a set of triangles that depends on which mesh comes first.
#[test]
fn either_mesh_may_come_first() {
    let mut count = 0;
    for_each_pose(17, |[one, two], pose| {
        let query = Question::new(one, two, pose);
        let pairs = |query: Question| {
            ask(&query).iter().map(|manifold| query.subshapes(manifold)).collect::<BTreeSet<_>>()
        };
        let [a, b] = [query, query.flipped(true)].map(pairs);
        // Roundings of the pose that is turned round decide about few.
        let differ = a.symmetric_difference(&b).count();
        assert!(20 * differ <= a.len(), "{differ} of {} at {pose:?}", a.len());
        count += a.len();
    });
    assert!(count > 500);
}

/// Would catch numbers that have a unit: everything times a power of two, the prediction distance
/// as well, has the contacts of the same triangles.
#[test]
fn contacts_do_not_depend_on_the_unit_of_length() {
    let mut count = 0;
    for scale in [0.0078125, 0.125, 8.0, 128.0] {
        for_each_pose(20, |[one, two], pose| {
            let expected = ask(&Question::new(one, two, pose));
            let [large1, large2] = [one, two].map(|mesh| mesh.clone().scaled(Vector::splat(scale)));
            let far = Pose::from_parts(scale * pose.translation, pose.rotation);
            let query = Question::new(&large1, &large2, far).within(0.02 * scale);
            let found = ask(&query);
            assert_eq!(sequence(&found), sequence(&expected), "{scale} {pose:?}");
            for (one, other) in found.iter().zip(&expected) {
                assert_eq!(one.local_n1, other.local_n1);
            }
            count += found.len();
        });
    }
    assert!(count > 2000, "{count}");
}

/// Would catch contacts of one overlap island that another one removes.
#[test]
fn overlap_islands_do_not_change_each_other() {
    let both = |shift: Vec3| {
        let cube = mesh::cuboid(Vec3::splat(0.5), 1);
        let other = cube.clone().mapped(|v| v + 10.0 * Vec3::X + shift);
        shape(&Mesh::merged("cubes", &[cube, other]))
    };
    let one = both(Vec3::ZERO);
    for sunk in [0.3, 0.45, 0.7] {
        let two = both(-Vec3::Y * sunk);
        let at = Pose::from_parts(Vector::new(0.1, 0.99, 0.05), glamx::Quat::from_rotation_y(0.02));
        let found = ask(&Question::new(&one, &two, at));
        let near = |manifold: &&Manifold| triangles(manifold).iter().all(|t| *t < 12);
        let expected = ask(&Question::new(&cube(), &cube(), at));
        let here: Vec<Manifold> = found.iter().filter(near).cloned().collect();
        let sorted = |found: &[Manifold]| {
            let mut all: Vec<_> = found.iter().map(|m| (triangles(m), distance(m))).collect();
            all.sort_by_key(|(triangles, _)| *triangles);
            all
        };
        assert!(!here.is_empty() && here.len() < found.len(), "{sunk}");
        assert_eq!(sorted(&here), sorted(&expected), "{sunk}");
    }
}
