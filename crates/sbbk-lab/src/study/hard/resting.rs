//! Stacks, walls, bowls and a chain, which should stay as they are.

use super::kit::*;

/// Towers of cubes.
pub(super) fn stacks() -> Vec<Trial> {
    let trial = |(cells, (gap, place)): (u32, (f32, &str))| {
        let name = format!("stack of cubes of {} triangles, {place}", 12 * cells * cells);
        Trial::new(name, move |kit| stack(kit, cells, gap))
    };
    let gaps = [(0.0, "touching"), (0.01, "1 cm apart")];
    [1, 10].into_iter().flat_map(|cells| gaps.map(|gap| trial((cells, gap)))).collect()
}

fn stack(kit: &Kit, cells: u32, gap: f32) -> Figures {
    const CUBES: usize = 10;
    let mut world = kit.world();
    world.fix(-0.5 * Vec3::Y, kit.collider(&Form::cuboid(Vec3::new(5.0, 0.5, 5.0), cells)));
    let cube = kit.collider(&Form::cuboid(Vec3::splat(0.5), cells));
    for index in 0..CUBES {
        let height = 0.5 + gap + index as f32 * (1.0 + gap);
        world.put(Pose3::from_translation(Vec3::Y * height), &cube);
    }
    world.run(600);
    let ends = world.places();
    let drift = largest(ends.iter().map(|end| end.with_y(0.0).length()));
    let fallen = (0..CUBES).filter(|&index| (ends[index].y - 0.5 - index as f32).abs() > 0.1);
    Figures::default().at_most("drift", drift, 0.03).none("fallen", fallen.count())
}

/// A wall of bricks, and a house of cards.
pub(super) fn walls() -> Vec<Trial> {
    let trials = [1, 4].into_iter().flat_map(|cells| {
        let triangles = 12 * cells * cells;
        let wall = move |kit: &Kit| boxes(kit, cells, &wall(), 0.5, 0.03);
        let house = move |kit: &Kit| boxes(kit, cells, &house(), 0.8, 0.1);
        [
            Trial::new(format!("wall of bricks of {triangles} triangles"), wall),
            Trial::new(format!("house of cards of {triangles} triangles"), house),
        ]
    });
    trials.collect()
}

/// Running bond, with half bricks at the ends of every second row; each touches those below.
fn wall() -> Vec<(Vec3, Pose3)> {
    const BRICK: Vec3 = Vec3::new(0.5, 0.25, 0.25);
    const COLUMNS: usize = 6;
    /// Between two bricks of a row.
    const JOINT: f32 = 0.002;
    let width = 2.0 * BRICK.x + JOINT;
    let half = BRICK * Vec3::new(0.5, 1.0, 1.0) - Vec3::X * 0.25 * JOINT;
    let shift = width * (0.5 - 0.5 * COLUMNS as f32);
    let rows = (0..5).flat_map(|row: usize| {
        let whole = |range: std::ops::Range<usize>, shift: f32| {
            range.map(move |column| (BRICK, column as f32 - shift)).collect::<Vec<_>>()
        };
        let mut bricks =
            if row.is_multiple_of(2) { whole(0..COLUMNS, 0.0) } else { whole(1..COLUMNS, 0.5) };
        if row % 2 == 1 {
            bricks.extend([-0.25, COLUMNS as f32 - 0.75].map(|x| (half, x)));
        }
        let y = BRICK.y * (2 * row + 1) as f32;
        bricks.into_iter().map(move |(s, x)| (s, Pose3::translation(x * width + shift, y, 0.0)))
    });
    rows.collect()
}

/// Two pairs that lean against each other, a card across, and a pair on it.
fn house() -> Vec<(Vec3, Pose3)> {
    /// Upright.
    const CARD: Vec3 = Vec3::new(0.01, 0.5, 0.4);
    /// Lean of the cards, in radians.
    const LEAN: f32 = 0.35;
    let (sin, cos) = LEAN.sin_cos();
    // From its middle to its highest point, and to the edge that leans on the other card.
    let up = CARD.x * sin + CARD.y * cos;
    let aside = CARD.x * cos + CARD.y * sin;
    let pair = |x: f32, floor: f32| {
        [-1.0, 1.0].map(|side| {
            let place = Vec3::new(x + side * aside, floor + up, 0.0);
            Pose3::from_parts(place, Quat::from_rotation_z(side * LEAN))
        })
    };
    let foot = 2.0 * CARD.y * sin + 0.01;
    let middle = Vec3::Y * (2.0 * up + CARD.x);
    let across = Pose3::from_parts(middle, Quat::from_rotation_z(FRAC_PI_2));
    let upper = pair(0.0, 2.0 * (up + CARD.x));
    let poses = [&pair(-foot, 0.0)[..], &pair(foot, 0.0), &[across], &upper].concat();
    poses.into_iter().map(|pose| (CARD, pose)).collect()
}

/// Boxes, each with half its sides.
fn boxes(kit: &Kit, cells: u32, boxes: &[(Vec3, Pose3)], friction: f32, limit: f64) -> Figures {
    let mut world = kit.world();
    let floor = kit.collider(&Form::cuboid(Vec3::new(6.0, 0.5, 6.0), cells));
    world.fix(-0.5 * Vec3::Y, floor.friction(friction));
    for &(half_extents, pose) in boxes {
        world.put(pose, &kit.collider(&Form::cuboid(half_extents, cells)).friction(friction));
    }
    world.run(480);
    let drifts = boxes.iter().zip(world.places());
    let drifts = drifts.map(|((_, start), end)| start.translation.distance(end));
    Figures::default().at_most("drift", largest(drifts), limit)
}

/// Fixed or dynamic.
fn hung(is_fixed: bool) -> RigidBodyBuilder {
    if is_fixed { RigidBodyBuilder::fixed() } else { RigidBodyBuilder::dynamic() }
}

const RADIUS: f32 = 0.5;
const INNER: f32 = RADIUS - 0.03;

/// Half a hollow ball, its middle at the origin.
pub(super) fn bowl() -> Form {
    /// Parts round its axis, and from its lowest point to its rim.
    const SEGMENTS: u32 = 24;
    const RINGS: u32 = 8;
    let point = |radius: f32, ring: u32| {
        let (sin, cos) = (FRAC_PI_2 * ring as f32 / RINGS as f32).sin_cos();
        // Exactly on the axis and on the rim.
        let [sin, cos] = [sin, cos].map(|part| if part.abs() < 1e-6 { 0.0 } else { part });
        radius * Vec2::new(sin, -cos)
    };
    let outside = (0..=RINGS).map(|ring| point(RADIUS, ring));
    let inside = (0..=RINGS).rev().map(|ring| point(INNER, ring));
    let profile: Vec<Vec2> = outside.chain(inside).collect();
    let corner = |radius, ring, segment| {
        let Vec2 { x, y } = point(radius, ring);
        let (sin, cos) = (TAU * segment as f32 / SEGMENTS as f32).sin_cos();
        Vec3::new(x * cos, y, x * sin)
    };
    let patch = |ring: u32, segment: u32| {
        let rims = [(RADIUS, ring), (RADIUS, ring + 1), (INNER, ring), (INNER, ring + 1)];
        let sides = [segment, segment + 1];
        rims.into_iter().flat_map(|(radius, ring)| sides.map(|s| corner(radius, ring, s))).collect()
    };
    let patches =
        (0..RINGS).flat_map(|ring| (0..SEGMENTS).map(move |segment| patch(ring, segment)));
    Form::parts(mesh::revolved(&profile, SEGMENTS), patches)
}

/// Thin bowls, each dropped into the one below.
pub(super) fn nested(kit: &Kit) -> Figures {
    const BOWLS: usize = 10;
    // A bowl rests on the inner rim of the one below.
    let apart = (RADIUS * RADIUS - INNER * INNER).sqrt();
    let (mut world, mut random) = (kit.world(), seeded());
    let collider = kit.collider(&bowl());
    for index in 0..BOWLS {
        // The first stands on nothing: it is fixed.
        let body = hung(index == 0).translation(Vec3::Y * index as f32 * (apart + 0.02));
        world.add(body.rotation(Vec3::Y * TAU * random.rand_float()), &collider);
    }
    world.run(360);
    let ends = world.places();
    let steps = ends.windows(2).map(|pair| pair[1] - pair[0]);
    let is_nested = |step: &Vec3| (step.length() - apart).abs() < 0.5 * apart && step.y > 0.0;
    Figures::default()
        .none("not nested", steps.filter(|step| !is_nested(step)).count())
        .at_most("speed", world.top_speed(), 0.25)
        .note("height of one", (ends[BOWLS - 1].y - ends[0].y) / (BOWLS - 1) as f32)
}

/// Rings that hang in each other, with a weight.
pub(super) fn chains() -> Vec<Trial> {
    let trial = |load: f32| {
        let name = format!("chain under {load} times its weight");
        Trial::new(name, move |kit| chain(kit, load))
    };
    [1.0, 5.0, 50.0].map(trial).into()
}

const RING: f32 = 1.0;
const TUBE: f32 = 0.2;

/// A torus, with segments of ring and tube. Its control is a hull for each segment of the ring.
pub(super) fn ring(radius: f32, tube: f32, [segments, around]: [u32; 2]) -> Form {
    let part = |part: u32| {
        let ends = [part, part + 1].map(|k| TAU * k as f32 / segments as f32);
        let points = ends.into_iter().flat_map(|angle| {
            (0..around).map(move |k| {
                let turn = TAU * k as f32 / around as f32;
                let distance = radius + tube * turn.cos();
                Vec3::new(distance * angle.cos(), -tube * turn.sin(), distance * angle.sin())
            })
        });
        points.collect()
    };
    Form::parts(mesh::torus(radius, tube, segments, around), (0..segments).map(part))
}

fn chain(kit: &Kit, load: f32) -> Figures {
    /// Rings of the chain; one more is the weight.
    const RINGS: usize = 10;
    /// Between the middles of two rings of a chain that is taut, and less at the start.
    const PITCH: f32 = 2.0 * (RING - TUBE);
    const SLACK: f32 = 0.02;
    let mut world = kit.world();
    // With Rapier's defaults a chain of hulls parts as well.
    world.integration_parameters.length_unit = RING / 4.0;
    world.integration_parameters.num_solver_iterations = 16;
    let collider = kit.collider(&ring(RING, TUBE, [24, 12]));
    for index in 0..=RINGS {
        // Every second ring is turned by a right angle, all of them upright.
        let upright = Quat::from_rotation_x(FRAC_PI_2);
        let turn = Quat::from_rotation_y(FRAC_PI_2 * (index % 2) as f32) * upright;
        let place = -Vec3::Y * index as f32 * (PITCH - SLACK);
        let density = if index == RINGS { load * RINGS as f32 } else { 1.0 };
        let body = hung(index == 0).pose(Pose3::from_parts(place, turn)).can_sleep(false);
        world.add(body, &collider.clone().density(density));
    }
    world.step();
    let rise = world.rise(359);
    let ends = world.places();
    let apart: Vec<f32> = ends.windows(2).map(|pair| pair[0].distance(pair[1])).collect();
    let linked = apart.iter().filter(|&&apart| apart < PITCH + TUBE).count();
    let mass: f32 = world.watched[1..].iter().map(|&body| world.bodies[body].mass()).sum();
    // Unit of the gain: the energy that lifts all rings by one ring.
    let lift = mass * -world.gravity.y * PITCH;
    Figures::default()
        .none("parted", RINGS - linked)
        .at_most("energy gained", rise / f64::from(lift), 0.05)
        .note("longest link", largest(apart) / PITCH)
}
