use super::shapes::shapes;
use crate::prelude::*;

/// Would catch contacts at edges between triangles, points beside the body, and a body without
/// contacts.
#[test]
fn a_floor_of_triangles_is_flat() {
    const DEPTH: f32 = 0.01;
    let [surfaces, triangles] = [every(), per_triangle()];
    let mut random = Rand32::new(1);
    let floor = shape(&mesh::floor(6.0, 40));
    let mut slanted = 0;
    // A flat shape may be below a triangle that it crosses.
    let is_thick = |name: &str| !["half-space", "segment", "triangle"].contains(&name);
    for (name, shape) in shapes(1.0).into_iter().filter(|(name, _)| is_thick(name)) {
        let mut cases = 0;
        for i in 0..200 {
            let turn = if i % 4 == 0 { Quat::IDENTITY } else { rotation(&mut random) };
            let [x, z] = [(); 2].map(|()| if i % 8 < 4 { 0.15 } else { random.rand_float() });
            let aabb = shape.compute_aabb(&Pose3::from_rotation(turn));
            let pose = Pose3::from_parts(Vec3::new(x, -aabb.mins.y - DEPTH, z), turn);
            // The middle of a flat one may be in the floor.
            if aabb.mins.y > -0.1 {
                continue;
            }
            let question = Question::new(&floor, &*shape, pose).flipped(i % 2 == 0);
            let up = |manifold: &Manifold| {
                question.host_order([manifold.local_n1, manifold.local_n2])[0].y
            };
            let is_up = |manifold: &Manifold| up(manifold) > 0.999_996;
            let found = question.fresh(&surfaces);
            assert!(found.iter().all(is_up), "{name}, {i}: {found:?}");
            let deepest = found.iter().map(distance).fold(f32::INFINITY, f32::min);
            assert!((deepest + DEPTH).abs() < 2e-5, "{name}, {i}: {deepest}");
            slanted +=
                question.fresh(&triangles).iter().filter(|&manifold| !is_up(manifold)).count();
            cases += 1;
        }
        assert!(cases > 50, "{name}: {cases}");
    }
    assert!(slanted > 1000, "{slanted} of triangles by themselves");
}

/// Would catch neighbours missed because they share no vertices, minima left out, and crossing
/// bodies without a deep contact. A contact belongs to the surface if no other triangle is nearer
/// at its point.
#[test]
fn contacts_of_a_surface_are_the_nearest_at_their_points() {
    const CLOSE: f32 = 1e-5;
    let [surfaces, triangles] = [every(), per_triangle()];
    let mut random = Rand32::new(5);
    let bumps = mesh::terrain(4.0, 16, 0.5);
    let split = mesh::unwelded(&bumps, 0.0, 0);
    let meshes = [bumps, split].map(|mesh| shape(&mesh));
    let (mut kept, mut turned, mut left_out) = (0, 0, 0);
    for (name, shape) in shapes(1.0).into_iter().filter(|(name, _)| *name != "half-space") {
        for i in 0..60 {
            let mesh = &meshes[i % 2];
            let at = mesh.triangle(random.rand_range(0..512)).center();
            let turn = rotation(&mut random);
            let low = shape.compute_aabb(&Pose3::from_rotation(turn)).mins.y;
            let height = 0.06 * random.rand_float() - 0.03;
            let pose = Pose3::from_parts(at + Vec3::Y * (height - low), turn);
            let question = Question::new(mesh, &*shape, pose).within(0.05);
            let own = question.fresh(&triangles);
            let found = question.fresh(&surfaces);
            let is_in = |manifolds: &[Manifold]| manifolds.iter().any(|m| distance(m) < 0.0);
            assert_eq!(is_in(&found), is_in(&own), "{name}, {i}");
            let found: BTreeMap<u32, &Manifold> = found.iter().map(|m| (m.subshape1, m)).collect();
            assert!(found.keys().all(|found| own.iter().any(|m| m.subshape1 == *found)));
            for manifold in &own {
                let triangle = mesh.triangle(manifold.subshape1);
                let face = triangle.normal().expect("no triangle is degenerate");
                let along = manifold.local_n1.dot(face).abs();
                let is_face = along > 0.999_999_5;
                if !is_face && along > 0.999_99 {
                    continue;
                }
                let Some(nearest) = manifold.find_deepest_contact() else { continue };
                let gap = |other: &Manifold| {
                    let triangle = mesh.triangle(other.subshape1);
                    let is_there =
                        triangle.distance_to_local_point(nearest.local_p1, false) < CLOSE;
                    if is_there { distance(other) - nearest.dist } else { f32::INFINITY }
                };
                let is_level = |other: &&Manifold| gap(other).abs() < CLOSE;
                let level: Vec<u32> = own.iter().filter(is_level).map(|m| m.subshape1).collect();
                let gap = own.iter().map(gap).fold(f32::INFINITY, f32::min);
                let same = |other: &Manifold| other.local_n1.dot(manifold.local_n1) > 0.999_99;
                let now = found.get(&manifold.subshape1).copied();
                if is_face {
                    assert!(now.is_some_and(same), "{name}, {i}: {manifold:?}, {now:?}");
                    kept += 1;
                } else if gap >= 0.0 && nearest.dist > CLOSE {
                    // Another triangle at the same point may hold the contact.
                    let mut now = level.iter().filter_map(|triangle| found.get(triangle));
                    // A border may be met as its face is.
                    let is_border = nearest.local_p1.abs().max_element() > 2.0 - CLOSE;
                    let is_face = |now: &Manifold| {
                        let face = mesh.triangle(now.subshape1).normal();
                        face.is_some_and(|face| face.dot(now.local_n1).abs() > 0.999_99)
                    };
                    let is_meant = |now: &&Manifold| same(now) || is_border && is_face(now);
                    assert!(now.any(is_meant), "{name}, {i}: {manifold:?}, {level:?}");
                    kept += 1;
                } else if gap < -CLOSE
                    && let Some(now) = now
                {
                    let is_nearer = |m: &&Manifold| distance(m) < nearest.dist;
                    let is_of = |m: &Manifold| m.local_n1.dot(now.local_n1) > 0.999_99;
                    let is_of_nearer = own.iter().filter(is_nearer).any(is_of)
                        || mesh.triangles().any(|t| {
                            t.normal().is_some_and(|n| n.dot(now.local_n1).abs() > 0.999_99)
                        });
                    assert!(is_of_nearer, "{name}, {i}: {manifold:?}, {now:?}");
                    turned += usize::from(!same(now));
                } else if gap < -CLOSE {
                    left_out += 1;
                }
            }
        }
    }
    assert!(kept > 600 && turned > 1000 && left_out > 1000, "{kept}, {turned}, {left_out}");
}

/// Would catch normal cones that bring ghost contacts back, and flags with which a body feels
/// internal edges.
#[test]
fn flags_of_a_rigid_mesh_change_no_contact() {
    let flags = [
        TriMeshFlags::MERGE_DUPLICATE_VERTICES,
        TriMeshFlags::FIX_INTERNAL_EDGES,
        TriMeshFlags::FIX_INTERNAL_EDGES_TWO_SIDED,
        TriMeshFlags::ORIENTED,
    ];
    // 512 triangles each.
    let grounds = [mesh::terrain(4.0, 16, 0.5), mesh::ball(2.0, 8)].map(|ground| {
        let flagged = flags.map(|flags| (flags, ground.trimesh(flags)));
        (shape(&ground), flagged)
    });
    let (mut random, mut count) = (Rand32::new(3), 0);
    for dispatcher in [every(), SbbkDispatcher::default()] {
        let head = ("head", mesh::monkey_head_with(6).centred().scaled_to(1.0).shape());
        for (name, shape) in shapes(1.0).into_iter().chain([head]) {
            for i in 0..40 {
                let (plain, flagged) = &grounds[i / 2 % 2];
                let at = plain.triangle(random.rand_range(0..512)).center();
                let turn = rotation(&mut random);
                let low = shape.compute_aabb(&Pose3::from_rotation(turn)).mins.y.max(-1.0);
                let pose = Pose3::from_parts(at - Vec3::Y * (low + 0.02), turn);
                let found = |mesh: &TriMesh| {
                    let question = Question::new(mesh, &*shape, pose).within(0.05);
                    let found = question.flipped(i % 2 == 0).fresh(&dispatcher);
                    found.iter().map(bits).collect::<Vec<_>>()
                };
                let expected = found(plain);
                count += expected.len();
                for (flags, mesh) in flagged {
                    assert_eq!(found(mesh), expected, "{name}, {i}, {flags:?}");
                }
            }
        }
    }
    assert!(count > 300, "{count} contacts");
}

/// Cuboids that cross the edge of a box of 12 to 432 triangles, by up to 0.04. Would catch contacts
/// whose normals come from a face that the cuboid has half passed. These led into the box, and were
/// up to 27 times too deep.
#[test]
fn cuboids_over_edges_are_not_pushed_in() {
    let (mut random, mut contacts, mut too_deep) = (Rand32::new(3), 0, 0);
    let dispatcher = SbbkDispatcher::default();
    for i in 0..3000 {
        let mut sides = |low: Real, high: Real| {
            Vec3::from_array([(); 3].map(|()| low + (high - low) * random.rand_float()))
        };
        let (half, of_body, place) = (sides(0.2, 0.6), sides(0.1, 0.4), sides(-0.2, 0.2));
        // Away from the origin: lines through the origin seldom lead to edges.
        let mesh = shape(&mesh::cuboid(half, 1 + i % 6).mapped(|vertex| vertex + place));
        let [solid, body] = [half, of_body].map(Cuboid::new);
        let pose = touching_shapes(&mut random, [&mesh, &body], 3.0, 0.01 * (1 + i % 4) as Real);
        let in_solid = Pose3::from_translation(-place) * pose;
        let truth = DefaultQueryDispatcher.contact(&in_solid, &solid, &body, 0.0).unwrap();
        let truth = truth.map_or(0.0, |truth| truth.dist);
        for manifold in Question::new(&mesh, &body, pose).fresh(&dispatcher) {
            contacts += 1;
            too_deep += usize::from(distance(&manifold) < 2.0 * truth - 0.01);
        }
    }
    println!("{too_deep} of {contacts} contacts are too deep");
    assert!(contacts > 3000 && 400 * too_deep < contacts, "{too_deep} of {contacts}");
}
