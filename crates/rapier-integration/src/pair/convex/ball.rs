use std::sync::LazyLock;

use glamx::DVec3;
use parry3d::math::{Real, Vector};
use parry3d::query::{ContactManifold, TrackedContact};
use parry3d::shape::PackedFeatureId;

/// How far beside a triangle a ray from the centre of a ball may pass it and count as hitting it,
/// as an angle at the centre. The turned normal is rounded to f32, and the ray off by 2e-7: at the
/// edge between two triangles it must not miss both.
const BESIDE: f64 = 1.0e-6;

/// Where a ray from the origin along a unit vector hits a triangle, as its length.
///
/// A ball whose normal a cone has turned touches the triangle there, and does not touch it if there
/// is no such place: so Parry has it.
pub(super) fn ray_length(&[a, b, c]: &[DVec3; 3], direction: DVec3) -> Option<f64> {
    let normal = (b - a).cross(c - a);
    let length = a.dot(normal) / direction.dot(normal);
    let beside = |v: DVec3, w: DVec3| {
        let slack = BESIDE * v.length() * w.length();
        let volume = v.cross(w).dot(direction);
        [volume >= -slack, volume <= slack]
    };
    let sides = [beside(a, b), beside(b, c), beside(c, a)];
    let is_hit = (0..2).any(|sign| sides.iter().all(|side| side[sign]));
    // A centre on the triangle may be behind it by rounding.
    let size = a.length() + b.length() + c.length();
    (is_hit && length >= -BESIDE * size && length.is_finite()).then_some(length)
}

/// Made once: Parry's constructor is not inlined.
static FACE: LazyLock<PackedFeatureId> = LazyLock::new(|| PackedFeatureId::face(0));

/// Makes a point the only one of a manifold. If there was one, its data stays.
pub(super) fn keep_one<M, C: Default + Copy>(
    points: [Vector; 2],
    distance: Real,
    manifold: &mut ContactManifold<M, C>,
) {
    let [point1, point2] = points;
    if let [one] = &mut *manifold.points {
        (one.local_p1, one.local_p2, one.dist) = (point1, point2, distance);
        (one.fid1, one.fid2) = (*FACE, *FACE);
    } else {
        manifold.points.clear();
        manifold.points.push(TrackedContact::new(point1, point2, *FACE, *FACE, distance));
    }
}
