//! Two fingers that squeeze a part and hold it.

use super::prelude::*;

/// Seconds in which the fingers close without gravity.
const CLOSING: f32 = 1.0;
/// Seconds in which the fingers hold the part.
const HOLDING: f32 = 2.0;
/// Damping of the fingers, in 1/s.
const DAMPING: f32 = 20.0;

pub(super) fn run(draw: &mut Draw, kit: &Kit) -> Figures {
    let halves = Vec3::from_array([0.25, 0.3, 0.3].map(|low| draw.within(low, 0.5)));
    let part = gripped(draw, halves);
    draw.gravity = draw.log(10.0, 150.0);
    draw.dt = draw.dt.min(1.0 / 60.0);
    // Force of a finger, in weights of the part.
    let press = draw.log(3.0, 30.0);
    let bodies = [finger(draw, &part, -1.0), finger(draw, &part, 1.0), held(part)];
    let mut stage = Stage::new(draw, kit, &bodies);
    let gravity = std::mem::take(&mut stage.world.gravity);
    close(&mut stage, press * gravity.length());
    stage.world.gravity = gravity;
    // The whole gripper may drift.
    let place = |stage: &Stage| stage.place(2) - 0.5 * (stage.place(0) + stage.place(1));
    let (start, rotation) = (place(&stage), stage.pose(2).rotation);
    stage.world.run(draw.steps(HOLDING));
    let turned = rotation.angle_between(stage.pose(2).rotation);
    let figures = Figures::default().at_most("moved", start.distance(place(&stage)), 0.2);
    figures.at_most("turned", turned, 0.3).note("deepest", stage.deepest(0))
}

/// A box, a ball or an upright cylinder.
fn gripped(draw: &mut Draw, halves: Vec3) -> Part {
    match draw.pick(&["brick", "ball", "cylinder"]) {
        "brick" => draw.brick(halves),
        "ball" => draw.ball(),
        _ => {
            let Vec3 { x, y, .. } = halves;
            let profile = [[0.0, -y], [x, -y], [x, y], [0.0, y]].map(Vec2::from_array);
            let cylinder = mesh::revolved(&profile, draw.count(16, 48));
            let hull = SharedShape::convex_hull(&cylinder.vertices);
            draw.sometimes_flawed("cylinder", Part::clean(cylinder, hull))
        }
    }
}

fn held(part: Part) -> Body {
    Body::moving(part, Pose3::IDENTITY).friction(1.0)
}

/// A finger beside the part, which moves along `x` only and has between 0.3 and 3 times the mass of the part.
fn finger(draw: &mut Draw, part: &Part, side: f32) -> Body {
    let halves = Vec3::new(0.15, draw.within(0.15, 0.5), draw.within(0.15, 0.5));
    let brick = draw.brick(halves);
    let place = side * (part.sound.bounds().maxs.x + halves.x + 0.002);
    let density = draw.log(0.3, 3.0) * part.mass.mass() / brick.mass.mass();
    let finger = Body::moving(brick, Pose3::translation(place, 0.0, 0.0));
    let mut finger = finger.friction(1.0).density(density);
    let builder = finger.builder.enabled_translations(true, false, false);
    finger.builder = builder.lock_rotations().linear_damping(DAMPING);
    finger
}

/// Presses the fingers against the part. The force grows at first, up to `press` times the mass of the part.
fn close(stage: &mut Stage, press: f32) {
    let [one, other, part] = [0, 1, 2].map(|k| stage.handles[k]);
    let steps = stage.draw.steps(CLOSING);
    let force = press * stage.world.bodies[part].mass();
    for step in 0..steps {
        let share = (2.0 * step as f32 / steps as f32).min(1.0);
        for (finger, way) in [(one, Vec3::X), (other, -Vec3::X)] {
            let finger = &mut stage.world.bodies[finger];
            finger.reset_forces(true);
            finger.add_force(share * force * way, true);
        }
        stage.world.step();
    }
}
