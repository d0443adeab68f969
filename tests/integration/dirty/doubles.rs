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

/// Balls that fall at 6 m/s on a floor with triangles for either side. Would catch a side that is
/// preferred, as its triangles come first.
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

/// Tilted plates of 2 to 10 cm with soft CCD, that fall at 10 m/s on a floor whose triangles are
/// wound by chance. Would catch plates that are pushed to the front of the triangle below them.
#[test]
fn fast_plates_stay_above_floors_of_any_winding() {
    let mut random = Rand32::new(7);
    let mut lost = 0;
    for seed in 0..20 {
        let floor = mesh::random_winding(&mesh::floor(6.0, 5 + seed as u32), seed).shape();
        for _ in 0..20 {
            let mut within = |low: Real, high: Real| low + (high - low) * random.rand_float();
            let plate = mesh::cuboid(Vec3::new(0.5, within(0.01, 0.05), 0.4), 3).shape();
            let turn = Quat::from_rotation_y(within(0.0, TAU));
            let turn = turn * Quat::from_rotation_x(within(-0.6, 0.6));
            let place = Vec3::new(within(-1.5, 1.5), within(1.0, 1.5), within(-1.5, 1.5));
            let velocity = 10.0 * Vec3::new(within(-0.3, 0.3), -1.0, within(-0.3, 0.3));
            let moving = RigidBodyBuilder::dynamic().pose(Pose::from_parts(place, turn));
            let moving = moving.linvel(velocity).soft_ccd_prediction(0.3);
            lost += usize::from(end(60, &floor, moving, &plate).y < -0.05);
        }
    }
    println!("{lost} of 400 plates");
    assert!(lost == 0, "{lost} of 400");
}

/// Segments of the disc.
const SEGMENTS: u32 = 32;

/// A disc on a facet of its rim, with single triangles that are wound the other way. Would catch
/// neighbours whose normals count as outward ones: a corner of the facet has no contact.
#[test]
fn flipped_triangles_carry_as_others_do() {
    let profile = [[0.0, -0.1], [0.5, -0.1], [0.5, 0.1], [0.0, 0.1]];
    let disc = mesh::revolved(&profile.map(Vec2::from), SEGMENTS);
    let grounds = [1, 40].map(|cells| mesh::slab(Vec3::new(10.0, 0.5, 10.0), [cells, 1, cells]));
    let grounds = grounds.map(|ground| ground.shape());
    let every = every();
    let width = 0.5 * (0.5 * TAU / SEGMENTS as Real).sin();
    let mut random = Rand32::new(3);
    for round in 0..200 {
        let mut flipped = disc.clone();
        for triangle in &mut flipped.triangles {
            if random.rand_float() < 0.03 {
                triangle.swap(1, 2);
            }
        }
        let facet = TAU / SEGMENTS as Real * (random.rand_range(0..SEGMENTS) as Real + 0.5);
        let mut within = |size: Real| size * (2.0 * random.rand_float() - 1.0);
        let upright = Quat::from_rotation_x(FRAC_PI_2) * Quat::from_rotation_y(facet);
        let turn = Quat::from_rotation_y(within(3.0)) * upright;
        let height = 0.5 + 0.5 * (0.5 * TAU / SEGMENTS as Real).cos();
        let place = Vec3::new(within(3.0), height - 0.0007 + within(0.0005), within(3.0));
        let pose = Pose::from_parts(place, turn);
        let [axis, across] = [0.1 * (turn * Vec3::Y), width * (turn * Vec3::Y).cross(Vec3::Y)];
        let corners = [axis + across, axis - across, -axis + across, -axis - across];
        for (name, body) in [("disc", &disc), ("flipped disc", &flipped)] {
            let body = body.shape();
            let found = Question::new(&*grounds[round % 2].0, &*body.0, pose).fresh(&every);
            let up = found.iter().filter(|manifold| manifold.local_n1.y > 0.9);
            let places: Vec<Vec3> =
                up.flat_map(|m| &m.points).map(|point| point.local_p1 - place).collect();
            let has = |corner: &Vec3| {
                places.iter().any(|place| (place - corner).with_y(0.0).length() < 0.005)
            };
            assert!(corners.iter().all(has), "round {round}, {name}: {places:?}");
        }
    }
}

/// Cubes that are sunk a little in the narrow side of a slab. Up to 3 % of the triangles of either
/// mesh are wound the other way. Would catch contacts far along the wall, of triangles that know no
/// way out of it.
#[test]
fn cubes_in_a_narrow_side_have_no_contact_along_it() {
    let (every, mut random) = (every(), Rand32::new(1));
    let (mut count, mut deep) = (0, 0);
    for round in 0..4000 {
        let mut within = |low: Real, high: Real| low + (high - low) * random.rand_float();
        let half = Vec3::from_array([(); 3].map(|()| within(0.3, 1.0)));
        let sunk = 3e-4 * 67.0_f32.powf(within(0.0, 1.0));
        let beside = Vec3::new(1.5 - sunk, within(-0.3, 0.3), within(-1.5, 1.5));
        let place = beside + half * Vec3::new(1.0, within(-1.0, 1.0), within(-1.0, 1.0));
        let turn = if round % 3 == 0 { within(-PI, PI) } else { 0.0 };
        let turn = Quat::from_rotation_x(turn);
        let mut slab = mesh::cuboid(Vec3::new(1.5, 0.3, 1.5), 1 + random.rand_range(0..12));
        let mut cube = mesh::cuboid(half, 1 + random.rand_range(0..4));
        let turned = if round % 2 == 0 { &mut slab } else { &mut cube };
        let last = turned.triangles.len() as u32;
        let share = last * (round as u32 / 2 % 4) / 100;
        (0..share).for_each(|_| turned.triangles[random.rand_range(0..last) as usize].swap(1, 2));
        let pose = Pose::from_parts(place, turn);
        let [slab, cube] = [slab, cube].map(|of| of.shape());
        let found = Question::new(&*slab.0, &*cube.0, pose).fresh(&every);
        let deepest = found.iter().map(distance).fold(0.0, Real::min);
        deep += u32::from(deepest < -3.0 * sunk - 0.01);
        count += u32::from(deepest < 0.0);
    }
    println!("{deep} of {count} too deep");
    assert!(count > 2000 && deep == 0, "{deep} of {count}");
}
