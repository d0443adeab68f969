//! Loose bodies: in stacks, piles, bowls and rooms, on tables, sunk in each other, and thrown.

use super::prelude::*;
use crate::study::hard::resting::bowl;

/// Towers of boxes that stand, heavy ones on light ones among them.
pub(super) fn stacks(draw: &mut Draw, kit: &Kit) -> Figures {
    let count = draw.count(2, 6);
    let ratio = draw.log(1.0, 100.0);
    let gap = draw.pick(&[0.0, 0.005]);
    let friction = draw.within(0.3, 0.9);
    let mut bodies = vec![Body::fixed(draw.ground(3.0), Pose3::from_rotation(draw.yaw()))];
    let mut top = 0.0;
    for _ in 0..count {
        let halves = Vec3::from_array([0.3, 0.15, 0.3].map(|low| draw.within(low, 0.6)));
        // The middles of all above are at most 0.16 aside of the middle of one, which is 0.3 wide.
        let aside = Quat::from_rotation_y(draw.within(0.0, TAU)) * Vec3::X * draw.within(0.0, 0.08);
        let turn = Quat::from_rotation_y(draw.within(0.0, TAU));
        let pose = Pose3::from_parts(aside + Vec3::Y * (top + gap + halves.y), turn);
        top += gap + 2.0 * halves.y;
        bodies.push(Body::moving(draw.brick(halves), pose).density(draw.log(1.0, ratio)));
    }
    let bodies: Vec<Body> = bodies.into_iter().map(|body| body.friction(friction)).collect();
    let mut stage = Stage::new(draw, kit, &bodies);
    let figures = stage.settle();
    let moves: Vec<Vec3> = (1..bodies.len()).map(|k| stage.moved(k)).collect();
    figures
        .at_most("aside", largest(moves.iter().map(|way| way.with_y(0.0).length())), 0.05)
        .at_most("down or up", largest(moves.iter().map(|way| way.y.abs())), 0.05)
}

/// Bodies that fall into a tray and come to rest on each other.
pub(super) fn piles(draw: &mut Draw, kit: &Kit) -> Figures {
    let count = draw.count(3, 12);
    let ratio = draw.log(1.0, 100.0);
    let tray = draw.tray();
    let mut bodies = vec![Body::fixed(tray, Pose3::IDENTITY)];
    for index in 0..count {
        // The longest body is no longer than its cell.
        let [x, z] = [index % 2, index / 2 % 2].map(|k| 2.1 * (k as f32 - 0.5));
        let place = Vec3::new(x, 2.1 * ((index / 4) as f32 + 0.5), z);
        let part = draw.solid();
        let pose = Pose3::from_parts(place, draw.turn());
        bodies.push(Body::moving(part, pose).damped(draw).density(draw.log(1.0, ratio)));
    }
    settled(draw, kit, &bodies, |place| place.y > 0.0)
}

/// Runs bodies, the first of them fixed, until they should rest.
fn settled(draw: &Draw, kit: &Kit, bodies: &[Body], is_kept: impl Fn(Vec3) -> bool) -> Figures {
    let mut stage = Stage::new(draw, kit, bodies);
    let figures = stage.settle();
    let lost = (1..bodies.len()).filter(|&body| !is_kept(stage.place(body)));
    figures.none("lost", lost.count()).at_most("deepest", stage.deepest(1), 0.03)
}

/// Bodies that come to rest in a fixed bowl: thick, or a sheet.
pub(super) fn bowls(draw: &mut Draw, kit: &Kit) -> Figures {
    /// Radius of the bowl, and thickness at most.
    const RADIUS: f32 = 2.5;
    const THICK: f32 = 0.2;
    let thick = bowl();
    let scale = Vec3::splat(RADIUS / 0.5);
    let control = thick.control.and_then(|shape| shape.scale_dyn(scale, 1));
    let control = control.map(|shape| SharedShape(shape.into()));
    let sheet = mesh::vessel(RADIUS, draw.count(6, 16), 0.1);
    let mesh = match draw.pick(&["thick", "sheet", "soup", "two sides"]) {
        "sheet" => sheet,
        "soup" => draw.flawed(&sheet),
        "two sides" => mesh::two_sided(&sheet),
        _ => thick.mesh.scaled(scale.x),
    };
    let mut bodies = vec![Body::fixed(
        draw.part("bowl", mesh.clone(), Part::clean(mesh, control)),
        Pose3::from_rotation(draw.yaw()),
    )];
    let ratio = draw.log(1.0, 100.0);
    for index in 0..draw.count(1, 5) {
        let [x, z] = [index % 2, index / 2 % 2].map(|k| 2.1 * (k as f32 - 0.5));
        // Only the highest are apart from those below.
        let place = 0.5 * Vec3::new(x, 0.0, z) + Vec3::Y * (2.1 * index as f32 - 0.5);
        let pose = Pose3::from_parts(place, draw.turn());
        let part = draw.solid();
        bodies.push(Body::moving(part, pose).damped(draw).density(draw.log(1.0, ratio)));
    }
    settled(draw, kit, &bodies, |place| place.length() < RADIUS + THICK || place.y > 0.0)
}

/// Bodies that fly about in a closed box whose faces look outward.
pub(super) fn rooms(draw: &mut Draw, kit: &Kit) -> Figures {
    let halves = Vec3::from_array([(); 3].map(|()| draw.within(2.2, 3.5)));
    let room = draw.room(halves);
    let pose = Pose3::from_rotation(draw.yaw());
    let mut bodies = vec![Body::fixed(room, pose)];
    let ratio = draw.log(1.0, 100.0);
    for index in 0..draw.count(1, 8) {
        let corner = [index & 1, index >> 1 & 1, index >> 2].map(|k| 2.1 * (k as f32 - 0.5));
        let part = draw.solid();
        let place = pose * Pose3::from_parts(Vec3::from_array(corner), draw.turn());
        let speed = draw.turn() * Vec3::X * draw.within(0.0, 4.0);
        let body = Body::moving(part, place).damped(draw).thrown(speed, Vec3::ZERO);
        bodies.push(body.density(draw.log(1.0, ratio)));
    }
    let mut stage = Stage::new(draw, kit, &bodies);
    let figures = stage.settle();
    let beyond = (1..bodies.len()).map(|body| {
        let inside = pose.inverse_transform_point(stage.place(body)).abs() - halves;
        largest(inside.to_array().map(|beyond| beyond.max(-halves.x)))
    });
    let beyond = beyond.reduce(|a, b| largest([a, b])).unwrap_or(f32::NAN);
    let figures = figures.at_most("beyond a wall", beyond, 0.0);
    figures.at_most("deepest", stage.deepest(1), 0.03)
}

/// Tables of boxes, with things on them.
pub(super) fn tables(draw: &mut Draw, kit: &Kit) -> Figures {
    let ground = Body::fixed(draw.ground(4.0), Pose3::from_rotation(draw.yaw()));
    let top = Vec3::new(draw.within(0.9, 1.5), draw.within(0.04, 0.1), draw.within(0.8, 1.2));
    let leg = Vec3::new(draw.within(0.05, 0.12), draw.within(0.3, 0.6), draw.within(0.05, 0.12));
    let height = 2.0 * (leg.y + top.y);
    let start = Pose3::translation(0.0, 0.001, 0.0);
    let mut bodies = vec![ground, Body::moving(draw.table(top, leg), start)];
    let ratio = draw.log(1.0, 100.0);
    for index in 0..draw.count(1, 4) {
        let halves = Vec3::from_array([(); 3].map(|()| draw.within(0.1, 0.25)));
        let side = Vec3::new((index % 2) as f32 - 0.5, 0.0, (index / 2) as f32 - 0.5);
        let place = 0.9 * top.with_y(0.0) * side + Vec3::Y * (height + halves.y + 0.002);
        let pose = Pose3::from_parts(place, draw.yaw());
        let part = draw.brick(halves);
        bodies.push(Body::moving(part, pose).density(draw.log(1.0, ratio)));
    }
    let mut stage = Stage::new(draw, kit, &bodies);
    let figures = stage.settle();
    let up = stage.pose(1).rotation * Vec3::Y;
    let moves = (1..bodies.len()).map(|k| stage.moved(k).length());
    figures.at_most("tilt", 1.0 - up.y, 1e-4).at_most("moved", largest(moves), 0.05)
}

/// Bodies that are released sunk in each other, without gravity.
pub(super) fn overlaps(draw: &mut Draw, kit: &Kit) -> Figures {
    (draw.gravity, draw.is_sunk) = (0.0, true);
    let count = draw.count(2, 5);
    let ratio = draw.log(1.0, 100.0);
    let mut middle = Vec3::ZERO;
    let mut bodies = Vec::new();
    for _ in 0..count {
        let part = draw.solid();
        let pose = Pose3::from_parts(middle, draw.turn());
        bodies.push(Body::moving(part, pose).density(draw.log(1.0, ratio)));
        // Nearer ones would be wholly in each other.
        let is_free = |at: Vec3, bodies: &[Body]| {
            bodies.iter().all(|body: &Body| body.pose.translation.distance(at) > 0.5)
        };
        let last = middle;
        while !is_free(middle, &bodies) {
            middle = last + draw.turn() * Vec3::X * draw.within(0.5, 0.9);
        }
    }
    let mut stage = Stage::new(draw, kit, &bodies);
    let start = stage.deepest(0);
    let fastest = stage.world.fastest(draw.steps(3.0)) / draw.size;
    // Twice Rapier's allowed error, for length units of a size.
    let figures = Figures::default().at_most("deepest", stage.deepest(0), 0.01);
    // Rapier parts bodies at three sizes/s.
    figures.at_most("speed", fastest, 9.0).note("deepest at the start", start)
}

/// Thin plates with soft CCD that fly onto a ground.
pub(super) fn plates(draw: &mut Draw, kit: &Kit) -> Figures {
    let thick = draw.log(0.02, 0.15);
    let speed = draw.log(3.0, 40.0);
    let ground = draw.ground(8.0);
    let mut bodies = vec![Body::fixed(ground, Pose3::from_rotation(draw.yaw()))];
    let count = 3;
    for index in 0..count {
        let [x, z] = [(); 2].map(|()| draw.within(0.3, 0.6));
        let part = draw.brick(Vec3::new(x, 0.5 * thick, z));
        let turn = draw.yaw() * Quat::from_rotation_x(draw.within(-0.6, 0.6));
        let place = Vec3::new(3.0 * (index as f32 - 1.0), 1.0 + draw.within(0.5, 1.5), 0.3);
        let heading = Vec3::new(draw.within(-0.3, 0.3), -1.0, draw.within(-0.3, 0.3));
        let mut body = Body::moving(part, Pose3::from_parts(place, turn));
        body = body.thrown(speed * heading, Vec3::ZERO);
        let fastest = 1.1 * speed + 2.0 * draw.gravity.sqrt();
        body.builder.soft_ccd_prediction = 1.2 * fastest * draw.dt;
        bodies.push(body);
    }
    let mut stage = Stage::new(draw, kit, &bodies);
    let mut lowest = 0.0;
    for _ in 0..draw.steps(2.0) {
        stage.world.step();
        // A plate on the ground is above it, however it lies.
        let heights = (1..=count).map(|body| {
            let place = stage.place(body);
            let is_over = place.x.abs().max(place.z.abs()) < 5.0;
            if is_over || !place.is_finite() { -place.y } else { 0.0 }
        });
        lowest = largest([lowest, largest(heights)]);
    }
    Figures::default().at_most("below the ground", lowest, 0.05)
}
