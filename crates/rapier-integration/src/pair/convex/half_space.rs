use glamx::DVec3;
use parry3d::math::Real;
use parry3d::query::{ContactManifold, TrackedContact};
use parry3d::shape::{HalfSpace, PackedFeatureId, Triangle};

/// Fills an empty manifold with the corners of a triangle that are within the prediction distance
/// of a half-space; `corners` has them in its frame. `flipped` if the triangle is shape 1.
pub(super) fn half_space_points<M, C: Default + Copy>(
    half_space: &HalfSpace,
    triangle: &Triangle,
    corners: &[DVec3; 3],
    prediction: Real,
    flipped: bool,
    manifold: &mut ContactManifold<M, C>,
) {
    let normal = half_space.normal.as_dvec3();
    for (index, (corner, vertex)) in (0..).zip(corners.iter().zip(triangle.vertices())) {
        let distance = corner.dot(normal);
        if distance <= f64::from(prediction) {
            manifold.points.push(TrackedContact::flipped(
                (corner - normal * distance).as_vec3(),
                *vertex,
                PackedFeatureId::face(0),
                PackedFeatureId::vertex(index),
                distance as Real,
                flipped,
            ));
        }
    }
}
