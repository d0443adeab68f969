//! Shapes and poses for brute force in f64.

use glamx::{DAffine3, DMat3, DPose3, DVec3, Pose3};
use rapier3d::math::{Real, Vector};
use rapier3d::parry::shape::{Shape, TypedShape};
use sbbk_truth::ConvexBody;

/// Converts a convex shape of Parry.
///
/// # Panics
///
/// If the shape is not convex, or of a kind that Rapier does not have.
pub fn convex_body(shape: &dyn Shape) -> ConvexBody {
    let hull = |points: &[Vector]| {
        ConvexBody::hull(points.iter().map(|point| point.as_dvec3()).collect::<Vec<_>>())
    };
    let round = |inner: &dyn Shape, radius: Real| convex_body(inner).rounded(radius.into());
    match shape.as_typed_shape() {
        TypedShape::Ball(ball) => ConvexBody::hull([DVec3::ZERO]).rounded(ball.radius.into()),
        TypedShape::Segment(segment) => hull(&[segment.a, segment.b]),
        TypedShape::Capsule(capsule) => round(&capsule.segment, capsule.radius),
        TypedShape::Triangle(triangle) => hull(triangle.vertices()),
        TypedShape::Cuboid(shape) => hull(&shape.to_trimesh().0),
        TypedShape::ConvexPolyhedron(shape) => hull(shape.points()),
        TypedShape::Cylinder(shape) => {
            ConvexBody::cylinder(shape.half_height.into(), shape.radius.into())
        }
        TypedShape::Cone(shape) => ConvexBody::cone(shape.half_height.into(), shape.radius.into()),
        TypedShape::HalfSpace(shape) => ConvexBody::half_space(shape.normal.as_dvec3()),
        TypedShape::RoundTriangle(shape) => round(&shape.inner_shape, shape.border_radius),
        TypedShape::RoundCuboid(shape) => round(&shape.inner_shape, shape.border_radius),
        TypedShape::RoundConvexPolyhedron(shape) => round(&shape.inner_shape, shape.border_radius),
        TypedShape::RoundCylinder(shape) => round(&shape.inner_shape, shape.border_radius),
        TypedShape::RoundCone(shape) => round(&shape.inner_shape, shape.border_radius),
        _ => unreachable!("all convex shapes of Rapier are listed"),
    }
}

/// A pose as a map. A quaternion that is not quite of unit length scales.
pub fn affine(pose: &Pose3) -> DAffine3 {
    let DPose3 { rotation, translation } = DPose3::from(*pose);
    let [x, y, z] = DVec3::AXES.map(|axis| rotation * axis);
    DAffine3::from_mat3_translation(DMat3::from_cols(x, y, z), translation)
}
