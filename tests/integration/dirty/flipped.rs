use super::*;

/// Segments of the disc.
const SEGMENTS: u32 = 32;

/// A disc on a facet of its rim, with single triangles that are wound the other way. Would catch neighbours whose normals count
/// as outward ones: a corner of the facet has no contact.
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
