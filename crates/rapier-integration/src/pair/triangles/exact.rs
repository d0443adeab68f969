//! One manifold from the exact contact of two triangles.

use std::sync::LazyLock;

use parry3d::math::{Pose, Real, Vector};
use parry3d::query::details::{NormalConstraints, NormalConstraintsPair};
use parry3d::query::{ContactManifold, TrackedContact};
use parry3d::shape::{PackedFeatureId, Triangle};
use sbbk_core::contact::{
    Feature, FeaturePair, ManifoldPoint, ManifoldPoints, TriangleContact, clip,
    manifold as manifold_of,
};
use sbbk_core::query::TrianglePair;
use sbbk_core::traverse::Placement;

use crate::pair::pose::PairPose;

/// The cones that the normals of both triangles must be in.
pub(super) type Constraints<'a> = [Option<&'a dyn NormalConstraints>; 2];

/// Two of Parry's triangles in frame 1, with all digits of how they lie to each other.
#[inline(always)]
pub(super) fn local_pair(
    placement: &Placement,
    [triangle1, triangle2]: &[Triangle; 2],
) -> TrianglePair {
    let corners = |triangle: &Triangle| [triangle.a, triangle.b, triangle.c];
    TrianglePair::new(placement, corners(triangle1), corners(triangle2))
}

/// Fills `manifold` with the `points` of a contact, as Parry would: the normal is projected into
/// the cones of both triangles, where they have them, and points keep their data by their feature
/// ids.
///
/// May leave the manifold without points, where the constraints reject the contact.
pub(super) fn fill<M, C: Default + Copy>(
    pose: &PairPose,
    triangles: &TrianglePair,
    contact: &TriangleContact,
    points: &mut ManifoldPoints,
    constraints: Constraints<'_>,
    previous_points: &mut Vec<TrackedContact<C>>,
    manifold: &mut ContactManifold<M, C>,
) {
    let PairPose { pos12, placement12, .. } = pose;
    let Some(normal1) = constrained_normal(contact, constraints, pos12) else {
        manifold.points.clear();
        return;
    };
    if normal1.is_changed {
        let [t1, t2] = &triangles.corners;
        clip(t1, t2, normal1.normal.as_dvec3().normalize(), points);
    }
    if constraints.iter().any(Option::is_some) {
        points.retain(|point| is_plausible(point, contact));
    }
    let names = &*NAMES;
    if !have_names(&manifold.points, points, names) {
        rename(&mut manifold.points, points, names, previous_points);
    }
    for (point, tracked) in points.iter().zip(&mut manifold.points) {
        tracked.local_p1 = (triangles.origin.as_dvec3() + point.point1).as_vec3();
        tracked.local_p2 = placement12.to_frame2(point.point2, triangles.origin).as_vec3();
        tracked.dist = point.distance as f32;
    }
    manifold.local_n1 = normal1.normal;
    manifold.local_n2 = pos12.rotation.inverse() * -normal1.normal;
}

pub(super) struct ConstrainedNormal {
    pub(super) normal: Vector,
    is_changed: bool,
}

/// The normal in the cones of both triangles; `None` if they exclude it.
#[inline(always)]
pub(super) fn constrained_normal(
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

/// Parry drops points that a constrained normal puts more than five times as deep as the contact is
/// without constraints.
fn is_plausible(point: &ManifoldPoint, contact: &TriangleContact) -> bool {
    contact.distance >= 0.0 || point.distance >= 0.0 || point.distance >= 5.0 * contact.distance
}

/// Parry's names of the features of a point.
fn names_of(point: &ManifoldPoint, names: &Names) -> [PackedFeatureId; 2] {
    names[usize::from(point.features.to_bits() & FeaturePair::MASK)]
}

/// Whether the points are those of the step before, in the same order: mostly they are.
fn have_names<C>(tracked: &[TrackedContact<C>], points: &[ManifoldPoint], names: &Names) -> bool {
    let is_same = |(old, new): (&TrackedContact<C>, &ManifoldPoint)| {
        [old.fid1, old.fid2] == names_of(new, names)
    };
    tracked.len() == points.len() && tracked.iter().zip(points).all(is_same)
}

/// Makes `tracked` the contacts of other points, of which some were there before and keep their
/// data.
fn rename<C: Default + Copy>(
    tracked: &mut Vec<TrackedContact<C>>,
    points: &[ManifoldPoint],
    names: &Names,
    previous: &mut Vec<TrackedContact<C>>,
) {
    std::mem::swap(tracked, previous);
    tracked.clear();
    tracked.extend(points.iter().map(|point| {
        let [fid1, fid2] = names_of(point, names);
        let is_this = |old: &&TrackedContact<C>| old.fid1 == fid1 && old.fid2 == fid2;
        let fresh = || TrackedContact::new(Vector::ZERO, Vector::ZERO, fid1, fid2, 0.0);
        previous.iter().find(is_this).copied().unwrap_or_else(fresh)
    }));
}

/// By [`FeaturePair::to_bits`].
type Names = [[PackedFeatureId; 2]; FeaturePair::MASK as usize + 1];

/// Parry's names of the features: made once, as Parry's own constructors are not inlined and took a
/// twentieth of a query.
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
    /// Brings the manifold of two triangles up to date, `triangle2` at `pos12` in the frame of
    /// `triangle1`.
    ///
    /// The manifold has no points if the triangles are farther apart than `prediction`, if the
    /// normal constraints reject the contact, or if a number is not finite.
    pub fn update<M>(
        &mut self,
        pos12: &Pose,
        triangles: [&Triangle; 2],
        normal_constraints: [Option<&dyn NormalConstraints>; 2],
        prediction: Real,
        manifold: &mut ContactManifold<M, C>,
    ) {
        let pose = PairPose::new(pos12, prediction);
        let triangles = local_pair(&pose.placement12, &triangles.map(|triangle| *triangle));
        let mut points = ManifoldPoints::new();
        let [t1, t2] = &triangles.corners;
        let within = f64::from(prediction);
        let contact = manifold_of(t1, t2, within, within, self.features, &mut points);
        self.features = contact.map(|contact| contact.features);
        match contact {
            Some(contact) => fill(
                &pose,
                &triangles,
                &contact,
                &mut points,
                normal_constraints,
                &mut self.previous_points,
                manifold,
            ),
            None => manifold.points.clear(),
        }
    }
}
