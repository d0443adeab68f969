//! Bodies wholly inside a solid, where no triangles are near each other. They stay, unless a user
//! declares the solid.

use crate::prelude::*;

const HALF: Vec3 = Vec3::new(2.0, 1.0, 2.0);

/// Would catch a body that stays inside, leaves by the far side, turns on its way, or depends on
/// the order or on the number of triangles.
#[test]
fn a_body_in_a_solid_leaves_by_the_nearer_side() {
    let bodies =
        [mesh::cuboid(Vec3::splat(0.2), 2), mesh::monkey_head_with(6).centred().scaled_to(0.4)];
    for (cells, body) in [1, 9].into_iter().flat_map(|cells| bodies.iter().map(move |b| (cells, b)))
    {
        let (slab, body) = (shape(&mesh::cuboid(HALF, cells)), shape(body));
        for detail in [ContactDetail::Every, ContactDetail::Patches] {
            let dispatcher = with(|config| config.detail = detail);
            let _solid = declare_solid(&dispatcher, &slab);
            for (place, out, depth) in [
                ([0.2, 0.3, 0.1], Vector::Y, 0.7),
                ([0.2, -0.3, 0.1], -Vector::Y, 0.7),
                ([1.6, 0.1, -0.3], Vector::X, 0.4),
                ([0.1, 0.2, -1.5], -Vector::Z, 0.5),
            ] {
                let turn = Quat::from_rotation_x(0.7);
                let pose = Pose::from_parts(Vec3::from_array(place), turn);
                let query = Question::new(&slab, &body, pose);
                for query in [query, query.flipped(true)] {
                    let found = query.fresh(&dispatcher);
                    let [manifold] = &found[..] else { panic!("{} manifolds", found.len()) };
                    assert!(dispatcher.stats().push_outs > 0);
                    let [normal, _] = query.host_order([manifold.local_n1, manifold.local_n2]);
                    assert!((normal - out).length() < 1e-3, "{normal} at {place:?}");
                    // Contacts have a greatest depth.
                    let [root1, root2] =
                        query.meshes().map(|mesh| mesh.local_aabb().half_extents());
                    let most =
                        (0.1 * root1.length().min(root2.length())).max(4.0 * query.prediction);
                    assert!((distance(manifold) + most.min(depth)).abs() < 1e-3);
                    let [point] = &manifold.points[..] else { panic!("one point") };
                    let [_, at] = query.host_order([point.local_p1, point.local_p2]);
                    assert!((at - body.local_aabb().center()).length() < 1e-4, "{at}");
                }
            }
        }
    }
}

/// Would catch bodies pushed out of a hollow, a sheet, a soft mesh, or a large room.
#[test]
fn bodies_in_no_solid_are_not_pushed_out() {
    let body = shape(&mesh::cuboid(Vec3::splat(0.2), 1));
    let default = SbbkDispatcher::default();
    let hollow = [mesh::cuboid(HALF, 3), turned_inside_out(mesh::cuboid(0.85 * HALF, 3))];
    let hollow = shape(&Mesh::merged("hollow", &hollow));
    let inverted = shape(&turned_inside_out(mesh::cuboid(HALF, 2)));
    let bowl = shape(&mesh::terrain(4.0, 10, 2.0));
    let large = shape(&mesh::cuboid(HALF, 40));
    let soft = mesh::cuboid(HALF, 2).trimesh(TriMeshFlags::DEFORMABLE);
    for mesh in [&hollow, &inverted, &bowl, &large, &soft] {
        let mut random = Rand32::new(30);
        for _ in 0..30 {
            let place = 0.5 * Vec3::new(random.rand_float() - 0.5, 0.0, random.rand_float() - 0.5);
            let place = place + 0.4 * (random.rand_float() - 0.5) * Vec3::Y;
            let query = Question::new(mesh, &body, Pose::from_parts(place, Quat::IDENTITY));
            assert!(query.fresh(&default).len() <= query.fresh(&per_triangle()).len());
        }
    }
    // In its wall it is pushed out.
    let small = shape(&mesh::cuboid(Vec3::splat(0.1), 1));
    let in_wall = Question::new(&hollow, &small, Pose::translation(1.86, 0.0, 0.0));
    let in_wall = in_wall.fresh(&default);
    assert!(in_wall.len() == 1 && in_wall[0].local_n1 == Vector::X);
    let dispatcher = every();
    let _solid = declare_solid(&dispatcher, &large);
    let query = Question::new(&large, &body, Pose::translation(0.3, 0.5, 0.0));
    assert_eq!(query.fresh(&dispatcher).len(), 1);
}

/// A walk in and out of a solid, of bodies that are small beside their steps and beside what a
/// descent looks ahead. Would catch a body remembered as inside or outside.
#[test]
fn push_out_does_not_depend_on_earlier_poses() {
    let slab = shape(&mesh::cuboid(HALF, 4));
    let [kept, unaware] = [every(), every()];
    let _solids = [&kept, &unaware].map(|dispatcher| declare_solid(dispatcher, &slab));
    let [mut inside, mut none] = [0; 2];
    for size in [0.005, 0.05, 0.5] {
        let body = shape(&mesh::ball(size, 2));
        let mut random = Rand32::new(31);
        for prediction in [0.002, 0.2] {
            let mut pair: Pair = Pair::default();
            let mut pose = Pose::translation(0.1, 0.9, 0.2);
            for step in 0..1200 {
                let stride = [0.0, 0.001, 0.01, 0.1][step % 4];
                pose = nudge(&mut random, stride) * pose;
                if slab.local_aabb().distance_to_local_point(pose.translation, true) > 0.3 {
                    pose = Pose::translation(0.1, 0.9, 0.2);
                }
                let query = Question::new(&slab, &body, pose).within(prediction);
                let expected = query.fresh(&unaware);
                assert_same(&pair.ask(&kept, &query).manifolds, &expected, 0.0);
                inside += usize::from(expected.len() == 1 && distance(&expected[0]) < 0.0);
                none += usize::from(expected.is_empty());
            }
        }
    }
    let reused = kept.stats().internals.reused_queries;
    assert!(inside > 300 && none > 100 && reused > 100, "{inside} {none} {reused}");
}

/// Would catch a body that starts in a declared solid and falls through, is thrown out, or stops at
/// the surface.
#[test]
fn a_body_that_starts_in_a_solid_comes_out_slowly() {
    let ground = Vec3::new(5.0, 1.0, 5.0);
    for (half, depth, cells) in
        [(0.25, 0.95, 1), (0.25, 0.95, 6), (0.5, 0.22, 8), (0.5, 0.83, 8), (0.5, 0.95, 8)]
    {
        let solid = |half_extents: Vec3| mesh::cuboid(half_extents, cells).shape();
        let (dispatcher, slab) = (SbbkDispatcher::default(), solid(ground));
        let _solid = declare_solid(&dispatcher, slab.as_trimesh().expect("a mesh"));
        let slab = ColliderBuilder::new(slab).translation(-ground.y * Vec3::Y);
        let world = world_of([slab], dispatcher);
        let at = RigidBodyBuilder::dynamic().translation(Vec3::new(0.2, half - depth, 0.1));
        let mut fastest: Real = 0.0;
        let look = |body: &RigidBody| fastest = fastest.max(body.linvel().length());
        let body = ColliderBuilder::new(solid(Vec3::splat(half)));
        let height = watched(240, world, at, body, look).translation().y - half;
        assert!(height.abs() < 0.01 && fastest < 5.0, "{height} {fastest} from {depth}");
    }
}
