//! Bodies that slide, roll or stay on a flat ground or a slope.

use super::prelude::*;

/// Longest way, in sizes, and longest time, in seconds.
const WAY: f32 = 11.0;
const SECONDS: f32 = 4.0;

/// Bodies that slide until they stop, and that roll on, over a flat ground.
pub(super) fn floors(draw: &mut Draw, kit: &Kit) -> Figures {
    let slides = draw.chance(0.5);
    let yaw = Pose3::rotation(Vec3::Y * draw.within(0.0, TAU));
    let ground = Body::fixed(draw.ground(8.0), yaw);
    let rider = if slides { Rider::slider(draw) } else { Rider::roller(draw) };
    let start = [-6.0, draw.within(-1.0, 1.0)];
    let friction = if slides { draw.log(0.05, 0.5) } else { draw.within(0.3, 0.8) };
    let brake = if slides { friction * draw.gravity } else { 0.0 };
    // A slider stops before the end of the ground.
    let most = if slides { (2.0 * brake * WAY).sqrt() } else { 10.0 };
    let speed = draw.log(1.0, most.clamp(1.1, 10.0));
    let stop = if slides { speed / brake } else { WAY / speed };
    let seconds = stop.min(SECONDS);
    let ideal = speed * seconds - 0.5 * brake * seconds * seconds;
    let rides = rider.body(Pose3::IDENTITY, start, speed).friction(friction);
    let bodies = [ground.friction(friction), rides];
    judged(draw, kit, Pose3::IDENTITY, &bodies, [seconds, ideal], &rider)
}

/// Bodies that slide, roll or stay on a slope.
pub(super) fn slopes(draw: &mut Draw, kit: &Kit) -> Figures {
    let (kind, angle) = (draw.pick(&["slides", "stays", "rolls"]), draw.within(0.1, 0.5));
    let tilt = Pose3::rotation(Vec3::Z * -angle);
    let ground = draw.ground(8.0);
    let ground = Body::fixed(ground, tilt * Pose3::rotation(Vec3::Y * draw.within(0.0, TAU)));
    let rolls = kind == "rolls";
    let rider = if rolls { Rider::roller(draw) } else { Rider::slider(draw) };
    let friction = match kind {
        "slides" => draw.within(0.0, 0.8) * angle.tan(),
        // Enough to stay, and to roll without slipping.
        _ => draw.within(1.2, 1.6) * angle.tan(),
    };
    let (sin, cos) = angle.sin_cos();
    let pull = match (kind, rider.gyration) {
        ("stays", _) => 0.0,
        (_, Some(gyration)) => draw.gravity * sin / (1.0 + gyration),
        _ => draw.gravity * (sin - friction * cos),
    };
    let seconds = (2.0 * WAY / pull.max(1e-3)).sqrt().min(SECONDS);
    let start = [-6.0, draw.within(-1.0, 1.0)];
    let bodies = [ground.friction(friction), rider.body(tilt, start, 0.0).friction(friction)];
    judged(draw, kit, tilt, &bodies, [seconds, 0.5 * pull * seconds * seconds], &rider)
}

/// A body that rides along `x` over a flat ground, with its top at height 0 in the ground's frame.
struct Rider {
    part: Part,
    turn: Quat,
    /// Height of its middle.
    height: f32,
    /// Moment of inertia of a roller over mass and radius²; `None` for a slider.
    gyration: Option<f32>,
    /// True for balls with facets.
    is_rough: bool,
}

impl Rider {
    /// A brick that is too flat to topple at a friction coefficient of 0.8.
    fn slider(draw: &mut Draw) -> Self {
        let [x, z] = [(); 2].map(|()| draw.within(0.3, 0.7));
        let height = draw.within(0.3, 0.9) * x.min(z);
        let part = draw.brick(Vec3::new(x, height, z));
        // Friction turns a brick that does not lie along its way.
        let turn = Quat::from_rotation_y(FRAC_PI_2 * draw.pick(&[0.0, 1.0]));
        Self { part, turn, height, gyration: None, is_rough: false }
    }

    fn roller(draw: &mut Draw) -> Self {
        let lying = Quat::from_rotation_x(FRAC_PI_2);
        let long = draw.within(0.3, 0.6);
        let rider = |part: Part| {
            let gyration = part.mass.principal_inertia().y / (0.25 * part.mass.mass());
            Self { turn: lying, height: 0.5, gyration: Some(gyration), is_rough: false, part }
        };
        match draw.pick(&["capsule", "cylinder", "ball", "ball"]) {
            "capsule" => rider(draw.primitive("capsule", SharedShape::capsule_y(long, 0.5))),
            "cylinder" => rider(draw.primitive("cylinder", SharedShape::cylinder(long, 0.5))),
            _ => {
                let part = draw.ball();
                let is_rough = !part.is_primitive;
                Self { turn: draw.turn(), is_rough, ..rider(part) }
            }
        }
    }

    /// The rider on the ground's frame `ground`, at a place of it and a speed along its `x` axis.
    fn body(&self, ground: Pose3, [x, z]: [f32; 2], speed: f32) -> Body {
        let place = Vec3::new(x, self.height + 0.001, z);
        let pose = ground * Pose3::from_parts(place, self.turn);
        let spin = if self.gyration.is_some() { speed / self.height } else { 0.0 };
        let [speed, spin] = [speed * Vec3::X, -spin * Vec3::Z].map(|v| ground.rotation * v);
        Body::moving(self.part.clone(), pose).thrown(speed, spin)
    }
}

/// Way of a ride in the ground's frame, and how far its middle went up and down.
struct Ride {
    way: Vec3,
    rise: f32,
    sunk: f32,
}

/// Runs a ride of the second of two bodies over the first.
fn ride(draw: &Draw, kit: &Kit, frame: Pose3, bodies: &[Body], steps: usize) -> Ride {
    let mut stage = Stage::new(draw, kit, bodies);
    let place = |stage: &Stage| frame.inverse_transform_point(stage.place(1));
    let start = place(&stage);
    let (mut rise, mut sunk) = (0.0, 0.0);
    for _ in 0..steps {
        stage.world.step();
        let up = place(&stage).y - start.y;
        (rise, sunk) = (largest([rise, up]), largest([sunk, -up]));
    }
    Ride { way: place(&stage) - start, rise, sunk }
}

/// Compares a ride with the closed form. A rough body should ride as far as the control does.
fn judged(
    draw: &Draw,
    kit: &Kit,
    frame: Pose3,
    bodies: &[Body],
    [seconds, ideal]: [f32; 2],
    rider: &Rider,
) -> Figures {
    let steps = draw.steps(seconds);
    let end = ride(draw, kit, frame, bodies, steps);
    // A mesh ball hops, swerves and slows down at its facets by chance. So does its hull on a
    // cuboid.
    let hull = || ride(draw, &Kit::new(Column::Control, None), frame, bodies, steps);
    let (expected, [hop, drift], share) = match rider.is_rough.then(hull) {
        Some(hull) => (hull.way.x, [hull.rise, hull.way.z.abs()], 0.1),
        None => (ideal, [0.0; 2], 0.03),
    };
    let speed = bodies[1].builder.linvel.length().max(2.0 * ideal / seconds);
    let limit = f64::from(share * expected.max(0.5) + (speed * draw.dt).min(0.2));
    Figures::default()
        .at_most("rise", end.rise, f64::from(0.03 + 2.0 * hop))
        .at_most("sunk", end.sunk, 0.03)
        .within("way", end.way.x, [f64::from(expected) - limit, f64::from(expected) + limit])
        .at_most("aside", end.way.z.abs(), limit + f64::from(2.0 * drift))
}
