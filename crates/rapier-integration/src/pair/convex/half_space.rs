use parry3d::math::{Pose, Real};
use parry3d::query::{ContactManifold, TrackedContact};
use parry3d::shape::{HalfSpace, PackedFeatureId, Triangle};

/// The contacts of a triangle and a half-space: its corners that are within the prediction
/// distance. `pose` is that of the triangle in the frame of the half-space; `flipped` if the
/// triangle is shape 1.
///
/// The formula leaves nothing to choose, so that the contacts are Parry's bit for bit. Parry's
/// routine gives the manifold a new buffer each time, this one does not.
pub(super) fn half_space_manifold<M, C: Default + Copy>(
    pose: &Pose,
    half_space: &HalfSpace,
    triangle: &Triangle,
    prediction: Real,
    flipped: bool,
    manifold: &mut ContactManifold<M, C>,
) {
    let normal = half_space.normal;
    let normal_at_triangle = pose.rotation.inverse() * normal;
    for (corner, &vertex) in triangle.vertices().iter().enumerate() {
        let placed = pose * vertex;
        let distance = placed.dot(normal);
        if distance <= prediction {
            manifold.points.push(TrackedContact::flipped(
                placed - normal * distance,
                vertex,
                PackedFeatureId::face(0),
                PackedFeatureId::vertex(corner as u32),
                distance,
                flipped,
            ));
        }
    }
    let normals = [normal, -normal_at_triangle];
    [manifold.local_n1, manifold.local_n2] =
        if flipped { [normals[1], normals[0]] } else { normals };
}
