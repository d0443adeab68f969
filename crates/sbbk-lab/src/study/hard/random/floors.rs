//! Bodies that slide until they stop, and that roll on, over a flat ground.

use super::prelude::*;
use super::riders::{Rider, judged};

/// Longest way, in sizes, and longest time, in seconds.
const WAY: f32 = 11.0;
const SECONDS: f32 = 4.0;

pub(super) fn run(draw: &mut Draw, kit: &Kit) -> Figures {
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
