//! From candidates to manifolds, keeping those of the step before.

use parry3d::math::Pose;
use parry3d::query::details::NormalConstraints;
use parry3d::query::{
    ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher, TrackedContact,
};
use parry3d::shape::Triangle;
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

/// Two triangles that touch.
struct Touching {
    triangles: [Triangle; 2],
    local: LocalTriangles,
    contact: TriangleContact,
}

impl Generator<'_> {
    /// Replaces `manifolds` by those of the candidates that touch, in stock order. Manifolds of pairs of triangles
    /// that still do keep their data; none is left empty. The candidates of a descent are kept for later queries.
    pub(super) fn update<M, C>(
        &self,
        scratch: &mut Scratch,
        mut descent: Option<&mut Coherence<Candidate>>,
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
            let touching = self.touching(candidate, features, &mut descent, &mut points);
            let mut manifold = match kept {
                Some(place) => std::mem::take(&mut manifolds[place]),
                None if touching.is_none() => continue,
                None => history.manifold(candidate.triangle1, candidate.triangle2),
            };
            match touching {
                Some(touching) => {
                    let answer = (&touching, &mut points);
                    self.fill(candidate, answer, &mut history.previous_points, &mut manifold);
                    history.keep(manifold, touching.contact.features);
                }
                None => history.retire(manifold),
            }
        }
        previous.retire_rest(manifolds, history);
        history.end(manifolds);
    }

    /// The contact of a candidate at the present pose, if it is within the prediction distance, and its points.
    fn touching(
        &self,
        candidate: &Candidate,
        features: Option<FeaturePair>,
        descent: &mut Option<&mut Coherence<Candidate>>,
        points: &mut ManifoldPoints,
    ) -> Option<Touching> {
        let MeshPair { mesh1, mesh2, prediction, .. } = self.pair;
        let triangles = [mesh1.triangle(candidate.triangle1), mesh2.triangle(candidate.triangle2)];
        let local = LocalTriangles::new(self.frame.placement(), &triangles[0], &triangles[1]);
        let contact = local.contact(self.frame.margin(), features, points)?;
        if let Some(coherence) = descent {
            let candidate = Candidate { features: Some(contact.features), ..*candidate };
            coherence.keep(candidate, contact.distance);
        }
        // A descent with slack finds pairs that are farther apart than the prediction distance.
        let is_near = contact.distance <= f64::from(prediction);
        is_near.then_some(Touching { triangles, local, contact })
    }

    /// Gives the manifold of a candidate its points; none if the normal constraints reject the contact.
    fn fill<M, C>(
        &self,
        candidate: &Candidate,
        (touching, points): (&Touching, &mut ManifoldPoints),
        previous_points: &mut Vec<TrackedContact<C>>,
        manifold: &mut ContactManifold<M, C>,
    ) where
        M: Default + Clone + Send + Sync,
        C: Default + Copy + Send + Sync,
    {
        let Touching { triangles: [triangle1, triangle2], local, contact } = touching;
        let constraints = self.constraints(candidate);
        match self.contacts {
            ContactGenerator::Exact => {
                let placed = (self.frame.placement(), self.pair.pos12);
                fill(placed, local, (contact, points), constraints, previous_points, manifold);
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

    fn constraints(&self, candidate: &Candidate) -> Constraints<'_> {
        let cone = |mesh: usize, triangle: u32| {
            let cone = self.prepared[mesh].normal_constraints(triangle);
            cone.map(|cone| cone as &dyn NormalConstraints)
        };
        [cone(0, candidate.triangle1), cone(1, candidate.triangle2)]
    }

    /// The pose that stock Parry passes on: bit for bit, it inverts the pose twice if it does not swap the meshes.
    fn parrys_pose(&self) -> Pose {
        if self.flipped { *self.pair.pos12 } else { self.pair.pos12.inverse().inverse() }
    }
}
