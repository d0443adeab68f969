use parry3d::math::{Pose, Real};
use parry3d::query::{
    ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher, TrackedContact,
};
use parry3d::shape::Triangle;
use sbbk_core::contact::{
    FeaturePair, ManifoldPoints, TriangleContact, clip, contact, contact_from, push_closest,
};
use sbbk_core::query::TrianglePair;
use sbbk_core::traverse::{Counters, GREATEST_SLACK};

use super::exact::{Constraints, fill, local_pair};
use super::judge::{Judge, Surfaces};
use crate::ContactGenerator;
use crate::pair::driver::{Limits, Moving, PairQuery, Scratch, Seen};
use crate::pair::order::{Candidate, OrderKey};
use crate::pair::pose::PairPose;

/// The features that were closest at the last query, to be tried first.
pub(super) type Hint = Option<FeaturePair>;

/// Two shapes made of triangles.
pub(crate) trait TriangleShapes: Surfaces {
    /// What moves.
    fn moving(&self) -> Moving<'_>;

    /// Adds all pairs of triangles within `margin`, and few others, with their places in the order
    /// of manifolds.
    fn descend(
        &self,
        margin: Real,
        counters: &mut impl Counters,
        scratch: &mut Scratch,
        found: &mut Vec<(OrderKey, [u32; 2])>,
    );

    /// The triangles; `None` if one does not exist.
    fn triangles(&self, triangles: [u32; 2]) -> Option<[Triangle; 2]>;

    /// Hands on the cones that the normals of both must be in.
    fn with_constraints(&self, triangles: [u32; 2], then: impl FnOnce(Constraints<'_>));
}

/// A query about two shapes made of triangles.
pub(crate) struct TriangleQuery<'q, S> {
    pub(super) shapes: S,
    pub(super) pose: &'q PairPose,
    /// The pose that stock Parry passes on, bit for bit.
    pub(super) parrys_pose: Pose,
    pub(super) generator: ContactGenerator,
    /// Of the contact found last.
    pub(super) points: ManifoldPoints,
}

/// A contact within the prediction distance. Its points are in [`TriangleQuery::points`].
pub(crate) struct Found {
    triangles: [Triangle; 2],
    local: TrianglePair,
    contact: TriangleContact,
}

impl<S: TriangleShapes> PairQuery for TriangleQuery<'_, S> {
    type Hint = Hint;
    type Contact = Found;

    const GREATEST_SLACK: f64 = GREATEST_SLACK;

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
        let mut ordered = std::mem::take(&mut scratch.ordered);
        ordered.clear();
        self.shapes.descend(margin, counters, scratch, &mut ordered);
        ordered.sort_unstable();
        candidates.extend(ordered.iter().map(|&(_, subshapes)| Candidate::new(subshapes)));
        scratch.ordered = ordered;
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
        let contact = match judge.verdict(&local, contact, &mut scratch.regions, &mut self.points) {
            Seen::Contact(contact) => contact,
            Seen::Nothing => return Seen::Nothing,
            Seen::Later => return Seen::Later,
            Seen::Same => return Seen::Same,
        };
        if self.points.is_empty() {
            clip(t1, t2, contact.normal, &mut self.points);
            push_closest(t1, t2, &contact, &mut self.points);
        }
        let deepest = -self.shapes.near();
        self.points.iter_mut().for_each(|point| point.distance = point.distance.max(deepest));
        Seen::Contact(Found { triangles, local, contact })
    }

    fn needs_more(&mut self, scratch: &mut Scratch) -> bool {
        scratch.regions.close()
    }

    #[inline(always)]
    fn write<M, C>(
        &mut self,
        Found { triangles, local, contact }: Found,
        candidate: &mut Candidate<Hint>,
        _: Limits,
        _: &mut Scratch,
        previous_points: &mut Vec<TrackedContact<C>>,
        manifold: &mut ContactManifold<M, C>,
    ) where
        M: Default + Clone + Send + Sync,
        C: Default + Copy + Send + Sync,
    {
        let Self { shapes, pose, parrys_pose, generator, points } = self;
        shapes.with_constraints(candidate.subshapes, |constraints| match generator {
            ContactGenerator::Exact => {
                fill(pose, &local, &contact, points, constraints, previous_points, manifold);
            }
            ContactGenerator::Parry => {
                // Two triangles are a pair that Parry supports.
                let _ = DefaultQueryDispatcher.contact_manifold_convex_convex(
                    parrys_pose,
                    &triangles[0],
                    &triangles[1],
                    constraints[0],
                    constraints[1],
                    pose.prediction,
                    manifold,
                );
            }
        });
    }
}
