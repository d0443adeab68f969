use glamx::DVec3;
use parry3d::math::Real;
use parry3d::query::{ContactManifold, TrackedContact};
use parry3d::shape::Triangle;
use sbbk_core::contact::{
    FeaturePair, ManifoldPoints, TriangleContact, clip, contact, contact_from, push_closest,
};
use sbbk_core::traverse::{Counters, SlackLimits};

use super::exact::{Constraints, constrained_normal, fill, local_pair};
use super::judge::{Judge, Surfaces};
use crate::pair::driver::{ContactList, Limits, Moving, PairQuery, Scratch, Seen};
use crate::pair::order::{Candidate, push_candidate};
use crate::pair::outline::{Outline, PatchPlan};
use crate::pair::pose::PairPose;

/// The features that were closest at the last query, to be tried first.
pub(super) type Hint = Option<FeaturePair>;

/// Two shapes made of triangles.
pub(crate) trait TriangleShapes: Surfaces {
    /// What moves.
    fn moving(&self) -> Moving<'_>;

    /// Calls `found` with all pairs of triangles within `margin`, and few others.
    fn descend(
        &self,
        margin: Real,
        counters: &mut impl Counters,
        scratch: &mut Scratch,
        found: impl FnMut([u32; 2]),
    );

    /// The triangles; `None` if one does not exist.
    fn triangles(&self, triangles: [u32; 2]) -> Option<[Triangle; 2]>;

    /// The direction in which shape 2 leaves shape 1, if one is deep in the other.
    fn way_apart(&self) -> Option<DVec3> {
        None
    }

    /// If nothing touches: the contact that takes one shape out of the other, as two meshes have it.
    fn inside(
        &self,
        _is_deep: bool,
        _outside: &mut f64,
        _travel: f64,
    ) -> Option<([u32; 2], TriangleContact)> {
        None
    }

    /// Hands on the cones of both triangles.
    fn with_cones(&self, triangles: [u32; 2], then: impl FnOnce(Constraints<'_>));

    /// Hands on the cones that the normals of both must be in. Surfaces have what cones are for, and no
    /// cone to lean out of: stacks of flagged cubes stand.
    #[inline(always)]
    fn with_constraints(&self, triangles: [u32; 2], then: impl FnOnce(Constraints<'_>)) {
        if self.has_surface() { then([None; 2]) } else { self.with_cones(triangles, then) }
    }
}

/// The least limit of depths, in prediction distances. Rapier recycles contacts until bodies have moved
/// by 2.5 of its own: lower, a small body that is deep in another moves out by as much as its contacts
/// are deep, and falls asleep there.
const RECYCLED: f64 = 4.0;

/// A query about two shapes made of triangles.
pub(crate) struct TriangleQuery<'q, S> {
    pub(super) shapes: S,
    pub(super) pose: &'q PairPose,
    pub(super) patches: Option<PatchPlan>,
    /// Memory for the points of a contact.
    pub(super) points: ManifoldPoints,
}

/// A contact within the prediction distance.
#[derive(Copy, Clone)]
pub(crate) struct Found {
    contact: TriangleContact,
    of: Of,
}

/// What a contact is of.
#[derive(Copy, Clone, PartialEq)]
enum Of {
    /// Two triangles: its closest points are contacts too.
    Triangles,
    /// Two triangles, along an axis that leads out of solids.
    Axis,
    /// Whole shapes, one in the other.
    Shapes,
}

impl Of {
    /// The cones that the normal of the contact must be in.
    fn constraints(self, of_triangles: Constraints<'_>) -> Constraints<'_> {
        if self == Self::Shapes { [None; 2] } else { of_triangles }
    }
}

impl<S: TriangleShapes> PairQuery for TriangleQuery<'_, S> {
    type Hint = Hint;
    type Contact = Found;

    const SLACK: SlackLimits = SlackLimits::TRIANGLES;

    fn pose(&self) -> &PairPose {
        self.pose
    }

    fn moving(&self) -> Moving<'_> {
        self.shapes.moving()
    }

    fn descend(
        &mut self,
        margin: Real,
        counters: &mut impl Counters,
        scratch: &mut Scratch,
        candidates: &mut Vec<Candidate<Hint>>,
    ) {
        self.shapes.descend(margin, counters, scratch, |subshapes| {
            candidates.push(Candidate::new(subshapes));
        });
    }

    #[inline(always)]
    fn contact(
        &mut self,
        candidate: &mut Candidate<Hint>,
        limits: Limits,
        scratch: &mut Scratch,
    ) -> Seen<Found> {
        if scratch.regions.is_settled(candidate.subshapes) {
            return Seen::Same;
        }
        let Some(triangles) = self.shapes.triangles(candidate.subshapes) else {
            return Seen::Nothing;
        };
        let local = local_pair(&self.pose.placement12, &triangles);
        let [t1, t2] = &local.corners;
        let Limits { reach, margin, travel } = limits;
        let contact = match candidate.hint {
            Some(hint) => contact_from(t1, t2, margin, hint),
            None => contact(t1, t2, margin),
        };
        // Without the travel it would be asked for in each query.
        candidate.clear = contact.map_or(margin, |contact| contact.distance) + travel;
        let Some(contact) = contact else {
            return Seen::Nothing;
        };
        candidate.hint = Some(contact.features);
        // A descent with slack finds pairs that are farther apart than the prediction distance.
        if contact.distance > reach {
            return Seen::Nothing;
        }
        let judge = Judge { shapes: &self.shapes, pose: self.pose, pair: candidate.subshapes };
        let points = &mut self.points;
        let contact = judge.verdict(&local, contact, &mut scratch.regions, points);
        let of = if points.is_empty() { Of::Triangles } else { Of::Axis };
        contact.map(|contact| Found { contact, of }).into()
    }

    fn needs_more(&mut self, scratch: &mut Scratch) -> bool {
        let way = scratch.regions.is_undecided().then(|| self.shapes.way_apart()).flatten();
        scratch.regions.close(way)
    }

    fn settle(
        &mut self,
        candidates: &mut Vec<Candidate<Hint>>,
        contacts: &mut ContactList<Found>,
        limits: Limits,
        outside: &mut f64,
        scratch: &mut Scratch,
    ) {
        if !contacts.is_empty() {
            return;
        }
        let is_deep = scratch.regions.has_way();
        if let Some((triangles, contact)) = self.shapes.inside(is_deep, outside, limits.travel) {
            let found = Found { contact, of: Of::Shapes };
            contacts.push((push_candidate(candidates, triangles), found));
        }
    }

    fn contacts(scratch: &mut Scratch) -> &mut [ContactList<Found>; 2] {
        &mut scratch.triangle_contacts
    }

    /// Where all contacts are far, a patch a direction. Of more than four points of one Rapier's
    /// solver leaves out those beyond the prediction distance without soft CCD: a plate that falls
    /// flat would turn about one point, and through what it falls on.
    fn patch_plan(&self, contacts: &[(u32, Found)]) -> Option<PatchPlan> {
        let near = self.shapes.near();
        let are_far = contacts.iter().all(|(_, found)| found.contact.distance > near);
        let may_be_far = f64::from(self.pose.prediction) > near;
        if may_be_far && are_far {
            return Some(PatchPlan::FAR);
        }
        self.patches
    }

    fn outline(
        &self,
        Found { contact, of }: &Found,
        candidate: &Candidate<Hint>,
        _: &mut Scratch,
    ) -> Option<Outline> {
        let TriangleContact { distance, point1, .. } = *contact;
        let [triangle1, _] = self.shapes.triangles(candidate.subshapes)?;
        let pos12 = &self.pose.pos12;
        let (mut normal, mut has_cones) = (None, false);
        self.shapes.with_constraints(candidate.subshapes, |constraints| {
            let constraints = of.constraints(constraints);
            normal = constrained_normal(contact, constraints, pos12);
            has_cones = constraints.iter().any(Option::is_some);
        });
        let point = (triangle1.a.as_dvec3() + point1).as_vec3();
        let normal = normal?.normal;
        let distance = distance as Real;
        Some(Outline { part: 0, normal, point, distance, has_cones })
    }

    #[inline(always)]
    fn write<M, C>(
        &mut self,
        Found { contact, of }: Found,
        candidate: &mut Candidate<Hint>,
        _: Limits,
        _: &mut Scratch,
        previous_points: &mut Vec<TrackedContact<C>>,
        manifold: &mut ContactManifold<M, C>,
    ) where
        M: Default + Clone + Send + Sync,
        C: Default + Copy + Send + Sync,
    {
        let Self { shapes, pose, points, .. } = self;
        let Some(triangles) = shapes.triangles(candidate.subshapes) else {
            return manifold.points.clear();
        };
        shapes.with_constraints(candidate.subshapes, |constraints| {
            let constraints = of.constraints(constraints);
            let local = local_pair(&pose.placement12, &triangles);
            let [t1, t2] = &local.corners;
            points.clear();
            if of != Of::Shapes {
                clip(t1, t2, contact.normal, points);
            }
            if of == Of::Axis {
                deepen(points, &contact);
            } else {
                push_closest(t1, t2, &contact, points);
            }
            let deepest = -shapes.near().max(RECYCLED * f64::from(pose.prediction));
            points.iter_mut().for_each(|point| point.distance = point.distance.max(deepest));
            fill(pose, &local, &contact, points, constraints, previous_points, manifold);
        });
    }
}

/// Makes points as deep as a contact that is deeper than all of them.
fn deepen(points: &mut ManifoldPoints, contact: &TriangleContact) {
    let distances = points.iter().map(|point| point.distance);
    let beyond = distances.fold(f64::INFINITY, f64::min) - contact.distance;
    if beyond > 0.0 {
        for point in points {
            point.point1 += 0.5 * beyond * contact.normal;
            point.point2 -= 0.5 * beyond * contact.normal;
            point.distance -= beyond;
        }
    }
}
