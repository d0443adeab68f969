//! Bodies that fall into a tray and come to rest on each other.

use super::prelude::*;

/// Side of the grid cell in which a body starts. The longest is no longer.
const CELL: f32 = 2.1;

pub(super) fn run(draw: &mut Draw, kit: &Kit) -> Figures {
    let count = draw.count(3, 12);
    let ratio = draw.log(1.0, 100.0);
    let tray = draw.tray();
    let mut bodies = vec![Body::fixed(tray, Pose3::IDENTITY)];
    for index in 0..count {
        let [x, z] = [index % 2, index / 2 % 2].map(|k| CELL * (k as f32 - 0.5));
        let place = Vec3::new(x, CELL * ((index / 4) as f32 + 0.5), z);
        let part = draw.solid();
        let pose = Pose3::from_parts(place, draw.turn());
        bodies.push(Body::moving(part, pose).damped(draw).density(draw.log(1.0, ratio)));
    }
    settled(draw, kit, &bodies, |place| place.y > 0.0)
}

/// Runs bodies, the first of them fixed, until they should rest.
pub(super) fn settled(
    draw: &Draw,
    kit: &Kit,
    bodies: &[Body],
    is_kept: impl Fn(Vec3) -> bool,
) -> Figures {
    let mut stage = Stage::new(draw, kit, bodies);
    let figures = stage.settle();
    let lost = (1..bodies.len()).filter(|&body| !is_kept(stage.place(body)));
    figures.none("lost", lost.count()).at_most("deepest", stage.deepest(1), 0.03)
}
