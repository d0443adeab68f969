//! Bodies that come to rest in a fixed bowl: thick, or a sheet.

use super::piles::settled;
use super::prelude::*;
use crate::study::hard::resting::bowl;

/// Radius of the bowl, and thickness at most.
const RADIUS: f32 = 2.5;
const THICK: f32 = 0.2;

pub(super) fn run(draw: &mut Draw, kit: &Kit) -> Figures {
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
