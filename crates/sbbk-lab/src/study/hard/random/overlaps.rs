//! Bodies that are released sunk in each other, without gravity.

use super::prelude::*;

/// Greatest depth at the end, in sizes: twice Rapier's allowed error, for length units of a size.
const DEPTH: f64 = 0.01;

pub(super) fn run(draw: &mut Draw, kit: &Kit) -> Figures {
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
    let figures = Figures::default().at_most("deepest", stage.deepest(0), DEPTH);
    // Rapier parts bodies at three sizes/s.
    figures.at_most("speed", fastest, 9.0).note("deepest at the start", start)
}
