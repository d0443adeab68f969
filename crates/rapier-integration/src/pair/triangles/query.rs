use glamx::DVec3;
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::{
    ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher, TrackedContact,
};
use parry3d::shape::Triangle;
use sbbk_core::contact::{
    FeaturePair, ManifoldPoints, Outward, TriangleContact, clip, contact, contact_from, outward,
    push_closest,
};
use sbbk_core::query::TrianglePair;
use sbbk_core::surface::{Around, Side};
use sbbk_core::traverse::{Counters, GREATEST_SLACK};

use super::exact::{Constraints, fill, local_pair};
use super::regions::Regions;
use crate::ContactGenerator;
use crate::pair::driver::{Limits, Moving, PairQuery, Scratch, Seen};
use crate::pair::order::{Candidate, OrderKey};
use crate::pair::pose::PairPose;

/// The features that were closest at the last query, to be tried first.
pub(super) type Hint = Option<FeaturePair>;

/// Two shapes made of triangles.
pub(crate) trait TriangleShapes {
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

    /// A mesh of which the surface is known.
    fn around(&self, _: usize) -> Option<Around<'_>> {
        None
    }

    /// The distance up to which contacts must be local minima.
    fn near(&self) -> f64 {
        0.0
    }

    /// Whether a point is in one of the meshes, deeper than some distance.
    fn is_deep(&self, _: usize, _: Vector, _: Real) -> bool {
        false
    }

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

impl<S: TriangleShapes> TriangleQuery<'_, S> {
    /// The contact that belongs to the set.
    fn judged(
        &self,
        subshapes: [u32; 2],
        local: &TrianglePair,
        contact: TriangleContact,
        regions: &mut Regions,
    ) -> Seen<TriangleContact> {
        let around = [self.shapes.around(0), self.shapes.around(1)];
        if around.iter().all(Option::is_none) {
            return Seen::Contact(contact);
        }
        let inverse = self.pose.placement12.inverse;
        let side = |i: usize, feature, direction: DVec3| {
            let local = if i == 0 { direction } else { inverse * direction };
            around[i].map_or(Side::Front, |around| around.side(subshapes[i], feature, local))
        };
        let TriangleContact { normal, distance, features, .. } = contact;
        let solid = around.map(|around| around.is_some_and(|around| around.is_solid));
        let is_crossing = features.is_crossing();
        if !is_crossing {
            if distance > self.shapes.near() {
                return Seen::Contact(contact);
            }
            let sides =
                [side(0, features.feature1(), normal), side(1, features.feature2(), -normal)];
            if sides == [Side::Front; 2] {
                return Seen::Contact(contact);
            }
            let is_in = |i: usize| !solid[i] || sides[i] == Side::Behind;
            if !(solid[0] || solid[1]) || !(is_in(0) && is_in(1)) {
                return Seen::Nothing;
            }
        }
        if !(solid[0] || solid[1]) {
            return Seen::Contact(contact);
        }
        let [t1, t2] = &local.corners;
        let is_front = |i, feature, direction| side(i, feature, direction) == Side::Front;
        let Some(Outward { contact, is_extremal }) = outward(t1, t2, solid, is_front) else {
            return Seen::Nothing;
        };
        let cap = 5.0 * distance.abs().max(f64::from(self.pose.prediction));
        let is_shallow = contact.distance >= -cap;
        let is_good = is_extremal && is_shallow;
        if !is_crossing && !is_good && distance.abs() < 1.0e-9 {
            return Seen::Nothing;
        }
        if regions.is_collecting {
            regions.pairs.push((subshapes, is_good));
            return if is_good { Seen::Contact(contact) } else { Seen::Later };
        }
        if is_good || is_shallow && regions.is_lost(subshapes) {
            return Seen::Contact(contact);
        }
        if !is_extremal || !regions.is_lost(subshapes) {
            return Seen::Nothing;
        }
        // Deep: only if the other side of a body is not much nearer.
        let within = (contact.distance / -5.0) as Real;
        let origin = local.origin.as_dvec3();
        let point2 = (origin + contact.point2).as_vec3();
        let point1 = self.pose.placement12.to_frame2(contact.point1, local.origin).as_vec3();
        let is_deep =
            self.shapes.is_deep(0, point2, within) || self.shapes.is_deep(1, point1, within);
        if is_deep { Seen::Contact(contact) } else { Seen::Nothing }
    }
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
        let contact = match self.judged(candidate.subshapes, &local, contact, &mut scratch.regions)
        {
            Seen::Contact(contact) => contact,
            Seen::Nothing => return Seen::Nothing,
            Seen::Later => return Seen::Later,
        };
        clip(t1, t2, contact.normal, &mut self.points);
        push_closest(t1, t2, &contact, &mut self.points);
        let deepest = -self.shapes.near();
        for point in &mut self.points {
            point.distance = point.distance.max(deepest);
        }
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
