use crate::prelude::*;

/// Would catch a bound of the motion by the ball of the large mesh, which a rocking body exceeds in
/// each step.
#[test]
fn candidates_are_reused_whichever_mesh_comes_first() {
    let ground = shape(&mesh::floor(200.0, 40));
    let cube = shape(&mesh::cuboid(Vec3::splat(0.5), 4));
    let reused = [false, true].map(|flipped| {
        let dispatcher = every();
        let mut pair: Pair = Pair::default();
        for i in 0..200 {
            let turn = Quat::from_rotation_x(5e-4 * (0.3 * i as Real).sin());
            let pose = Pose::from_parts(Vector::new(30.0, 0.5, 30.0), turn);
            pair.ask(&dispatcher, &Question::new(&ground, &cube, pose).flipped(flipped));
        }
        dispatcher.stats().internals.reused_queries
    });
    assert!(reused.iter().all(|&count| count > 150), "{reused:?}");
    assert!(reused[0].abs_diff(reused[1]) < 10, "{reused:?}");
}

/// Would catch a panic where Parry has deleted all triangles of a mesh.
#[test]
fn meshes_without_triangles_touch_nothing() {
    let head = shape(&mesh::monkey_head_with(6));
    let flags = TriMeshFlags::DELETE_DEGENERATE_TRIANGLES | TriMeshFlags::MERGE_DUPLICATE_VERTICES;
    let empty = TriMesh::with_flags(vec![Vector::ZERO; 3], vec![[0, 1, 2]], flags).unwrap();
    assert!(empty.indices().is_empty());
    let dispatcher = every();
    for [one, two] in [[&empty, &empty], [&empty, &head], [&head, &empty]] {
        let mut pair: Pair = Pair::default();
        for x in [0.0, 0.1] {
            pair.ask(&dispatcher, &Question::new(one, two, Pose::translation(x, 0.0, 0.0)));
            assert!(pair.manifolds.is_empty());
        }
    }
    assert_eq!(dispatcher.stats().unsupported_queries, 6);
}

/// A mark of the place of a point on the ground.
fn mark<C>(point: &TrackedContact<C>) -> i32 {
    let round = |x: Real| (1e3 * x).round() as i32;
    100_000 * (round(point.local_p1.x) + 5000) + round(point.local_p1.z) + 5000
}

/// Patches of far contacts and the contacts of each two triangles in turn, as soft CCD varies the
/// prediction distance. Would catch data that goes to the points of another triangle.
#[test]
fn points_keep_their_own_data_where_far_and_near_steps_alternate() {
    let ground = shape(&mesh::floor(4.0, 8));
    let cube = shape(&mesh::cuboid(Vec3::splat(0.5), 2));
    let dispatcher = every();
    let mut pair = Pair::<(), i32>::default();
    let mut kept = BTreeMap::new();
    for step in 0..12 {
        let (prediction, gap) = if step % 2 == 0 { (0.1, 0.05) } else { (0.6, 0.2) };
        let pose = Pose::translation(0.1, 0.5 + gap, 0.2);
        pair.ask(&dispatcher, &Question::new(&ground, &cube, pose).within(prediction));
        assert!(!pair.manifolds.is_empty());
        for point in pair.manifolds.iter_mut().flat_map(|manifold| &mut manifold.points) {
            let own = mark(point);
            assert!([0, own].contains(&point.data), "step {step}: {point:?} is {own}");
            *kept.entry(step % 2).or_insert(0) += i32::from(point.data == own);
            point.data = own;
        }
    }
    assert!(kept.len() == 2 && kept.values().all(|&count| count >= 12), "{kept:?}");
}

/// Would catch data lost because the push-out is written to triangles that are near each other as
/// well.
#[test]
fn the_push_out_keeps_its_data_where_a_host_changes_the_list() {
    let outer = shape(&mesh::cuboid(Vec3::splat(0.5), 1));
    let inner = shape(&mesh::cuboid(Vec3::splat(0.1), 1));
    for axis in [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z] {
        let dispatcher = every();
        let _solid = declare_solid(&dispatcher, &outer);
        let mut pair = Pair::<u32, ()>::default();
        let question = |depth: Real| {
            let pose = Pose::from_translation((0.4 - depth) * axis);
            Question::new(&outer, &inner, pose)
        };
        pair.ask(&dispatcher, &question(0.025));
        assert_eq!(pair.manifolds.len(), 1);
        pair.manifolds[0].data = 7;
        pair.ask(&dispatcher, &question(0.0251));
        let copy = pair.manifolds[0].clone();
        pair.manifolds.push(copy);
        pair.ask(&dispatcher, &question(0.0252));
        assert_eq!(pair.manifolds.iter().map(|m| m.data).collect::<Vec<_>>(), [7], "{axis}");
    }
}
