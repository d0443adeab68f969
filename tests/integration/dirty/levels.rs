use super::*;

/// Half the size of a slab of twelve triangles, whose top is at height 0, and of a body.
const SLAB: Vec3 = Vec3::new(8.0, 0.5, 8.0);
const BODY: f32 = 0.25;

/// Shares of the height of a part that are in the slab. At the first one rounding has lifted the
/// part, at the second it stands on the slab.
const SUNK: [f32; 7] = [-1.0e-4, 0.0, 0.1, 0.25, 0.36, 0.45, 0.6];

/// A mesh of a slab and of parts that are sunk into it by a share of their height.
fn level(parts: &[(Vec3, Vec3)], sunk: f32) -> Mesh {
    let slab = mesh::cuboid(SLAB, 1).mapped(|v| v - Vec3::Y * SLAB.y);
    let part = |&(half, place): &(Vec3, Vec3)| {
        let up = half.y * (1.0 - 2.0 * sunk);
        mesh::cuboid(half, 1).mapped(|v| v + place + Vec3::Y * up)
    };
    Mesh::merged("level", &[slab].into_iter().chain(parts.iter().map(part)).collect::<Vec<_>>())
}

/// A grid of places beside the crates of [`crates`].
fn places() -> impl Iterator<Item = Vec3> {
    let along = [-6.5, -4.5, -1.0, 1.0, 4.5, 6.5];
    along.into_iter().flat_map(move |x| along.map(|z| Vec3::new(x, 0.6, z)))
}

/// Crates on the middles of the triangles at the top of the slab.
fn crates() -> Vec<(Vec3, Vec3)> {
    let middle = SLAB.x / 3.0;
    let half = Vec3::new(0.8, 0.4, 0.8);
    let at = |x: f32, z: f32| (half, Vec3::new(middle * x, 0.0, middle * z));
    vec![at(1.0, 1.0), at(1.0, -1.0), at(-1.0, 1.0), at(-1.0, -1.0)]
}

/// Counts bodies that are lost: they have sunk into the slab, or are driven past the plane z = 0.
fn lost(level: &Mesh, body: &SharedShape, speed: f32, places: impl Iterator<Item = Vec3>) -> usize {
    let world = world(ColliderBuilder::new(level.shape()));
    let bodies = places.map(|place| {
        let start = RigidBodyBuilder::dynamic().translation(place).linvel(speed * Vec3::Z);
        (start, ColliderBuilder::new(body.clone()).friction(0.1))
    });
    let is_lost = |place: &&Vec3| place.y < 0.8 * BODY || speed > 0.0 && place.z > 0.0;
    settled(120, world, bodies).iter().filter(is_lost).count()
}

/// Would catch triangles that have no contacts where another part covers their middles alone.
#[test]
fn levels_of_boxes_hold_bodies() {
    let wall = [(Vec3::new(6.0, 1.25, 0.15), Vec3::ZERO)];
    let bodies = [
        ("mesh cube", mesh::cuboid(Vec3::splat(BODY), 2).shape()),
        ("cuboid", SharedShape::cuboid(BODY, BODY, BODY)),
    ];
    let mut cases = Vec::new();
    for (column, body) in bodies {
        for sunk in SUNK {
            let row = (-4..=4).map(|x| Vec3::new(x as f32, BODY + 0.01, -1.5));
            for (name, count) in [
                ("crates", lost(&level(&crates(), sunk), &body, 0.0, places())),
                ("a wall", lost(&level(&wall, sunk), &body, 3.0, row)),
            ] {
                let (row, shown) = (format!("{name} {sunk} sunk"), count.to_string());
                cases.push(Case { row, column, shown, is_right: count == 0 });
            }
        }
    }
    judge("bodies lost in a slab with parts on it", &cases, &[]);
}

/// Small pieces that fall by 1 to 4 units move by their own size a step. Some are within the floor
/// at the first query that meets it. Would catch a floor that is a room for them, a push-out to a
/// wall within, and the back of a face as a contact.
#[test]
fn debris_stays_on_floors_of_slabs() {
    let slab = |half: Vec3, place: Vec3| mesh::cuboid(half, 1).mapped(|v| v + place);
    let one = slab(Vec3::new(10.0, 0.25, 5.0), -0.25 * Vec3::Y);
    let of_eight = (0..8).map(|i| {
        let place = Vec3::new(5.0 * (i % 4) as f32 - 7.5, -0.25, 5.0 * (i / 4) as f32 - 2.5);
        slab(Vec3::new(2.55, 0.25, 2.55), place)
    });
    let eight = Mesh::merged("eight", &of_eight.collect::<Vec<_>>());
    for (floor, seed) in [&one, &eight].into_iter().flat_map(|floor| [(floor, 1), (floor, 2)]) {
        let mut random = Rand32::new(seed);
        let mut within = |low: f32, high: f32| low + (high - low) * random.rand_float();
        let pieces: Vec<_> = (0..20)
            .map(|_| {
                let half = Vec3::from_array([(); 3].map(|()| within(0.03, 0.08)));
                ColliderBuilder::new(mesh::cuboid(half, 1).shape())
            })
            .collect();
        let bodies = (0..300).map(|i| {
            let place = Vec3::new(within(2.0, 8.0), 1.0 + 0.01 * i as f32, within(-4.0, 1.0));
            let turn = Vec3::from_array([(); 3].map(|()| within(-3.0, 3.0)));
            let body = RigidBodyBuilder::dynamic().translation(place).rotation(turn);
            (body, pieces[i % 20].clone())
        });
        let world = world(ColliderBuilder::new(floor.shape()));
        let lost = settled(240, world, bodies).iter().filter(|place| place.y < -0.05).count();
        assert_eq!(lost, 0, "of 300 pieces on {}, seed {seed}", floor.name);
    }
}
