//! Meshes without trees, which are searched by Parry's BVH and have the same contacts.

use crate::prelude::*;

/// 9600 triangles, four units across.
fn large(flags: TriMeshFlags) -> SharedShape {
    mesh::torus(1.4, 0.6, 100, 48).shape_with(flags)
}

fn as_mesh(shape: &SharedShape) -> &TriMesh {
    shape.as_trimesh().expect("the shape is a mesh")
}

/// Would catch pairs lost or in another order, another normal cone, meshes mixed up, and a surface
/// that is known with the tree only.
#[test]
fn contacts_without_trees_are_those_with_trees() {
    let flags = [TriMeshFlags::empty(), TriMeshFlags::FIX_INTERNAL_EDGES];
    let mut count = 0;
    for (flags, set) in flags.into_iter().flat_map(|flags| SETS.map(|set| (flags, set))) {
        let (ring, head) = (large(flags), mesh::monkey_head().shape_with(flags));
        let [walking, prepared] = [(); 2].map(|()| having(set));
        let _trees = [&ring, &head].map(|shape| prepared.prepare_shape(shape).unwrap());
        let mut random = Rand32::new(1);
        for i in 0..24 {
            let (one, two) = (as_mesh(&ring), as_mesh(if i % 4 == 0 { &ring } else { &head }));
            let pose = match i % 3 {
                // Faces on faces, edges on edges.
                0 => Pose::translation(2.0 + 0.25 * (i / 3) as Real, 0.0, 0.5),
                _ => touching(&mut random, [one, two], [0.0, 0.01, 0.2][i / 3 % 3]),
            };
            let query = Question::new(one, two, pose).within([0.002, 0.02, 0.1][i % 3]);
            for query in [query, query.flipped(true)] {
                let [found, expected] = [&walking, &prepared].map(|d| query.fresh(d));
                assert_bits(&found, &expected, &format!("{i}"));
                count += found.len();
            }
        }
        // Some boxes are apart.
        assert!(walking.stats().internals.walks >= 36 && prepared.stats().internals.walks == 0);
        assert_eq!(prepared.stats().internals.tree_builds, 2);
    }
    assert!(count > 2000, "{count} contacts");
}

/// A ring of 9600 triangles drifts in a room of 12, both prepared, at a gap of twice the prediction
/// distance. Would catch descents of all of the ring, as the leaf of four walls has the room in its
/// box.
#[test]
fn descents_in_a_room_end_at_its_walls() {
    let dispatcher = SbbkDispatcher::default();
    let ring = large(TriMeshFlags::empty());
    let room = SharedShape::new(shape(&mesh::cuboid(Vec3::splat(8.0), 1)));
    let _trees = [&ring, &room].map(|shape| dispatcher.prepare_shape(shape).unwrap());
    let bottom = as_mesh(&ring).local_aabb().mins.y;
    let mut pair = Pair::<(), ()>::default();
    for i in 0..60 {
        let place = Pose::translation(0.003 * i as Real, 0.04 - 8.0 - bottom, 0.0);
        let query = Question::new(as_mesh(&room), as_mesh(&ring), place);
        assert!(pair.ask(&dispatcher, &query).manifolds.is_empty(), "{i}");
    }
    let internals = dispatcher.stats().internals;
    let tests = internals.descent.aabb_tests + internals.descent.leaf_pairs;
    assert!(internals.walks > 0 && tests < 60 * 100, "{internals:?}");
}

/// Would catch a registered mesh whose edit is not seen, one that stays registered, and another
/// shape of equal content.
#[test]
fn a_registered_shape_is_known_until_it_is_let_go() {
    let dispatcher = per_triangle();
    let mut ring = large(TriMeshFlags::empty());
    let head = mesh::monkey_head().shape();
    let pose = touching(&mut Rand32::new(3), [as_mesh(&ring), as_mesh(&head)], 0.05);
    let ask = |ring: &SharedShape| {
        let query = Question::new(as_mesh(ring), as_mesh(&head), pose);
        let before = dispatcher.stats().internals.walks;
        let found = query.fresh(&dispatcher);
        assert_bits(&found, &query.fresh(&per_triangle()), "registered or not");
        (found.len(), dispatcher.stats().internals.walks - before)
    };
    let _tree_of_head = dispatcher.prepare_shape(&head).unwrap();
    let tree = dispatcher.prepare_shape(&ring).unwrap().expect("a rigid mesh");
    assert_eq!(tree.tree().triangle_count(), 9600);
    let (count, walks) = ask(&ring);
    assert!(count > 5 && walks == 0);
    let clone = ring.clone();
    assert_eq!(ask(&clone), (count, 0));
    let mesh = ring.make_mut().as_trimesh_mut().expect("a mesh");
    mesh.update_vertices(|vertices| vertices.iter_mut().for_each(|v| *v *= 0.98));
    let (other_count, walks) = ask(&ring);
    assert!(other_count != count && walks == 1);
    assert_eq!(ask(&clone), (count, 0));
    // Twice is as good as once.
    drop(dispatcher.prepare_shape(&clone).unwrap());
    assert_eq!(ask(&clone), (count, 0));
    drop(tree);
    assert_eq!(ask(&clone), (count, 1));
    assert!(dispatcher.prepare_shape(&SharedShape::ball(1.0)).unwrap().is_none());
    let soft = large(TriMeshFlags::DEFORMABLE);
    assert!(dispatcher.prepare_shape(&soft).unwrap().is_none());
}

/// Meshes of 968 triangles, each another one. Would catch a step in which all of them are built.
#[test]
fn meshes_that_land_together_are_not_all_built_at_once() {
    let head = mesh::monkey_head();
    let meshes: Vec<TriMesh> =
        (0..100).map(|i| shape(&head.clone().scaled_to(2.0 + 0.001 * i as Real))).collect();
    let dispatcher = SbbkDispatcher::default();
    let pose = touching(&mut Rand32::new(4), [&meshes[0], &meshes[1]], 0.05);
    let mut pairs: Vec<Pair> = (1..100).map(|_| Pair::default()).collect();
    let mut step = |step: usize| {
        // Too fast for what the query before has found.
        let pose = Pose::translation(0.0, 0.03 * (step % 2) as Real, 0.0) * pose;
        for (pair, meshes) in pairs.iter_mut().zip(meshes.windows(2)) {
            let query = Question::new(&meshes[0], &meshes[1], pose);
            pair.ask(&dispatcher, &query);
        }
        dispatcher.stats()
    };
    let first = step(0);
    assert!(
        first.internals.tree_builds == 0 && first.internals.walks == 99,
        "none may stay: {first:?}"
    );
    let second = step(1);
    assert!(
        (4..=14).contains(&second.internals.tree_builds) && second.internals.walks > 180,
        "{second:?}"
    );
    let last = (2..160).map(&mut step).last().unwrap();
    assert!(last.internals.tree_builds > 95, "queries earn what trees take: {last:?}");
    for (pair, meshes) in pairs.iter().zip(meshes.windows(2)) {
        let pose = Pose::translation(0.0, 0.03, 0.0) * pose;
        let query = Question::new(&meshes[0], &meshes[1], pose);
        assert_bits(&pair.manifolds, &query.fresh(&SbbkDispatcher::default()), "built later");
    }
}

/// Would catch a search over Parry's hierarchies that ends too soon or in the wrong frame.
#[test]
fn queries_without_trees_are_those_with_trees() {
    let (ring, head) = (large(TriMeshFlags::empty()), mesh::monkey_head().shape());
    let (walking, prepared) = (every(), every());
    let _trees = [&ring, &head].map(|shape| prepared.prepare_shape(shape).unwrap());
    let mut random = Rand32::new(6);
    let (mut crossing, mut apart) = (0, 0);
    for i in 0..120 {
        let from = rotation(&mut random) * Vec3::X;
        let pose = Pose3::from_parts(from * (0.3 + 0.03 * i as Real), rotation(&mut random));
        for is_flipped in [false, true] {
            let question = Question::new(&*ring, &*head, pose).flipped(is_flipped);
            let ([g1, g2], pos12) = (question.host_shapes(), question.pos12());
            let ask = |d: &SbbkDispatcher| {
                let closest = match d.closest_points(&pos12, g1, g2, 0.5).unwrap() {
                    ClosestPoints::Intersecting => -1.0,
                    ClosestPoints::WithinMargin(p1, p2) => (p1 - pos12 * p2).length(),
                    ClosestPoints::Disjoint => 9.0,
                };
                let contact = d.contact(&pos12, g1, g2, 0.5).unwrap();
                (
                    d.intersection_test(&pos12, g1, g2).unwrap().intersecting,
                    [d.distance(&pos12, g1, g2).unwrap().distance, closest],
                    contact.map(|contact| contact.dist),
                )
            };
            let [found, expected] = [&walking, &prepared].map(ask);
            assert_eq!((found.0, found.2.is_some()), (expected.0, expected.2.is_some()), "{i}");
            for (found, expected) in found.1.into_iter().zip(expected.1) {
                assert!((found - expected).abs() < 1e-6, "{i}: {found} for {expected}");
            }
            if let (Some(found), Some(expected)) = (found.2, expected.2) {
                assert!((found - expected).abs() < 1e-6, "{i}: {found} for {expected}");
            }
            *(if found.0 { &mut crossing } else { &mut apart }) += 1;
        }
    }
    assert!(crossing > 40 && apart > 40, "{crossing} crossing, {apart} apart");
    assert_eq!((walking.stats().trees, prepared.stats().trees), (0, 2));
    // Both casts are exact.
    let (velocity, options) = (-Vec3::X, ShapeCastOptions::with_max_time_of_impact(9.0));
    let pose = Pose3::from_parts(Vec3::new(4.0, 0.1, 1.4), Quat::IDENTITY);
    let casts = [&walking, &prepared]
        .map(|d| d.cast_shapes(&pose, velocity, &*ring, &*head, options).unwrap().unwrap());
    let [found, expected] = casts.map(|hit| hit.time_of_impact);
    assert!((found - expected).abs() < 1e-6, "{found} for {expected}");
}

/// Would catch a kind, a side or a neighbour that depends on a registration.
#[test]
fn large_meshes_have_the_contacts_of_registered_ones() {
    let cube = shape(&mesh::cuboid(Vec3::splat(0.5), 1));
    for cells in [40, 110] {
        let mut slab = mesh::cuboid(Vec3::new(2.0, 0.5, 2.0), cells);
        slab.triangles.swap_remove(0);
        let slab = slab.shape();
        let ground = slab.as_trimesh().unwrap();
        let is_large = [8192, 1 << 17].map(|limit| ground.num_triangles() > limit);
        assert_eq!(is_large, [true, cells > 100]);
        let (unaware, knowing) = (every(), every());
        let _tree = knowing.prepare_shape(&slab).unwrap().unwrap();
        assert_eq!(unaware.surface_kind(ground), knowing.surface_kind(ground));
        // Beside the slab, on it, sunk in, and across its rim.
        for place in [0.505, 0.49, 0.3]
            .map(|height| Vec3::new(0.1, 0.5 + height, 0.2))
            .into_iter()
            .chain([Vec3::new(2.2, 0.3, 0.2), Vec3::new(0.1, 0.0, 0.2)])
        {
            let turn = Quat::from_rotation_y(0.3);
            let query = Question::new(ground, &cube, Pose::from_parts(place, turn));
            let [found, expected] = [&unaware, &knowing].map(|of| query.fresh(of));
            assert_bits(&found, &expected, &format!("{cells} cells, {place}"));
        }
    }
}

/// Would catch unregistered large meshes that lock into each other, and memory in the result.
#[test]
fn large_meshes_are_solids_to_each_other() {
    let slab = mesh::cuboid(Vec3::new(2.0, 0.5, 2.0), 40).shape();
    let ground = slab.as_trimesh().unwrap();
    let (unaware, knowing) = (every(), every());
    let _tree = knowing.prepare_shape(&slab).unwrap().unwrap();
    let mut pair = Pair::default();
    for step in 0..12 {
        let turn = Quat::from_rotation_y(0.3 + 0.01 * step as Real);
        let sunk = Vec3::new(0.1, 0.99 - 0.004 * step as Real, 0.2);
        let query = Question::new(ground, ground, Pose::from_parts(sunk, turn));
        let expected = query.fresh(&knowing);
        assert!(!expected.is_empty());
        assert_bits(&query.fresh(&unaware), &expected, &format!("{step}"));
        assert_bits(&pair.ask(&unaware, &query).manifolds, &expected, &format!("{step}"));
    }
    assert_eq!((unaware.stats().solids, unaware.stats().trees), (1, 0));
}

/// Would catch surfaces that are looked for, which takes a hash of the mesh, before triangles
/// touch.
#[test]
fn meshes_that_touch_nothing_have_no_surface() {
    let (ball, dispatcher) = (shape(&mesh::ball(1.0, 12)), every());
    let corner = Pose::from_translation(1.3 * Vec3::ONE);
    assert!(Question::new(&ball, &ball, corner).fresh(&dispatcher).is_empty());
    assert_eq!(dispatcher.stats().solids, 0);
    let near = Pose::from_translation(1.99 * Vec3::X);
    assert!(!Question::new(&ball, &ball, near).fresh(&dispatcher).is_empty());
    assert_eq!(dispatcher.stats().solids, 1);
}
