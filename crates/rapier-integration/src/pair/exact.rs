//! One manifold from the exact contact of two triangles.

use std::sync::LazyLock;

use glamx::DVec3;
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::details::{NormalConstraints, NormalConstraintsPair};
use parry3d::query::{ContactManifold, TrackedContact};
use parry3d::shape::{PackedFeatureId, Triangle};
use sbbk_core::contact::{
    Feature, FeaturePair, ManifoldPoint, ManifoldPoints, TriangleContact, clip, manifold,
};
use sbbk_core::traverse::Placement;

/// The cones that the normals of both triangles must be in.
pub(super) type Constraints<'a> = [Option<&'a dyn NormalConstraints>; 2];

/// Two triangles in frame 1, relative to a corner of the first one: all their digits are about each other.
pub(super) struct LocalTriangles {
    origin: Vector,
    corners: [[DVec3; 3]; 2],
}

impl LocalTriangles {
    pub(super) fn new(placement: &Placement, triangle1: &Triangle, triangle2: &Triangle) -> Self {
        let origin = triangle1.a;
        let relative = |x: Vector| x.as_dvec3() - origin.as_dvec3();
        let placed = |x: Vector| placement.to_frame1(x, origin);
        // Written out, as `array::map` is not always inlined.
        let corners = [
            [DVec3::ZERO, relative(triangle1.b), relative(triangle1.c)],
            [placed(triangle2.a), placed(triangle2.b), placed(triangle2.c)],
        ];
        Self { origin, corners }
    }

    /// The contact within the margin and its points, tried first with the features of the step before.
    pub(super) fn contact(
        &self,
        margin: Real,
        last: Option<FeaturePair>,
        points: &mut ManifoldPoints,
    ) -> Option<TriangleContact> {
        let [t1, t2] = &self.corners;
        manifold(t1, t2, f64::from(margin), last, points)
    }
}

/// Fills `manifold` with the `points` of a contact, as Parry would: the normal is projected into the cones of both
/// triangles, where they have them, and points keep their data by their feature ids.
///
/// May leave the manifold without points, where the constraints reject the contact.
pub(super) fn fill<M, C: Default + Copy>(
    (placement, pos12): (&Placement, &Pose),
    triangles: &LocalTriangles,
    (contact, points): (&TriangleContact, &mut ManifoldPoints),
    constraints: Constraints<'_>,
    previous_points: &mut Vec<TrackedContact<C>>,
    manifold: &mut ContactManifold<M, C>,
) {
    std::mem::swap(&mut manifold.points, previous_points);
    manifold.points.clear();
    let Some(normal1) = constrained_normal(contact, constraints, pos12) else {
        return;
    };
    if normal1.is_changed {
        let [t1, t2] = &triangles.corners;
        clip(t1, t2, normal1.normal.as_dvec3().normalize(), points);
    }
    let is_constrained = constraints.iter().any(Option::is_some);
    for point in points.iter().filter(|point| !is_constrained || is_plausible(point, contact)) {
        manifold.points.push(tracked(placement, triangles.origin, point, previous_points));
    }
    manifold.local_n1 = normal1.normal;
    manifold.local_n2 = pos12.rotation.inverse() * -normal1.normal;
}

struct ConstrainedNormal {
    normal: Vector,
    is_changed: bool,
}

/// The normal in the cones of both triangles; `None` if they exclude it.
fn constrained_normal(
    contact: &TriangleContact,
    constraints: Constraints<'_>,
    pos12: &Pose,
) -> Option<ConstrainedNormal> {
    let free = contact.normal.as_vec3();
    let mut normal = free;
    if constraints.iter().any(Option::is_some) {
        let mut normal2 = pos12.rotation.inverse() * -free;
        if !<(_, _)>::from(constraints).project_local_normals(pos12, &mut normal, &mut normal2) {
            return None;
        }
    }
    Some(ConstrainedNormal { normal, is_changed: normal != free })
}

/// Parry drops points that a constrained normal puts more than five times as deep as the contact is without
/// constraints.
fn is_plausible(point: &ManifoldPoint, contact: &TriangleContact) -> bool {
    contact.distance >= 0.0 || point.distance >= 0.0 || point.distance >= 5.0 * contact.distance
}

fn tracked<C: Default + Copy>(
    placement: &Placement,
    origin: Vector,
    point: &ManifoldPoint,
    previous: &[TrackedContact<C>],
) -> TrackedContact<C> {
    let fid1 = packed(point.features.feature1());
    let fid2 = packed(point.features.feature2());
    let local_p1 = (origin.as_dvec3() + point.point1).as_vec3();
    let local_p2 = placement.to_frame2(point.point2, origin).as_vec3();
    let mut tracked = TrackedContact::new(local_p1, local_p2, fid1, fid2, point.distance as f32);
    if let Some(known) = previous.iter().find(|old| old.fid1 == fid1 && old.fid2 == fid2) {
        tracked.data = known.data;
    }
    tracked
}

fn packed(feature: Feature) -> PackedFeatureId {
    PACKED[usize::from(feature.to_bits())]
}

/// Parry's names of the features, by [`Feature::to_bits`]: made once, as Parry's own constructors are not inlined
/// and took a twentieth of a query.
static PACKED: LazyLock<[PackedFeatureId; 1 << Feature::BITS]> = LazyLock::new(|| {
    std::array::from_fn(|bits| match Feature::from_bits(bits as u8) {
        Feature::Vertex(i) => PackedFeatureId::vertex(u32::from(i)),
        Feature::Edge(i) => PackedFeatureId::edge(u32::from(i)),
        Feature::Face => PackedFeatureId::face(0),
    })
});

/// The contacts of two triangles from step to step, without meshes: for hosts with a midphase of their own.
///
/// Exact at every scale, see [`sbbk_core::contact`].
#[derive(Clone, Debug)]
pub struct TriangleContacts<C> {
    features: Option<FeaturePair>,
    previous_points: Vec<TrackedContact<C>>,
}

impl<C> Default for TriangleContacts<C> {
    fn default() -> Self {
        Self { features: None, previous_points: Vec::new() }
    }
}

impl<C: Default + Copy> TriangleContacts<C> {
    /// Brings the manifold of two triangles up to date, `triangle2` at `pos12` in the frame of `triangle1`.
    ///
    /// The manifold has no points if the triangles are farther apart than `prediction`, if the normal
    /// constraints reject the contact, or if a number is not finite.
    pub fn update<M>(
        &mut self,
        pos12: &Pose,
        [triangle1, triangle2]: [&Triangle; 2],
        normal_constraints: [Option<&dyn NormalConstraints>; 2],
        prediction: Real,
        manifold: &mut ContactManifold<M, C>,
    ) {
        let placement = Placement::new(pos12);
        let triangles = LocalTriangles::new(&placement, triangle1, triangle2);
        let mut points = ManifoldPoints::new();
        let contact = triangles.contact(prediction, self.features, &mut points);
        self.features = contact.map(|contact| contact.features);
        match contact {
            Some(contact) => fill(
                (&placement, pos12),
                &triangles,
                (&contact, &mut points),
                normal_constraints,
                &mut self.previous_points,
                manifold,
            ),
            None => manifold.points.clear(),
        }
    }
}
