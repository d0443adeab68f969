use super::rides::Course;
use super::*;

/// Side of a floor, in units; all paths are shorter than 12.
const SIZE: f32 = 16.0;

/// Floors at height 0 that are flat for a body on them.
fn floors() -> Vec<(&'static str, Vec<Mesh>)> {
    let plain = mesh::floor(SIZE, 32);
    let strips = mesh::strips(SIZE, 8, 1);
    let turned = strips.clone().posed(&Pose3::from_rotation(Quat::from_rotation_y(0.3)));
    let half_extents = Vec3::new(0.5 * SIZE, 1.0, 0.5 * SIZE);
    let below = |mesh: Mesh| mesh.mapped(|v| v - Vec3::Y);
    let tiles = mesh::tiles(SIZE, 16, 1.0);
    let floors = vec![
        ("unregistered, 12,800", mesh::floor(2.5 * SIZE, 80)),
        ("two triangles", mesh::floor(SIZE, 1)),
        ("plain", plain.clone()),
        ("soup", mesh::unwelded(&plain, 0.0, 2)),
        ("soup, 0.01 mm apart", mesh::unwelded(&plain, 0.5e-5, 3)),
        ("soup, 0.1 mm apart", mesh::unwelded(&plain, 0.5e-4, 3)),
        ("T-junctions", strips),
        ("T-junctions, turned", turned),
        ("each third twice", mesh::doubled(&plain, 3)),
        ("slivers", mesh::with_slivers(&plain, 5)),
        ("two-sided", mesh::two_sided(&plain)),
        ("random winding", mesh::random_winding(&plain, 4)),
        ("box tiles", tiles.clone()),
        ("box tiles, welded", tiles.welded()),
        ("uneven box", below(mesh::uneven_box(half_extents, [7, 4, 16, 1, 5, 3]))),
        ("box with a wall", below(mesh::walled_box(half_extents, 8))),
        ("skirted", mesh::skirted(&plain, -1.0)),
        ("skirted, turned cells", mesh::turned_near(&mesh::skirted(&plain, -1.0), Vec3::ZERO, 1.5)),
    ];
    floors.into_iter().map(|(name, floor)| (name, vec![floor])).collect()
}

/// Would catch contacts at edges that a floor does not have for a body on it.
#[test]
fn bodies_ride_on_dirty_floors_as_on_a_cuboid() {
    const COURSE: Course = Course { speed: 5.0, steps: 180 };
    COURSE.judge("share of the path on a cuboid, and added speed upwards", &floors(), &[]);
}

/// Cubes of 5 cm on triangles as long as they are, at Rapier's default length unit. Would catch
/// contacts with triangles ahead, within the prediction distance.
#[test]
fn small_cubes_slide_at_the_default_unit_as_on_a_cuboid() {
    const HALF: f32 = 0.025;
    let cuboid = ColliderBuilder::cuboid(1.0, 0.1, 1.0).translation(-0.1 * Vec3::Y);
    let floor = mesh::floor(2.0, 40).shape();
    let cube = mesh::cuboid(Vec3::splat(HALF), 2).shape();
    let path = |ground: &ColliderBuilder, shape: &SharedShape, angle: f32| {
        let heading = Quat::from_rotation_y(angle);
        let start = heading * Vec3::new(-0.5, 0.0, 0.0) + (HALF + 1e-4) * Vec3::Y;
        let turn = Quat::from_rotation_y(3.0 * angle);
        let body = RigidBodyBuilder::dynamic().pose(Pose3::from_parts(start, turn));
        let body = body.linvel(heading * Vec3::X).can_sleep(false);
        let collider = ColliderBuilder::new(shape.clone()).friction(0.1).density(1000.0);
        let end = after(90, world(ground.clone().friction(0.1)), body, collider).translation();
        (end - start).dot(heading * Vec3::X)
    };
    for i in 0..8 {
        let angle = 0.7 * i as f32;
        let right = path(&cuboid, &SharedShape::cuboid(HALF, HALF, HALF), angle);
        let share = path(&ColliderBuilder::new(floor.clone()), &cube, angle) / right;
        assert!((share - 1.0).abs() < 0.03, "{share} of {right}, at {angle}");
    }
}

/// Hollow cubes, whose walls are thinner than a prediction distance. Would catch contacts with the
/// inner sides of walls.
#[test]
fn hollow_cubes_slide_on_sheets_as_cuboids() {
    const HALF: f32 = 0.4;
    let cube = mesh::cuboid(Vec3::splat(HALF), 4);
    let path = |shape: SharedShape| {
        let start = Vec3::new(-5.0, HALF, -3.0);
        let body = RigidBodyBuilder::dynamic().translation(start).linvel(5.0 * Vec3::X);
        let floor = ColliderBuilder::new(mesh::floor(SIZE, 32).shape()).friction(0.2);
        let collider = ColliderBuilder::new(shape).friction(0.2).mass(1.0);
        (after(180, world(floor), body, collider).translation() - start).x
    };
    let right = path(cube.clone().shape());
    for share in [0.99, 0.98, 0.95] {
        let inner = mesh::turned_inside_out(cube.clone().scaled(share));
        let hollow = Mesh::merged("hollow", &[cube.clone(), inner]);
        let share = path(hollow.shape()) / right;
        assert!((share - 1.0).abs() < 0.01, "{share} of {right}");
    }
}

/// Half extents of the boxes.
const HALVES: Vec3 = Vec3::new(0.3, 0.2, 0.4);

/// Slides a box with a contact skin. Returns its way, and how far its middle and its upright axis
/// are off.
fn slide(ground: SharedShape, shape: SharedShape, skin: Real, turn: Real) -> [Real; 3] {
    let collider = |shape| ColliderBuilder::new(shape).friction(0.3);
    let world = world(collider(ground));
    let height = HALVES.y + skin;
    let start = Vec3::new(-10.0, height + 0.002, 0.0);
    let body = RigidBodyBuilder::dynamic().translation(start).rotation(turn * Vec3::Y);
    let collider = collider(shape).contact_skin(skin).density(1.0);
    let body = after(200, world, body.linvel(6.0 * Vec3::X), collider);
    let up = *body.rotation() * Vec3::Y;
    [body.translation().x + 10.0, (body.translation().y - height).abs(), 1.0 - up.y]
}

/// Would catch ghost contacts of bodies on a contact skin. Skins of more than a tenth of the body's
/// radius leave no contact near.
#[test]
fn boxes_with_a_contact_skin_slide_as_cuboids_do() {
    let cuboid = SharedShape::cuboid(HALVES.x, HALVES.y, HALVES.z);
    let slab = mesh::slab(Vec3::new(20.0, 1.0, 20.0), [37, 1, 37]).mapped(|v| v - Vec3::Y);
    let grounds = [mesh::floor(40.0, 37), slab].map(|mesh| mesh.shape());
    let flat = SharedShape::halfspace(Vec3::Y);
    for skin in [0.02, 0.06, 0.1] {
        for turn in [0.0, 0.4, 1.9] {
            let [way, ..] = slide(flat.clone(), cuboid.clone(), skin, turn);
            for ground in &grounds {
                for cells in [1, 4] {
                    let shape = mesh::cuboid(HALVES, cells).shape();
                    let [slid, height, tilt] = slide(ground.clone(), shape, skin, turn);
                    println!("skin {skin}, turned by {turn}: {slid:.3} of {way:.3}");
                    assert!((slid / way - 1.0).abs() < 0.02, "{slid} of {way}");
                    assert!(height < 0.005 && tilt < 1e-3, "{height} off, tilt {tilt}");
                }
            }
        }
    }
}

/// Small boxes on a contact skin as large as they are. Would catch points of sides that end beyond
/// the prediction distance. These took the places of corners that carry, and the boxes rocked for
/// ever.
#[test]
fn small_boxes_with_a_contact_skin_come_to_rest() {
    let ground = mesh::floor(12.0, 20).shape();
    for (half, skin) in [(0.05, 0.01), (0.05, 0.04), (0.15, 0.02), (0.3, 0.04)] {
        for k in 0..5 {
            let k = k as Real;
            let at = Vec3::new(0.03 + 0.07 * k, half + 2.0 * skin + 0.1, 0.02 + 0.05 * k);
            let mut world = world(ColliderBuilder::new(ground.clone()).contact_skin(skin));
            world.integration_parameters.length_unit = 0.1;
            let cube = mesh::cuboid(Vec3::splat(half), 1).shape();
            let collider = ColliderBuilder::new(cube).contact_skin(skin).density(1.0);
            let body = after(400, world, RigidBodyBuilder::dynamic().translation(at), collider);
            let low = half + 2.0 * skin - body.translation().y;
            assert!(body.is_sleeping() && low < 0.002, "{half}, {skin}, {k}: {low} low");
        }
    }
}
