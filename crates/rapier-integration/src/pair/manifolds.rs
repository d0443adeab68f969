//! From candidates to manifolds, keeping those of the step before.

use parry3d::math::Pose;
use parry3d::query::details::NormalConstraints;
use parry3d::query::{
    ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher, TrackedContact,
};
use parry3d::shape::{Triangle, TrianglePseudoNormals};
use sbbk_core::contact::{FeaturePair, ManifoldPoints, TriangleContact};
use sbbk_core::traverse::PairFrame;

use super::candidates::{Candidate, OrderKey, Scratch};
use super::coherence::Coherence;
use super::exact::{Constraints, LocalTriangles, fill};
use super::previous::Previous;
use super::query::MeshPair;
use super::state::History;
use crate::ContactGenerator;
use crate::mesh::PreparedMesh;

/// One query, after its descent.
pub(super) struct Generator<'a> {
    pub(super) pair: MeshPair<'a>,
    pub(super) prepared: [&'a PreparedMesh; 2],
    pub(super) frame: &'a PairFrame,
    pub(super) flipped: bool,
    pub(super) contacts: ContactGenerator,
}

impl Generator<'_> {
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
        let key = |triangles| OrderKey::new(self.prepared, self.flipped, triangles);
        let mut previous = Previous::new(manifolds, key, &mut scratch.previous);
        let mut points = ManifoldPoints::new();
        for candidate in &scratch.candidates {
            let kept = previous.find(candidate.key, manifolds, history);
            let features = kept.and_then(|place| history.contacts[place]).or(candidate.features);
            let triangles = self.triangles(candidate);
            let local = LocalTriangles::new(self.frame.placement(), &triangles);
            let contact = self.contact(candidate, &local, features, coherence, &mut points);
            let Some(contact) = contact else {
                if let Some(place) = kept {
                    history.retire(std::mem::take(&mut manifolds[place]));
                }
                continue;
            };
            let mut fresh = None;
            let manifold = match kept {
                Some(place) => &mut manifolds[place],
                None => fresh.insert(history.manifold(candidate.triangle1, candidate.triangle2)),
            };
            let (answer, previous_points) = ((&contact, &mut points), &mut history.previous_points);
            self.fill(candidate, (&triangles, &local), answer, previous_points, manifold);
            history.keep(std::mem::take(manifold), contact.features);
        }
        previous.retire_rest(manifolds, history);
        history.end(manifolds);
    }

    #[inline(always)]
    fn triangles(&self, candidate: &Candidate) -> [Triangle; 2] {
        let MeshPair { mesh1, mesh2, .. } = self.pair;
        [mesh1.triangle(candidate.triangle1), mesh2.triangle(candidate.triangle2)]
    }

    /// The contact of a candidate at the present pose, if it is within the prediction distance, and its points.
    #[inline(always)]
    fn contact(
        &self,
        candidate: &Candidate,
        local: &LocalTriangles,
        features: Option<FeaturePair>,
        coherence: &mut Coherence<Candidate>,
        points: &mut ManifoldPoints,
    ) -> Option<TriangleContact> {
        let prediction = self.pair.prediction;
        let contact = local.contact((self.frame.margin(), prediction), features, points);
        coherence.note(candidate, contact.as_ref());
        // A descent with slack finds pairs that are farther apart than the prediction distance.
        contact.filter(|contact| contact.distance <= f64::from(prediction))
    }

    /// Gives the manifold of a candidate its points; none if the normal constraints reject the contact.
    fn fill<M, C>(
        &self,
        candidate: &Candidate,
        ([triangle1, triangle2], local): (&[Triangle; 2], &LocalTriangles),
        answer: (&TriangleContact, &mut ManifoldPoints),
        previous_points: &mut Vec<TrackedContact<C>>,
        manifold: &mut ContactManifold<M, C>,
    ) where
        M: Default + Clone + Send + Sync,
        C: Default + Copy + Send + Sync,
    {
        let mut fresh = [None, None];
        let constraints = self.constraints(candidate, &mut fresh);
        match self.contacts {
            ContactGenerator::Exact => {
                let placed = (self.frame.placement(), self.pair.pos12);
                fill(placed, local, answer, constraints, previous_points, manifold);
            }
            ContactGenerator::Parry => {
                // Two triangles are a pair that Parry supports.
                let _ = DefaultQueryDispatcher.contact_manifold_convex_convex(
                    &self.parrys_pose(),
                    triangle1,
                    triangle2,
                    constraints[0],
                    constraints[1],
                    self.pair.prediction,
                    manifold,
                );
            }
        }
    }

    #[inline(always)]
    fn constraints<'a>(
        &'a self,
        candidate: &Candidate,
        [fresh1, fresh2]: &'a mut [Option<TrianglePseudoNormals>; 2],
    ) -> Constraints<'a> {
        let [prepared1, prepared2] = self.prepared;
        let MeshPair { mesh1, mesh2, .. } = self.pair;
        let cone1 = prepared1.normal_constraints(mesh1, candidate.triangle1, fresh1);
        let cone2 = prepared2.normal_constraints(mesh2, candidate.triangle2, fresh2);
        [cone1, cone2].map(|cone| cone.map(|cone| cone as &dyn NormalConstraints))
    }

    /// The pose that stock Parry passes on: bit for bit, it inverts the pose twice if it does not swap the meshes.
    fn parrys_pose(&self) -> Pose {
        if self.flipped { *self.pair.pos12 } else { self.pair.pos12.inverse().inverse() }
    }
}
