//! Points of the exact contact of two triangles, with Parry's names of features.

use std::sync::LazyLock;

use glamx::DVec3;
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::details::{NormalConstraints, NormalConstraintsPair};
use parry3d::query::{ContactManifold, TrackedContact};
use parry3d::shape::{PackedFeatureId, Triangle};
use sbbk_core::contact::{
    Feature, FeaturePair, ManifoldPoint, ManifoldPoints, TriangleContact, clip, contact,
    contact_from, push_closest,
};
use sbbk_core::query::TrianglePair;
use sbbk_core::traverse::Placement;

use super::pose::PairPose;
use super::query::ContactPoints;
use super::triangle_shapes::{Cones, Hint};
use super::write::write_points as write_to_manifold;

/// Returns a point of a shape in frame 1, from an origin there.
pub(super) fn in_local(placement: &Placement, i: usize, point: Vector, origin: Vector) -> DVec3 {
    match i {
        0 => point.as_dvec3() - origin.as_dvec3(),
        _ => placement.to_frame1(point, origin),
    }
}

/// Returns the contact of two triangles within a distance. `hint` has the features to be tried first.
#[inline(always)]
pub(super) fn contact_of(
    TrianglePair { corners: [t1, t2], .. }: &TrianglePair,
    within: f64,
    hint: Hint,
) -> Option<TriangleContact> {
    match hint {
        Some(features) => contact_from(t1, t2, within, features),
        None => contact(t1, t2, within),
    }
}

/// Replaces `points` by the clipped points of a contact. The normal is projected into the normal
/// cones of both triangles; there are no points if the cones reject the contact.
#[inline(always)]
pub(super) fn write_points(
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

/// The contacts of two triangles from step to step, without meshes: for hosts with a midphase of
/// their own.
///
/// Exact at every scale, see [`sbbk_core::contact`](mod@sbbk_core::contact).
#[derive(Clone, Debug)]
pub struct TriangleContacts<C> {
    features: Option<FeaturePair>,
    points: Vec<TrackedContact<()>>,
    previous_points: Vec<TrackedContact<C>>,
}

impl<C> Default for TriangleContacts<C> {
    fn default() -> Self {
        Self { features: None, points: Vec::new(), previous_points: Vec::new() }
    }
}

impl<C: Default + Copy> TriangleContacts<C> {
    /// Brings the manifold of two triangles up to date, `triangle2` at `pos12` in the frame of
    /// `triangle1`.
    ///
    /// The manifold has no points if the triangles are farther apart than `prediction`, if normal
    /// constraints reject the contact, or for numbers that are not finite.
    pub fn update<M>(
        &mut self,
        pos12: &Pose,
        triangles: [&Triangle; 2],
        normal_constraints: [Option<&dyn NormalConstraints>; 2],
        prediction: Real,
        manifold: &mut ContactManifold<M, C>,
    ) {
        let pose = PairPose::new(pos12, prediction);
        let [corners1, corners2] = triangles.map(|Triangle { a, b, c }| [*a, *b, *c]);
        let triangles = TrianglePair::new(&pose.placement12, corners1, corners2);
        let mut clipped = ManifoldPoints::new();
        let [t1, t2] = &triangles.corners;
        let contact = contact_of(&triangles, f64::from(prediction), self.features);
        self.features = contact.map(|contact| contact.features);
        let points = std::mem::take(&mut self.points);
        let mut points = ContactPoints { points, ..ContactPoints::default() };
        points.points.clear();
        if let Some(contact) = contact {
            clip(t1, t2, contact.normal, &mut clipped);
            push_closest(t1, t2, &contact, &mut clipped);
            let cones = normal_constraints;
            write_points(&pose, &triangles, &contact, &mut clipped, cones, &mut points);
        }
        if points.points.is_empty() {
            manifold.points.clear();
        } else {
            write_to_manifold(&points, &mut self.previous_points, manifold);
        }
        self.points = points.points;
    }
}
