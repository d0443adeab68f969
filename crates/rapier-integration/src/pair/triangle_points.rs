//! The points of a contact of two triangles, with the features that Parry names.

use std::sync::LazyLock;

use parry3d::math::{Pose, Real, Vector};
use parry3d::query::TrackedContact;
use parry3d::query::details::NormalConstraintsPair;
use parry3d::shape::PackedFeatureId;
use sbbk_core::contact::{
    Feature, FeaturePair, ManifoldPoint, ManifoldPoints, TriangleContact, clip,
};
use sbbk_core::query::TrianglePair;

use super::pose::PairPose;
use super::query::ContactPoints;
use super::shapes::Cones;

/// Replaces `points` by the clipped points of a contact of two triangles. The normal is projected
/// into the normal cones of both triangles; there are no points if the cones reject the contact.
#[inline(always)]
pub(super) fn write_triangle_points(
    pose: &PairPose,
    triangles: &TrianglePair,
    contact: &TriangleContact,
    clipped: &mut ManifoldPoints,
    cones: Cones<'_>,
    ContactPoints { normals, points, .. }: &mut ContactPoints,
) {
    let PairPose { pos12, placement12, .. } = pose;
    points.clear();
    let Some(normal1) = constrained_normal(contact, cones, pos12) else { return };
    let is_turned = normal1 != contact.normal.as_vec3();
    if is_turned {
        let [t1, t2] = &triangles.corners;
        clip(t1, t2, normal1.as_dvec3().normalize(), clipped);
    }
    if cones.iter().any(Option::is_some) {
        clipped.retain(|point| is_plausible(point, contact));
    }
    let names = &*NAMES;
    points.extend(clipped.iter().map(|point| {
        let [feature1, feature2] = names[usize::from(point.features.to_bits() & FeaturePair::MASK)];
        let point1 = (triangles.origin.as_dvec3() + point.point1).as_vec3();
        let point2 = placement12.to_frame2(point.point2, triangles.origin).as_vec3();
        TrackedContact::new(point1, point2, feature1, feature2, point.distance as Real)
    }));
    *normals = [normal1, pos12.rotation.inverse() * -normal1];
}

/// Returns the normal in the normal cones of both triangles; `None` if they exclude it.
#[inline(always)]
pub(super) fn constrained_normal(
    contact: &TriangleContact,
    cones: Cones<'_>,
    pos12: &Pose,
) -> Option<Vector> {
    let mut normal = contact.normal.as_vec3();
    if cones.iter().any(Option::is_some) {
        let mut normal2 = pos12.rotation.inverse() * -normal;
        if !<(_, _)>::from(cones).project_local_normals(pos12, &mut normal, &mut normal2) {
            return None;
        }
    }
    Some(normal)
}

/// Returns false for a point that a constrained normal puts more than five times as deep as the
/// contact: Parry drops such points.
fn is_plausible(point: &ManifoldPoint, contact: &TriangleContact) -> bool {
    contact.distance >= 0.0 || point.distance >= 0.0 || point.distance >= 5.0 * contact.distance
}

/// Names of the features of a point, by [`FeaturePair::to_bits`].
type Names = [[PackedFeatureId; 2]; FeaturePair::MASK as usize + 1];

/// Parry's names of features. Made once: Parry's constructors are not inlined.
static NAMES: LazyLock<Names> = LazyLock::new(|| {
    let name = |feature| match feature {
        Feature::Vertex(i) => PackedFeatureId::vertex(u32::from(i)),
        Feature::Edge(i) => PackedFeatureId::edge(u32::from(i)),
        Feature::Face => PackedFeatureId::face(0),
    };
    std::array::from_fn(|bits| {
        let features = FeaturePair::from_bits(bits as u8);
        [features.feature1(), features.feature2()].map(name)
    })
});
