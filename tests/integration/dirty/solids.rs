use super::*;
use sbbk_testkit::mesh::uneven_box;

/// Half the size of a box; its top is at height 1.
const HALF: Vec3 = Vec3::new(2.0, 1.0, 2.0);

/// Closed meshes, and the heights between which the lowest point of a body on them is right.
fn solids() -> Vec<(&'static str, Mesh, [f32; 2])> {
    let flat = [0.97, 1.02];
    let even = mesh::cuboid(HALF, 4);
    let aside = Vec3::X * 8.0;
    let larger = mesh::turned_inside_out(mesh::cuboid(1.5 * HALF, 4)).mapped(|v| v + aside);
    let overlapping = [-1.0, 1.0]
        .map(|x| mesh::cuboid(Vec3::new(1.3, 1.0, 2.0), 3).mapped(|v| v + Vec3::X * 0.7 * x));
    let terrain = mesh::terrain(4.0, 16, 0.05).mapped(|v| v + Vec3::Y);
    let uneven = uneven_box(HALF, [4, 4, 5, 4, 4, 4]);
    vec![
        ("even box", even.clone(), flat),
        ("top of 5 cells, others 4", uneven.clone(), flat),
        ("one side of 1 cell", uneven_box(HALF, [1, 4, 4, 4, 4, 4]), flat),
        ("six unlike sides", uneven_box(HALF, [5, 2, 7, 1, 3, 4]), flat),
        ("uneven, turned", uneven.posed(&glamx::Pose3::rotation(Vec3::Y * 0.5)), flat),
        ("terrain with a skirt", mesh::skirted(&terrain, -1.0), [0.9, 1.1]),
        ("box with a wall", mesh::walled_box(HALF, 2), flat),
        ("beside a larger, turned one", Mesh::merged("boxes", &[even.clone(), larger]), flat),
        ("two that overlap", Mesh::merged("overlapping", &overlapping), flat),
        ("soup, 0.1 mm apart", mesh::unwelded(&even, 0.5e-4, 1), flat),
        ("each third twice", mesh::doubled(&even, 3), flat),
        ("slivers", mesh::with_slivers(&even, 3), flat),
        ("turned cells", mesh::turned_near(&even, Vec3::Y, 0.8), flat),
    ]
}

/// Meshes, and heights of their middles at the start.
fn bodies() -> [(&'static str, Mesh, f32); 4] {
    let ring = mesh::torus(0.5, 0.1, 24, 12);
    let cube = mesh::cuboid(Vec3::splat(0.25), 2);
    [
        ("ring 2/3 sunk", ring, 1.1 - 0.2 * 2.0 / 3.0),
        ("cube 2/3 sunk", cube.clone(), 1.25 - 0.5 * 2.0 / 3.0),
        ("declared inside", cube.clone(), 0.4),
        ("cube dropped", cube, 1.5),
    ]
}

/// Would catch closed meshes taken for sheets: they hold bodies that have sunk in.
#[test]
fn closed_meshes_push_out_what_has_sunk_in() {
    let mut cases = Vec::new();
    for (flags, (name, solid, [low, high])) in with_flags(solids()) {
        let solid = ColliderBuilder::new(solid.shape_with(flags));
        for (column, body, height) in bodies() {
            let dispatcher = SbbkDispatcher::default();
            let mesh = solid.shape.as_trimesh().expect("a mesh");
            let _declared =
                column.starts_with("declared").then(|| declare_solid(&dispatcher, mesh));
            let world = world_of([solid.clone()], dispatcher);
            let place = Vec3::new(0.23, height, 0.11);
            let turn = Quat::from_rotation_y(0.4).to_scaled_axis();
            let start = RigidBodyBuilder::dynamic().translation(place).rotation(turn);
            let end = after(240, world, start, ColliderBuilder::new(body.shape_with(flags)));
            let lowest = lowest(&body, end.position());
            let is_right = (low..high).contains(&lowest);
            cases.push(Case::new(name, flags, column, format!("{lowest:.2}"), is_right));
        }
    }
    judge("lowest point of a body in a solid with its top at 1, after 4 s", &cases, &[]);
}

/// Vessels of radius 1, open above.
fn vessels() -> Vec<(&'static str, Mesh)> {
    let open_box = uneven_box(Vec3::ONE, [4; 6]);
    let open_box = open_box.keeping(|corners| corners.iter().any(|corner| corner.y < 0.99));
    let tube = mesh::tube(1.0, 2.0, 32);
    let wall = mesh::vessel(1.0, 12, 0.0);
    let inner = mesh::turned_inside_out(wall.clone().scaled(0.9));
    vec![
        ("bowl of 60 degrees", mesh::vessel(1.0, 12, -0.5)),
        ("bowl of 90 degrees", wall.clone()),
        ("bowl of 120 degrees", mesh::vessel(1.0, 12, 0.5)),
        ("two-sided bowl", mesh::two_sided(&wall)),
        ("bowl of two walls", Mesh::merged("walls", &[wall, inner])),
        ("box without a top", open_box),
        ("open tube", tube),
    ]
}

/// Would catch vessels that are taken for solids, and lose or push out what lies in them.
#[test]
fn vessels_hold_what_lies_in_them() {
    let mut cases = Vec::new();
    for (flags, (name, vessel)) in with_flags(vessels()) {
        let ground = vessel.shape_with(flags);
        for (column, body) in
            [("mesh ball", mesh::ball(0.2, 6)), ("mesh cube", mesh::cuboid(Vec3::splat(0.15), 2))]
        {
            let start = RigidBodyBuilder::dynamic().translation(Vec3::new(0.05, -0.6, 0.02));
            let height = end(180, &ground, start, &body.shape_with(flags)).y;
            let is_right = (-0.9..-0.6).contains(&height);
            cases.push(Case::new(name, flags, column, format!("{height:.2}"), is_right));
        }
    }
    judge("height of a body in a vessel of radius 1, after 3 s", &cases, &[]);
}

/// Hollow boxes whose walls are thinner than Rapier lets bodies sink in. Would catch contacts of
/// the inner sides of two walls, which hold the boxes in each other and shake them.
#[test]
fn piles_of_hollow_boxes_come_to_rest() {
    let hollow = |half: Vec3| {
        let outer = mesh::cuboid(half, 3);
        let inner = mesh::turned_inside_out(outer.clone().scaled(0.99));
        Mesh::merged("hollow", &[outer, inner]).shape()
    };
    let shapes = [hollow(Vec3::splat(0.4)), hollow(Vec3::new(0.7, 0.12, 0.3))];
    let mut awake = 0;
    for seed in 0..4 {
        let mut random = Rand32::new(seed);
        let mut world = world(ColliderBuilder::cuboid(4.0, 1.0, 4.0).translation(-Vec3::Y));
        for side in [Vec3::X, -Vec3::X, Vec3::Z, -Vec3::Z] {
            let half = Vec3::new(0.5, 3.0, 0.5) + 3.5 * (Vec3::ONE - side.abs() - Vec3::Y);
            let wall = ColliderBuilder::cuboid(half.x, half.y, half.z);
            world.insert(RigidBodyBuilder::fixed().translation(3.5 * side + 3.0 * Vec3::Y), wall);
        }
        let bodies = (0..20).map(|i| {
            let mut within = |most: f32| most * (2.0 * random.rand_float() - 1.0);
            let place = Vec3::new(within(1.8), 1.0 + 0.45 * i as f32, within(1.8));
            let turn = Vec3::new(within(1.5), within(1.5), within(1.5));
            let body = RigidBodyBuilder::dynamic().translation(place).rotation(turn);
            (body, ColliderBuilder::new(shapes[i % 2].clone()).mass(1.0))
        });
        let mut bodies = SceneWorld::new(world, bodies);
        bodies.step(900);
        awake += bodies.awake();
    }
    assert!(awake <= 4, "{awake} of 80 boxes are awake after 15 s");
}
