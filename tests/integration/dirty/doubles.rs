use super::*;

/// The mesh with all its triangles a number of times.
fn repeated(mesh: &Mesh, times: usize) -> Mesh {
    Mesh::new(mesh.name.clone(), mesh.vertices.clone(), mesh.triangles.repeat(times))
}

/// Asks for the contacts of two meshes with themselves, three times. Panics if they differ.
fn check(meshes: [&TriMesh; 2], random: &mut Rand32, depth: f32) -> usize {
    let (dispatchers, mut pairs) =
        ([0, 1].map(|_| every()), [0, 1].map(|_| Pair::<(), ()>::default()));
    let pose = touching(random, [meshes[0]; 2], depth);
    // The first query descends Parry's BVHs, the others descend trees.
    for _ in 0..3 {
        for i in 0..2 {
            pairs[i].ask(&dispatchers[i], &Question::new(meshes[i], meshes[i], pose));
        }
        let [of_clean, of_doubled] = pairs.each_ref().map(|pair| &pair.manifolds);
        assert_same(of_clean, of_doubled, 0.0);
    }
    pairs[0].manifolds.len()
}

/// Would catch doubles with contacts, and doubles that hide the neighbours of a triangle.
#[test]
fn doubles_change_no_contact() {
    let (mut random, mut contacts) = (Rand32::new(5), 0);
    for clean in [mesh::torus(0.5, 0.2, 24, 12), mesh::cuboid(Vec3::new(0.5, 0.4, 0.3), 4)] {
        for times in [2, 3] {
            let [clean, doubled] = [&clean, &repeated(&clean, times)].map(shape);
            for depth in [-0.01, 0.002, 0.02, 0.1].repeat(8) {
                contacts += check([&clean, &doubled], &mut random, depth);
            }
        }
    }
    assert!(contacts > 500, "{contacts}");
}

/// Balls that fall at 6 m/s on a floor with triangles for either side. Would catch a side that is preferred, as its triangles come
/// first.
#[test]
fn fast_bodies_stay_above_two_sided_floors() {
    let [up, down] = [mesh::floor(6.0, 2), mesh::turned_inside_out(mesh::floor(6.0, 2))];
    let ball = mesh::ball(0.15, 8).shape();
    let mut random = Rand32::new(2);
    for floor in [[up.clone(), down.clone()], [down, up]] {
        let floor = Mesh::merged("floor", &floor).shape();
        for i in 0..100 {
            let start = Vec3::new(0.3, 0.3 + 0.001 * i as f32, 0.2);
            let pose = Pose3::from_parts(start, rotation(&mut random));
            let moving = RigidBodyBuilder::dynamic().pose(pose).linvel(-6.0 * Vec3::Y);
            let end = end(60, &floor, moving, &ball);
            assert!(end.y > 0.0, "the ball from {start} is at {end}");
        }
    }
}
