use super::shapes::{PREDICTIONS, lattice_pose, pose, shapes};
use crate::prelude::*;
use rapier3d::parry::bounding_volume::BoundingVolume;
use sbbk_core::traverse::Placement;
use sbbk_testkit::truth::convex_body;
use sbbk_truth::ConvexBody;

/// Compares contacts with brute force in f64, up to `tolerance`. Returns their number. Triangles
/// beside the box of the shape are known to be far.
fn check_against_truth(
    question: &Question,
    name: &str,
    found: &[Manifold],
    body: &ConvexBody,
    tolerance: f64,
) -> usize {
    let placement = Placement::new(&question.pos12());
    let placement = if question.is_flipped { placement } else { placement.inverted() };
    let found = found.iter().map(|manifold| (question.subshapes(manifold), distance(manifold)));
    let found: BTreeMap<[u32; 2], Real> = found.collect();
    assert!(found.keys().all(|&[_, other]| other == 0), "the convex shape has no subshapes");
    let prediction = f64::from(question.prediction);
    let around = question.shapes[1].compute_local_aabb().loosened(1.01 * question.prediction);
    for (index, triangle) in (0..).zip(question.mesh().triangles()) {
        let corners = triangle.vertices().map(|v| placement.to_frame1(v, Vec3::ZERO));
        let is_beside = (0..3).any(|axis| {
            let [low, high] = [around.mins[axis], around.maxs[axis]].map(f64::from);
            corners.iter().all(|corner| corner[axis] < low)
                || corners.iter().all(|corner| corner[axis] > high)
        });
        let truth = if is_beside { f64::INFINITY } else { body.distance(&corners) };
        match found.get(&[index, 0]) {
            Some(&near) => {
                let error = (f64::from(near) - truth).abs();
                assert!(error <= tolerance, "{name}: {index} at {near}, is at {truth}");
            }
            None => assert!(truth >= prediction - tolerance, "{name}: {index} is lost"),
        }
    }
    found.len()
}

/// Would catch the closest point as a fifth one, and corners that are left out.
#[test]
fn a_box_that_lies_flat_touches_at_its_corners() {
    let dispatcher = SbbkDispatcher::default();
    let mut random = Rand32::new(8);
    for i in 0..300 {
        let floor = mesh::floor(400.0, 1);
        let turn = if i % 2 == 0 { Quat::IDENTITY } else { rotation(&mut random) };
        let mesh = shape(&floor.mapped(|v| turn * v));
        let [x, y, z] = [(); 3].map(|()| 0.2 + random.rand_float());
        let gap = [-0.01, 0.0, 0.005][i % 3];
        let place = Vec3::new(40.0 + x, y + gap, -20.0 - z);
        let yaw = Quat::from_rotation_y(6.0 * random.rand_float());
        let pose = Pose3::from_parts(turn * place, turn * yaw);
        let shape = SharedShape::cuboid(x, y, z);
        let question = Question::new(&mesh, &*shape, pose).flipped(i % 5 == 0);
        let found = question.fresh(&dispatcher);
        assert_eq!(found.iter().map(|m| m.points.len()).collect::<Vec<_>>(), [4], "{i}");
    }
}

/// Would catch a capsule on its end that touches twice at one place: Rapier's solver has twice the
/// work.
#[test]
fn a_capsule_has_a_point_at_each_end() {
    let (dispatcher, mesh) = (SbbkDispatcher::default(), shape(&mesh::floor(400.0, 1)));
    for tilt in [0.0, 0.3, FRAC_PI_2] {
        let lowest = 0.3 * tilt.cos() + 0.2;
        let pose = Pose3::new(Vec3::new(40.0, lowest, -20.0), Vec3::new(0.0, 0.0, tilt));
        let capsule = SharedShape::capsule_y(0.3, 0.2);
        let found = Question::new(&mesh, &*capsule, pose).fresh(&dispatcher);
        assert_eq!(found.iter().map(|m| m.points.len()).collect::<Vec<_>>(), [2], "{tilt}");
    }
}

/// Would catch components of normals that are rounding. Rapier's solver takes a fifth longer with
/// these, as their products are subnormal numbers.
#[test]
fn normals_across_a_flat_floor_have_no_noise() {
    let dispatcher = SbbkDispatcher::default();
    let mut random = Rand32::new(9);
    let floor = shape(&mesh::floor(400.0, 1));
    let cube = mesh::cuboid(Vec3::splat(0.3), 2).shape();
    for (name, shape) in shapes(0.6).into_iter().chain([("mesh", cube)]) {
        for i in 0..40 {
            // Bodies at rest are turned by as little.
            let turn = Quat::from_scaled_axis(1e-7 * random.rand_float() * direction(&mut random));
            let pose = Pose3::from_parts(Vec3::new(40.0, 0.1, -20.0), turn);
            let question = Question::new(&floor, &*shape, pose).flipped(i % 2 == 0);
            for manifold in question.fresh(&dispatcher) {
                for part in [manifold.local_n1, manifold.local_n2].map(|n| n.to_array()) {
                    let is_noise = |x: f32| x != 0.0 && x.abs() < f32::EPSILON;
                    assert!(!part.into_iter().any(is_noise), "{name}: {part:?}");
                }
            }
        }
    }
}

/// Shapes of all kinds and sizes, against brute force in f64. Would catch a shape or pose taken for
/// another, a missing radius, a tolerance with a unit, and a lost or invented triangle.
#[test]
fn exact_contacts_are_the_true_ones() {
    let dispatcher = per_triangle();
    let mut random = Rand32::new(4);
    let is_quick = |name: &str| ["ball", "cuboid", "half-space"].contains(&name);
    for (scale, share) in [(0.01, 0.6), (1.0, 0.6), (1.0, 3.0), (100.0, 0.6)] {
        let head = shape(&mesh::monkey_head().scaled(scale));
        let size = share * scale;
        for (name, shape) in shapes(size) {
            let body = convex_body(&*shape);
            // Brute force over all triangles takes seconds for hulls.
            let (mut count, poses) = (0, if is_quick(name) { 40 } else { 27 });
            if share > 1.0 && !is_quick(name) {
                continue;
            }
            for i in 0..poses {
                let pose = if i % 4 == 0 && scale == 1.0 {
                    lattice_pose(&mut random)
                } else {
                    pose(&mut random, &head, size)
                };
                let (prediction, flipped) = (PREDICTIONS[i % 4] * scale, i % 8 < 4);
                let question =
                    Question::new(&head, &*shape, pose).within(prediction).flipped(flipped);
                let found = question.fresh(&dispatcher);
                count +=
                    check_against_truth(&question, name, &found, &body, 1e-6 * f64::from(scale));
            }
            assert!(count > 2 * poses, "{name} of {scale}: {count}");
        }
    }
}

/// Would catch rounding that grows with the floor and is not allowed for, and a floor that is cut
/// off too early.
#[test]
fn a_huge_floor_loses_no_contact() {
    let exact = per_triangle();
    let mut random = Rand32::new(2);
    let head = shape(&mesh::monkey_head());
    let mut count = 0;
    for half in [50.0, 2000.0] {
        let shape = SharedShape::cuboid(half, 0.25, half);
        let body = convex_body(&*shape);
        for i in 0..60 {
            let turn = if i % 4 == 0 { Quat::IDENTITY } else { rotation(&mut random) };
            let [x, z] = [(); 2].map(|()| 1.8 * half * (random.rand_float() - 0.5));
            let at = Vec3::new(x, 0.25 + 0.9 * random.rand_float(), z);
            // The head in the frame of the floor, and back.
            let pose = Pose3::from_parts(at, turn).inverse();
            let prediction = PREDICTIONS[i % 4];
            for flipped in [false, true] {
                let question =
                    Question::new(&head, &*shape, pose).within(prediction).flipped(flipped);
                let found = question.fresh(&exact);
                count += check_against_truth(&question, "floor", &found, &body, 1e-6);
            }
        }
    }
    assert!(count > 1000, "{count} contacts");
}

/// Would catch points that a constrained normal puts far deeper than the shape is: Parry drops
/// those that are five times as deep.
#[test]
fn constrained_normals_make_no_deep_points() {
    let bumps = mesh::terrain(4.0, 12, 0.7);
    let [free, fixed] =
        [TriMeshFlags::empty(), TriMeshFlags::FIX_INTERNAL_EDGES].map(|flags| bumps.trimesh(flags));
    let dispatcher = per_triangle();
    let shape = SharedShape::cuboid(0.4, 0.3, 0.2);
    let (mut random, mut seen) = (Rand32::new(8), 0);
    for _ in 0..400 {
        let pose = pose(&mut random, &free, 0.3);
        let ask = |mesh| Question::new(mesh, &*shape, pose);
        let depths: BTreeMap<u32, Real> =
            ask(&free).fresh(&dispatcher).iter().map(|m| (m.subshape1, distance(m))).collect();
        for manifold in ask(&fixed).fresh(&dispatcher) {
            let depth = depths[&manifold.subshape1].min(0.0);
            if depth < 0.0 {
                assert!(distance(&manifold) >= 5.0 * depth - 1e-6, "{manifold:?} {depth}");
                seen += 1;
            }
        }
    }
    assert!(seen > 500, "{seen}");
}
