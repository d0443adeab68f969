use super::*;
use rapier3d::dynamics::MassProperties;

const ANGLE: f32 = 20.0;
const FRICTION: f32 = 0.8;
const STEPS: usize = 180;
const SIZE: f32 = 60.0;

/// A mesh of radius 1, without flaws but like the one that rolls, and what rolls.
struct Roller {
    name: &'static str,
    sound: Mesh,
    mesh: Mesh,
    mass: MassProperties,
    /// Path of a smooth body, as a share of the path without friction.
    ideal: f32,
}

fn rollers() -> Vec<Roller> {
    let ball = |name, sound: Mesh, mesh: Mesh| Roller {
        name,
        sound,
        mesh,
        mass: MassProperties::from_ball(1.0, 1.0),
        ideal: 5.0 / 7.0,
    };
    let even = |cells| mesh::cube_ball(1.0, [cells; 6]);
    let tube = mesh::tube(1.0, 0.5, 360);
    let across = 0.5 + 0.25 / 3.0;
    vec![
        ball("ball of 6912", even(24), even(24)),
        ball("ball of 10,800", even(30), even(30)),
        ball("inward ball of 6912", even(24), mesh::turned_inside_out(even(24))),
        ball("uneven ball of 5360", even(21), mesh::cube_ball(1.0, [10, 14, 18, 22, 26, 30])),
        ball("soup ball of 5292", even(21), mesh::unwelded(&even(21), 0.5e-4, 1)),
        ball("ball of 5292 with slivers", even(21), mesh::with_slivers(&even(21), 2)),
        ball("two-sided ball of 6912", even(24), mesh::two_sided(&even(24))),
        Roller {
            name: "open tube of 720",
            sound: tube.clone(),
            mesh: tube,
            mass: MassProperties::new(Vec3::ZERO, 1.0, Vec3::new(across, across, 1.0)),
            ideal: 0.5,
        },
    ]
}

/// The path down a slope in 3 s.
fn roll(roller: &Roller, ground: &SharedShape, body: &SharedShape, is_prepared: bool) -> f32 {
    let tilt = Quat::from_rotation_z(-ANGLE.to_radians());
    let (mut world, _prepared) = prepared_world(&[ground, body], is_prepared);
    let below = if ground.as_cuboid().is_some() { tilt * -Vec3::Y } else { Vec3::ZERO };
    let slope = RigidBodyBuilder::fixed().translation(below).rotation(tilt.to_scaled_axis());
    world.insert(slope, ColliderBuilder::new(ground.clone()).friction(FRICTION));
    let start = tilt * Vec3::new(-15.0, 1.0005, 0.3);
    let turn = match roller.name {
        "open tube of 720" => Quat::from_rotation_z(0.01),
        _ => rotation(&mut Rand32::new(6)),
    };
    let start_body = RigidBodyBuilder::dynamic().translation(start).rotation(turn.to_scaled_axis());
    let collider = ColliderBuilder::new(body.clone()).mass_properties(roller.mass);
    let end = after(STEPS, world, start_body.can_sleep(false), collider.friction(FRICTION));
    (end.translation() - start).dot(tilt * Vec3::X)
}

/// Would catch sheets that hold a rolling body at their edges.
#[test]
fn meshes_roll_down_two_triangles_as_down_a_cuboid() {
    let two_triangles = mesh::floor(SIZE, 1);
    let cuboid = SharedShape::cuboid(0.5 * SIZE, 1.0, 0.5 * SIZE);
    let time = STEPS as f32 / 60.0;
    let sliding = 0.5 * 9.81 * ANGLE.to_radians().sin() * time * time;
    let mut cases = Vec::new();
    for roller in rollers() {
        let sound = roller.sound.shape();
        let control = roll(&roller, &cuboid, &sound, true);
        let mut add = |column, path: f32, is_right| {
            let shown = format!("{:.3}", path / (roller.ideal * sliding));
            cases.push(Case { row: roller.name.into(), column, shown, is_right });
        };
        add("on a cuboid", control, true);
        for flags in FLAGS {
            let [ground, body] = [&two_triangles, &roller.mesh].map(|mesh| mesh.shape_with(flags));
            for is_prepared in [false, true] {
                let path = roll(&roller, &ground, &body, is_prepared);
                let column = match (flags.is_empty(), is_prepared) {
                    (true, false) => "plain",
                    (true, true) => "prepared",
                    (false, false) => "flag",
                    (false, true) => "both",
                };
                add(column, path, (path / control - 1.0).abs() < 0.1);
            }
        }
    }
    judge("path down 20 degrees to that of a smooth body", &cases, &[]);
}

/// A ring of so many triangles that it is a sheet unless it is prepared.
fn ring() -> Mesh {
    mesh::torus(0.35, 0.15, 120, 54)
}

/// Depth of the lowest vertex after 4 s, of a ring dropped on two triangles.
fn drop_depth(ring: &Mesh, height: f32, seed: u64, is_prepared: bool) -> f32 {
    let [floor, body] = [&mesh::floor(20.0, 1), ring].map(|mesh| mesh.shape());
    let (mut world, _prepared) = prepared_world(&[&body], is_prepared);
    world.insert(RigidBodyBuilder::fixed(), ColliderBuilder::new(floor));
    let turn = rotation(&mut Rand32::new(seed)) * Quat::from_rotation_x(FRAC_PI_2);
    let start = RigidBodyBuilder::dynamic().translation(Vec3::new(0.7, height + 0.5, 0.4));
    let start = start.rotation(turn.to_scaled_axis());
    let end = after(240, world, start, ColliderBuilder::new(body));
    -lowest(ring, end.position())
}

/// Would catch large meshes that get stuck in a floor, with contacts that push up and down.
#[test]
fn large_parts_do_not_sink_into_two_triangles() {
    let ring = ring();
    assert!(ring.triangle_count() > 8192);
    let mut cases = Vec::new();
    for (row, height) in [("from 0.5 m", 0.5), ("from 3 m", 3.0), ("from 10 m", 10.0)] {
        for (column, is_prepared) in [("plain", false), ("prepared", true)] {
            let depths = (0..4).map(|seed| drop_depth(&ring, height, seed, is_prepared));
            let deepest = depths.fold(0.0, f32::max);
            let shown = format!("{:.1} mm", 1e3 * deepest);
            cases.push(Case { row: row.into(), column, shown, is_right: deepest < 0.02 });
        }
    }
    judge("a ring of 12,960 triangles on a floor of two: depth", &cases, &[]);
}
