//! From candidates to manifolds, keeping those of the step before.

use parry3d::math::{Pose, Real};
use parry3d::query::details::NormalConstraints;
use parry3d::query::{
    ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher, TrackedContact,
};
use parry3d::shape::Triangle;
use sbbk_core::contact::{FeaturePair, ManifoldPoints, TriangleContact};
use sbbk_core::query::TrianglePair;
use sbbk_core::traverse::Placement;

use super::candidates::{Candidate, OrderKey, Scratch};
use super::coherence::Coherence;
use super::exact::{Constraints, contact_of, fill, local_pair};
use super::previous::Previous;
use super::query::MeshPair;
use super::state::History;
use crate::ContactGenerator;
use crate::mesh::PreparedMesh;

/// Two shapes made of triangles.
pub(super) trait TriangleShapes {
    /// The place of a pair of triangles in the order of manifolds.
    fn key(&self, triangles: [u32; 2]) -> OrderKey;

    /// The triangles; `None` if one does not exist.
    fn triangles(&self, triangles: [u32; 2]) -> Option<[Triangle; 2]>;

    /// Hands on the cones that the normals of both must be in.
    fn with_constraints(&self, triangles: [u32; 2], use_them: impl FnOnce(Constraints<'_>));
}

/// Two meshes.
pub(super) struct Meshes<'a> {
    pub(super) pair: MeshPair<'a>,
    pub(super) prepared: [&'a PreparedMesh; 2],
    pub(super) flipped: bool,
}

impl TriangleShapes for Meshes<'_> {
    fn key(&self, triangles: [u32; 2]) -> OrderKey {
        OrderKey::new(self.prepared, self.flipped, triangles)
    }

    #[inline(always)]
    fn triangles(&self, [triangle1, triangle2]: [u32; 2]) -> Option<[Triangle; 2]> {
        let MeshPair { mesh1, mesh2, .. } = self.pair;
        Some([mesh1.triangle(triangle1), mesh2.triangle(triangle2)])
    }

    #[inline(always)]
    fn with_constraints(
        &self,
        [triangle1, triangle2]: [u32; 2],
        use_them: impl FnOnce(Constraints<'_>),
    ) {
        let MeshPair { mesh1, mesh2, .. } = self.pair;
        let [prepared1, prepared2] = self.prepared;
        let [mut fresh1, mut fresh2] = [None, None];
        let cone1 = prepared1.normal_constraints(mesh1, triangle1, &mut fresh1);
        let cone2 = prepared2.normal_constraints(mesh2, triangle2, &mut fresh2);
        use_them([cone1, cone2].map(|cone| cone.map(|cone| cone as &dyn NormalConstraints)));
    }
}

/// One query, after its descent.
pub(super) struct Generator<'a, S> {
    pub(super) shapes: S,
    pub(super) pos12: &'a Pose,
    pub(super) placement: &'a Placement,
    /// How far the descent has looked, and how far contacts go.
    pub(super) margin: Real,
    pub(super) prediction: Real,
    /// The pose that stock Parry passes on, bit for bit.
    pub(super) parrys_pose: Pose,
    pub(super) contacts: ContactGenerator,
}

impl<S: TriangleShapes> Generator<'_, S> {
    /// Replaces `manifolds` by those of the candidates that touch, in stock order. Manifolds of pairs of triangles
    /// that still do keep their data; none is left empty. The candidates of a descent are kept for later queries.
    pub(super) fn update<M, C>(
        &self,
        scratch: &mut Scratch,
        coherence: &mut Coherence<Candidate>,
        history: &mut History<M, C, FeaturePair>,
        manifolds: &mut Vec<ContactManifold<M, C>>,
    ) where
        M: Default + Clone + Send + Sync + 'static,
        C: Default + Copy + Send + Sync + 'static,
    {
        history.begin(manifolds);
        let key = |triangles| self.shapes.key(triangles);
        let mut previous = Previous::new(manifolds, key, &mut scratch.previous);
        let mut points = ManifoldPoints::new();
        for candidate in &scratch.candidates {
            let kept = previous.find(candidate.key, manifolds, history);
            let features = kept.and_then(|place| history.contacts[place]).or(candidate.features);
            let indices = [candidate.triangle1, candidate.triangle2];
            let known = self.shapes.triangles(indices).map(|triangles| {
                let local = local_pair(self.placement, &triangles);
                (triangles, local)
            });
            let contact = known.as_ref().and_then(|(_, local)| {
                self.contact(candidate, local, features, coherence, &mut points)
            });
            let (Some((triangles, local)), Some(contact)) = (known, contact) else {
                if let Some(place) = kept {
                    history.retire(std::mem::take(&mut manifolds[place]));
                }
                continue;
            };
            let mut fill = |previous_points: &mut _, manifold: &mut _| {
                let answer = (&contact, &mut points);
                self.fill(candidate, (&triangles, &local), answer, previous_points, manifold);
            };
            if let Some(place) = kept {
                fill(&mut history.previous_points, &mut manifolds[place]);
                history.keep_at(place, contact.features, manifolds);
            } else {
                let mut manifold = history.manifold(candidate.triangle1, candidate.triangle2);
                fill(&mut history.previous_points, &mut manifold);
                history.keep(manifold, contact.features, manifolds);
            }
        }
        previous.retire_rest(manifolds, history);
        history.end(manifolds);
    }

    /// The contact of a candidate at the present pose, if it is within the prediction distance, and its points.
    #[inline(always)]
    fn contact(
        &self,
        candidate: &Candidate,
        local: &TrianglePair,
        features: Option<FeaturePair>,
        coherence: &mut Coherence<Candidate>,
        points: &mut ManifoldPoints,
    ) -> Option<TriangleContact> {
        let prediction = self.prediction;
        let contact = contact_of(local, (self.margin, prediction), features, points);
        coherence.note(candidate, contact.as_ref());
        // A descent with slack finds pairs that are farther apart than the prediction distance.
        contact.filter(|contact| contact.distance <= f64::from(prediction))
    }

    /// Gives the manifold of a candidate its points; none if the normal constraints reject the contact.
    fn fill<M, C>(
        &self,
        candidate: &Candidate,
        ([triangle1, triangle2], local): (&[Triangle; 2], &TrianglePair),
        answer: (&TriangleContact, &mut ManifoldPoints),
        previous_points: &mut Vec<TrackedContact<C>>,
        manifold: &mut ContactManifold<M, C>,
    ) where
        M: Default + Clone + Send + Sync,
        C: Default + Copy + Send + Sync,
    {
        let indices = [candidate.triangle1, candidate.triangle2];
        self.shapes.with_constraints(indices, |constraints| match self.contacts {
            ContactGenerator::Exact => {
                let placed = (self.placement, self.pos12);
                fill(placed, local, answer, constraints, previous_points, manifold);
            }
            ContactGenerator::Parry => {
                // Two triangles are a pair that Parry supports.
                let _ = DefaultQueryDispatcher.contact_manifold_convex_convex(
                    &self.parrys_pose,
                    triangle1,
                    triangle2,
                    constraints[0],
                    constraints[1],
                    self.prediction,
                    manifold,
                );
            }
        });
    }
}
