use super::*;
use rapier3d::dynamics::MassProperties;

fn grounds() -> [(&'static str, Mesh); 3] {
    let block = mesh::cuboid(Vec3::new(10.0, 0.5, 10.0), 10).mapped(|at| at - 0.5 * Vec3::Y);
    let inside_out = mesh::turned_inside_out(block.clone());
    [("block", block), ("block inside out", inside_out), ("sheet", mesh::floor(20.0, 10))]
}

/// Thin bodies and half their sides.
fn bodies() -> [(&'static str, Mesh, Vec3); 4] {
    let [card, plate, rod] =
        [[0.3, 0.005, 0.2], [0.3, 0.0005, 0.2], [0.4, 0.0005, 0.0005]].map(Vec3::from_array);
    let small = Vec3::new(0.06, 0.005, 0.04);
    let sheet = |half: Vec3| mesh::floor(2.0, 2).mapped(|at| at * half);
    [
        ("card", sheet(card), card),
        ("small card", sheet(small), small),
        ("plate of 1 mm", mesh::cuboid(plate, 2), plate),
        ("rod of 1 mm", mesh::cuboid(rod, 2), rod),
    ]
}

/// Drops nine bodies at several angles. Returns how many are below the ground after two seconds.
fn lost(ground: &Mesh, body: &Mesh, half: Vec3, tilt: f32, flags: TriMeshFlags) -> usize {
    let ground = ColliderBuilder::new(ground.shape_with(flags));
    let mass = MassProperties::from_cuboid(100.0, half.max(Vec3::splat(0.005)));
    let bodies = [0, 1, 2, 3, 4, 5, 6, 7, 8].map(|i: u8| {
        let [row, column] = [i / 3, i % 3].map(f32::from);
        let turn =
            Vec3::new(tilt * (f32::from(i) / 4.0 - 1.0), 0.3 * f32::from(i), tilt * (1.0 - column));
        let at = Vec3::new(2.0 * column - 2.03, 0.02, 2.0 * row - 2.07);
        let collider = ColliderBuilder::new(body.shape_with(flags)).mass_properties(mass);
        (RigidBodyBuilder::dynamic().translation(at).rotation(turn), collider)
    });
    settled(120, world(ground), bodies).iter().filter(|place| place.y < -0.02).count()
}

/// Would catch thin bodies that rest, sink in by a millimetre, and go on through the ground.
#[test]
fn thin_bodies_rest_on_the_ground() {
    let mut cases = Vec::new();
    for (flags, (ground, ground_mesh)) in with_flags(grounds()) {
        for tilt in [0.0, 0.02, 0.1] {
            for (column, body, half) in bodies() {
                let lost = lost(&ground_mesh, &body, half, tilt, flags);
                let name = format!("{ground}, tilted by {tilt}");
                cases.push(Case::new(name, flags, column, lost, lost == 0));
            }
        }
    }
    judge("bodies of nine below the ground, 2 s after a fall of 2 cm", &cases, &[]);
}

/// Drops 36 plates or discs in a square from a height, tilted each in its own way. Returns the
/// height of each after four seconds.
fn dropped(ground: ColliderBuilder, body: &Mesh, height: f32) -> Vec<f32> {
    let bodies = (0..36).map(|i: u8| {
        let [row, column] = [i / 6, i % 6].map(f32::from);
        let turn = Vec3::new(0.11 * (row - 2.4), 0.3 * f32::from(i), 0.13 * (2.6 - column));
        let at = Vec3::new(2.03 * column - 5.11, height, 2.07 * row - 5.17);
        let body = ColliderBuilder::new(body.shape());
        (RigidBodyBuilder::dynamic().translation(at).rotation(turn), body)
    });
    settled(240, world(ground), bodies).iter().map(|place| place.y).collect()
}

/// Plates of 2 cm sink in by more than they are thick. Would catch plates that go through since
/// triangles of a wavy ground disagree on their side. Four of 36 went through.
#[test]
fn plates_stay_on_wavy_grounds() {
    let wave = |at: Vec3| at.with_y(0.05 * (2.0 * at.x).sin() * (1.7 * at.z).cos());
    let ground = mesh::floor(20.0, 120).mapped(wave);
    let plate = mesh::cuboid(Vec3::new(0.4, 0.01, 0.4), 2);
    for height in [0.4, 0.6, 0.8] {
        let heights = dropped(ColliderBuilder::new(ground.shape()), &plate, height);
        let lost = heights.iter().filter(|&&height| height < -0.2).count();
        assert_eq!(lost, 0, "from {height}");
    }
}

/// Would catch discs that stand on four points of one arc. They turn about that arc, sink in, and
/// rock without end.
#[test]
fn thin_discs_come_to_rest_on_a_cuboid() {
    let profile = [[0.0, -0.01], [0.4, -0.01], [0.4, 0.01], [0.0, 0.01]].map(Vec2::from_array);
    let disc = mesh::revolved(&profile, 32);
    let ground = ColliderBuilder::cuboid(20.0, 0.5, 20.0).translation(-0.5 * Vec3::Y);
    let heights = dropped(ground, &disc, 1.2);
    let least = heights.into_iter().fold(f32::INFINITY, f32::min);
    assert!(least > 0.005, "{least}");
}

/// Coins are Rapier's cylinders, on a closed mesh of twelve triangles. Would catch coins that get
/// three points of one arc and the one opposite. These coins tip sideways and fall through the
/// floor.
#[test]
fn coins_stay_on_a_box() {
    let floor = mesh::cuboid(Vec3::new(2.0, 0.5, 2.0), 1).mapped(|at| at - 0.5 * Vec3::Y);
    let floor = floor.shape();
    for (radius, half) in [(0.015, 0.002), (0.03, 0.004), (0.1, 0.01)] {
        let coin = SharedShape::cylinder(half, radius);
        for drop in [0.05, 0.2] {
            let mut random = Rand32::new(6);
            let lost = (0..40).filter(|_| {
                let place = Vec3::new(0.3, drop + radius, 0.2);
                let pose = Pose3::from_parts(place, rotation(&mut random));
                end(90, &floor, RigidBodyBuilder::dynamic().pose(pose), &coin).y < -half
            });
            assert_eq!(lost.count(), 0, "of 40 coins of {radius} from {drop}");
        }
    }
}

/// Small cubes fall fast, with the soft CCD that the guide recommends. Would catch contacts chosen
/// without the nearest one: 23 of 80 cubes passed.
#[test]
fn small_fast_cubes_stay_on_a_plate() {
    for (half, cells) in [(0.03, 1), (0.05, 3)] {
        let cube = mesh::cuboid(Vec3::splat(half), cells).shape();
        for speed in [20.0, 30.0] {
            let mut random = Rand32::new(9);
            let lost = (0..20).filter(|_| {
                let pose = Pose3::from_parts(2.0 * Vec3::Y, rotation(&mut random));
                let body = RigidBodyBuilder::dynamic().pose(pose).linvel(-speed * Vec3::Y);
                let body = body.soft_ccd_prediction(1.2 * speed / 60.0);
                let plate = SharedShape::cuboid(2.0, 0.01, 2.0);
                end(90, &plate, body, &cube).y < 0.0
            });
            assert_eq!(lost.count(), 0, "of 20 cubes of {half} at {speed} m/s");
        }
    }
}

/// Brackets of two open plates on open floors: on one plate, or on two edges. Would catch plates
/// without contacts, as they have passed the floor: the bracket tips through.
#[test]
fn bent_sheets_rest_on_open_floors() {
    let plate = mesh::floor(0.5, 4);
    let upright = plate.clone().mapped(|at| Vec3::new(-0.25, at.x + 0.25, at.z));
    let bracket =
        Mesh::merged("bracket", &[plate, upright]).mapped(|at| at + Vec3::new(0.05, -0.2, 0.0));
    let mass = MassProperties::from_cuboid(1.0, Vec3::splat(0.25));
    let collider = ColliderBuilder::new(bracket.shape()).mass_properties(mass);
    let mut random = Rand32::new(7);
    for cells in [1, 6, 40] {
        for turned in [0.0, FRAC_PI_2, 0.75 * PI].repeat(20) {
            let mut within = |size: Real| size * (2.0 * random.rand_float() - 1.0);
            let turn = Quat::from_rotation_y(within(PI)) * Quat::from_rotation_x(within(0.03));
            let turn = turn * Quat::from_rotation_z(within(0.03) + turned);
            let place = Pose::from_parts(Vec3::new(within(1.5), 0.0, within(1.5)), turn);
            let low = lowest(&bracket, &place);
            let pose = Pose::from_parts(place.translation + (0.002 - low) * Vec3::Y, turn);
            let start = RigidBodyBuilder::dynamic().pose(pose);
            let floor = ColliderBuilder::new(mesh::floor(6.0, cells).shape());
            let end = watched(300, world(floor), start, collider.clone(), |_| ());
            let depth = -lowest(&bracket, end.position());
            assert!(depth < 0.01, "{depth} deep in {cells} cells, turned by {turned}");
        }
    }
}
