//! Bodies that slide, roll or stay on a slope.

use super::prelude::*;
use super::riders::{Rider, judged};

/// Longest way, in sizes, and longest time, in seconds.
const WAY: f32 = 11.0;
const SECONDS: f32 = 4.0;

pub(super) fn run(draw: &mut Draw, kit: &Kit) -> Figures {
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
