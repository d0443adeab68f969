//! Heads that fall on a floor or in a pit, and small things on a tray.

use super::kit::*;

/// Half extents of the floor of piles.
pub(super) const FLOOR: Vec3 = Vec3::new(100.0, 1.0, 100.0);
/// Step after which times and contacts are measured.
const FULL_AT: usize = 60;
const HEADS: usize = 200;
/// Pairs whose depth is judged.
const PAIRS: usize = 150;

pub(super) fn piles(mesh: Option<&Mesh>) -> Vec<Trial> {
    let pile = MonkeyPile::of(HEADS, mesh.cloned().unwrap_or_else(mesh::monkey_head));
    let name = format!("pile of {HEADS} {}", mesh.map_or("heads", |mesh| &mesh.name));
    let has_limits = mesh.is_none();
    let run = move |kit: &Kit| heap(kit, &pile, has_limits);
    vec![Trial::new(name, run).without_control()]
}

/// A floor, whose top is at height 0, and above it bodies that do not sleep.
pub(super) fn above_floor(
    kit: &Kit,
    floor: Vec3,
    poses: impl IntoIterator<Item = Pose3>,
    collider: &ColliderBuilder,
) -> World {
    let mut world = kit.world();
    world.fix(-floor.y * Vec3::Y, ColliderBuilder::cuboid(floor.x, floor.y, floor.z));
    for pose in poses {
        world.add(RigidBodyBuilder::dynamic().pose(pose).can_sleep(false), collider);
    }
    world
}

/// Heads that fall on a floor and come to rest on each other. Mean heights and points of the solver
/// have limits for the built-in head only.
fn heap(kit: &Kit, pile: &MonkeyPile, has_limits: bool) -> Figures {
    let (heights, points) =
        if has_limits { ([0.9, 1.4], 20.0) } else { ([0.0, f64::INFINITY], f64::INFINITY) };
    let heads = pile.heads;
    let mut world = above_floor(kit, FLOOR, pile.poses(), &kit.mesh(&pile.mesh));
    let (depths, mut deep) = (Depths::new(&pile.mesh), Default::default());
    let watched = world.watch(180, FULL_AT, |world, step| {
        if step == 120 {
            deep = touching_pairs(world, &depths, PAIRS);
        }
    });
    let [mean_depth, deepest] = deep;
    let ends = world.places().into_iter().map(|place| place.y);
    let mean_height = ends.clone().sum::<f32>() / heads as f32;
    Figures::default()
        .within("mean height", mean_height, heights)
        .at_most("highest", largest(ends), 4.5)
        .at_most("deepest", deepest, 0.05)
        .at_most("mean depth", mean_depth, 0.001)
        .at_most("energy gained", watched.gain, 0.001)
        .at_most("points a step", watched.points, points * heads as f64)
        .note("ms a step", watched.step_time)
}

/// Heads that come to rest in a pit, of several sizes.
pub(super) fn pits() -> Vec<Trial> {
    let trial = |size: f32| {
        let name = format!("64 heads of {size} in a pit");
        Trial::new(name, move |kit| pit(kit, size)).without_control()
    };
    [0.02, 1.0, 50.0].map(trial).into()
}

/// All lengths, gravity and `length_unit` are in heads.
fn pit(kit: &Kit, size: f32) -> Figures {
    /// Heads along each side of the cube in which they start.
    const SIDE: usize = 4;
    let (mut world, mut random) = (kit.world(), seeded());
    world.integration_parameters.length_unit = size;
    world.gravity *= size;
    world.fix(Vec3::ZERO, kit.mesh(&open_box([3.6, 4.1], 3.0, 0.5).scaled(size)));
    let head = mesh::monkey_head().centred().scaled_to(size);
    let collider = kit.mesh(&head);
    for index in 0..SIDE * SIDE * SIDE {
        let [x, y, z] = [1, SIDE * SIDE, SIDE].map(|step| (index / step % SIDE) as f32);
        let place = 1.15 * Vec3::new(x - 1.5, y + 0.7, z - 1.5);
        // Sides of the pit are between the axes.
        let place = Pose3::rotation(Vec3::Y * FRAC_PI_4) * place;
        world.put(Pose3::from_parts(size * place, random::rotation(&mut random)), &collider);
    }
    let watched = world.watch(480, 480, |_, _| ());
    let awake = world.watched.iter().filter(|&&body| !world.bodies[body].is_sleeping()).count();
    let [_, deepest] = touching_pairs(&world, &Depths::new(&head), PAIRS);
    let ends = world.places();
    let kept = ends.iter().filter(|end| end.y > 0.0).count();
    let size = f64::from(size);
    Figures::default()
        .at_most("speed", f64::from(world.top_speed()) / size, 0.05)
        .at_most("deepest", deepest / size, 0.025)
        .at_most("energy gained", watched.gain, 0.001)
        .none("lost", ends.len() - kept)
        .note("awake", awake as f64)
        .note("highest", f64::from(largest(ends.iter().map(|end| end.y))) / size)
}

/// Returns a square tray with walls all round, from half its diagonals inside and outside. `rim` is
/// the height of the walls over the bottom, and `bottom` its thickness.
pub(super) fn open_box([half, outside]: [f32; 2], rim: f32, bottom: f32) -> Mesh {
    let profile =
        [[0.0, -bottom], [outside, -bottom], [outside, rim], [half, rim], [half, 0.0], [0.0; 2]];
    mesh::revolved(&profile.map(Vec2::from_array), 4).named("tray")
}

/// Small things on a tray, with Rapier's prediction distance, which is as large as they are.
pub(super) fn tray(kit: &Kit) -> Figures {
    /// Things along each side of the grid in which they start, and the layers of it.
    const SIDE: usize = 5;
    const LAYERS: usize = 4;
    const WALL: f32 = 0.02;
    let (mut world, mut random) = (kit.world(), seeded());
    world.fix(Vec3::ZERO, kit.mesh(&open_box([0.45, 0.45 + WALL], 0.25, WALL)));
    let kinds = [
        mesh::ball(0.5, 8),
        mesh::torus(0.35, 0.15, 24, 12),
        mesh::monkey_head_with(8),
        mesh::cuboid(Vec3::new(0.5, 0.3, 0.2), 6),
    ];
    for index in 0..SIDE * SIDE * LAYERS {
        let size = 0.03 + (0.08 - 0.03) * random.rand_float();
        let kind = kinds[index % kinds.len()].clone().centred().scaled_to(size);
        let [x, y, z] = [1, SIDE * SIDE, SIDE].map(|step| (index / step) as f32);
        let middle = 0.5 * (SIDE - 1) as f32;
        let place = Vec3::new(x % SIDE as f32 - middle, y + 0.6, z % SIDE as f32 - middle);
        let pose = Pose3::from_parts(0.1 * place, random::rotation(&mut random));
        world.put(pose, &kit.mesh(&kind));
    }
    let watched = world.watch(240, FULL_AT, |_, _| ());
    let fell = world.places().iter().filter(|place| place.y < -WALL).count();
    Figures::default()
        .none("fell", fell)
        .at_most("speed", world.top_speed(), 0.5)
        .at_most("energy gained", watched.gain, 0.001)
        .note("points a step", watched.points)
        .note("ms a step", watched.step_time)
}
