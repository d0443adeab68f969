//! From candidates to manifolds, keeping those of the step before.

use parry3d::math::Pose;
use parry3d::query::details::NormalConstraints;
use parry3d::query::{ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher};
use sbbk_core::contact::FeaturePair;
use sbbk_core::traverse::PairFrame;

use super::candidates::{Candidate, OrderKey, Scratch};
use super::coherence::Coherence;
use super::exact::{Constraints, LocalTriangles, fill};
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

/// The manifold of a pair of triangles, and the features of the step before if they are known.
struct Kept<M, C> {
    manifold: ContactManifold<M, C>,
    features: Option<FeaturePair>,
}

impl Generator<'_> {
    /// Replaces `manifolds` by those of the candidates that touch, in stock order. Manifolds of pairs of triangles
    /// that still do keep their data; none is left empty. The candidates of a descent are kept for later queries.
    pub(super) fn update<M, C>(
        &self,
        scratch: &mut Scratch,
        mut descent: Option<&mut Coherence>,
        history: &mut History<M, C>,
        manifolds: &mut Vec<ContactManifold<M, C>>,
    ) where
        M: Default + Clone + Send + Sync + 'static,
        C: Default + Copy + Send + Sync + 'static,
    {
        self.order_previous(manifolds, &mut scratch.previous);
        if !history.is_of(manifolds) {
            // Somebody else's manifolds: their features are not known.
            history.features.clear();
            history.features.resize(manifolds.len(), None);
        }
        let mut previous = scratch.previous.iter().peekable();
        for candidate in &scratch.candidates {
            let mut kept = None;
            while let Some(&&(key, place)) = previous.peek().filter(|old| old.0 <= candidate.key) {
                previous.next();
                let manifold = std::mem::take(&mut manifolds[place as usize]);
                if key == candidate.key && kept.is_none() {
                    kept = Some(Kept { manifold, features: history.features[place as usize] });
                } else {
                    history.retire(manifold);
                }
            }
            let kept = kept.unwrap_or_else(|| Kept {
                manifold: history.manifold(candidate.triangle1, candidate.triangle2),
                features: None,
            });
            let Kept { manifold, features } =
                self.generate(candidate, kept, &mut descent, &mut history.previous_points);
            if manifold.points.is_empty() {
                history.retire(manifold);
            } else {
                history.next.push(manifold);
                history.next_features.push(features);
            }
        }
        for &(_, place) in previous {
            history.retire(std::mem::take(&mut manifolds[place as usize]));
        }
        manifolds.clear();
        std::mem::swap(manifolds, &mut history.next);
        history.features.clear();
        std::mem::swap(&mut history.features, &mut history.next_features);
    }

    /// The previous manifolds in stock order, which they are in unless somebody else touched them.
    fn order_previous<M, C>(
        &self,
        manifolds: &[ContactManifold<M, C>],
        previous: &mut Vec<(OrderKey, u32)>,
    ) {
        previous.clear();
        previous.extend(manifolds.iter().enumerate().map(|(place, manifold)| {
            let triangles = [manifold.subshape1, manifold.subshape2];
            (OrderKey::new(self.prepared, self.flipped, triangles), place as u32)
        }));
        if !previous.is_sorted() {
            previous.sort_unstable();
        }
    }

    /// The manifold of a candidate at the present pose; without points if it is beyond the prediction distance.
    fn generate<M, C>(
        &self,
        candidate: &Candidate,
        Kept { mut manifold, features }: Kept<M, C>,
        descent: &mut Option<&mut Coherence>,
        previous_points: &mut Vec<parry3d::query::TrackedContact<C>>,
    ) -> Kept<M, C>
    where
        M: Default + Clone + Send + Sync,
        C: Default + Copy + Send + Sync,
    {
        let MeshPair { pos12, mesh1, mesh2, prediction } = self.pair;
        let triangle1 = mesh1.triangle(candidate.triangle1);
        let triangle2 = mesh2.triangle(candidate.triangle2);
        let triangles = LocalTriangles::new(self.frame.placement(), &triangle1, &triangle2);
        let contact = triangles.contact(self.frame.margin(), features);
        if let (Some(contact), Some(coherence)) = (&contact, descent) {
            coherence.keep(*candidate, contact.distance);
        }
        // A descent with slack finds pairs that are farther apart than the prediction distance.
        let Some(contact) = contact.filter(|c| c.distance <= f64::from(prediction)) else {
            manifold.points.clear();
            return Kept { manifold, features: None };
        };
        let constraints = self.constraints(candidate);
        match self.contacts {
            ContactGenerator::Exact => fill(
                (self.frame.placement(), pos12),
                &triangles,
                &contact,
                constraints,
                previous_points,
                &mut manifold,
            ),
            ContactGenerator::Parry => {
                // Two triangles are a pair that Parry supports.
                let _ = DefaultQueryDispatcher.contact_manifold_convex_convex(
                    &self.parrys_pose(),
                    &triangle1,
                    &triangle2,
                    constraints[0],
                    constraints[1],
                    prediction,
                    &mut manifold,
                );
            }
        }
        Kept { manifold, features: Some(contact.features) }
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
