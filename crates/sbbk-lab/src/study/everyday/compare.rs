//! The same pairs at the same poses, asked of both dispatchers with nothing known of them.

use std::collections::BTreeMap;

use glamx::Pose3;
use rapier3d::geometry::{ColliderHandle, ContactManifold, SharedShape};
use rapier3d::math::Real;
use rapier3d::pipeline::PhysicsWorld;

use super::truth::Pair;
use crate::backend::{Backend, Dispatcher, Primed};
use crate::metrics::ErrorCount;

/// Contacts this close to the prediction distance, as a share of it, may be there or not.
const SET_BAND: Real = 0.05;
/// Distances may differ by this share of the prediction distance.
const DISTANCE_BAND: Real = 0.05;

/// Contacts that SBBK has lost or added, beside stock's, which here stand for the truth.
pub(super) struct Comparison {
    dispatchers: [Dispatcher; 2],
    primed: Vec<Primed>,
    /// Pairs of colliders with a mesh, by their deepest contact, and sensors by whether they meet.
    pub pairs: ErrorCount,
    /// Triangles, or pairs of them, by their deepest contact.
    pub triangles: ErrorCount,
    /// Errors of stock and of SBBK by the truth, of the first pairs about which they differ.
    pub judged: [ErrorCount; 2],
}

/// Pairs that are judged at most: brute force takes a while.
const JUDGED: usize = 20;

/// Two shapes at a pose.
struct Question {
    shapes: [SharedShape; 2],
    pos12: Pose3,
}

impl Comparison {
    pub fn new() -> Self {
        Self {
            dispatchers: [Backend::Stock, Backend::Sbbk].map(Backend::per_triangle),
            primed: Vec::new(),
            pairs: ErrorCount::default(),
            triangles: ErrorCount::default(),
            judged: Default::default(),
        }
    }

    /// Asks about all pairs that the world's broad phase has now.
    pub fn look(&mut self, world: &PhysicsWorld) {
        let contacts = world.contact_pairs().map(|pair| [pair.collider1, pair.collider2]);
        let contacts: Vec<Question> = contacts.filter_map(|pair| question(world, pair)).collect();
        let meetings = world.intersection_pairs().map(|(one, _, two, ..)| [one, two]);
        let meetings: Vec<Question> = meetings.filter_map(|pair| question(world, pair)).collect();
        // Trees that nobody holds may be dropped after each query.
        let shapes = contacts.iter().chain(&meetings).flat_map(|question| &question.shapes);
        self.primed.push(Primed::new(&self.dispatchers[1], shapes));
        let prediction = world.integration_parameters.prediction_distance();
        contacts.iter().for_each(|question| self.compare(question, prediction));
        meetings.iter().for_each(|question| self.compare_meeting(question, prediction));
    }

    fn compare(&mut self, Question { shapes, pos12 }: &Question, prediction: Real) {
        let answers = self.dispatchers.each_ref().map(|dispatcher| {
            let mut manifolds: Vec<ContactManifold> = Vec::new();
            let [shape1, shape2] = shapes.each_ref().map(|shape| &**shape);
            // As in Rapier, an unsupported pair keeps what it had: nothing.
            let _ = dispatcher.contact_manifolds(
                pos12,
                shape1,
                shape2,
                prediction,
                &mut manifolds,
                &mut None,
            );
            manifolds
        });
        let [stock, sbbk] = answers.each_ref().map(|manifolds| deepest(manifolds));
        let before = self.triangles.wrong();
        self.pairs.mesh_pairs += 1;
        self.triangles.mesh_pairs += 1;
        let least = |distances: &BTreeMap<_, Real>| distances.values().copied().reduce(Real::min);
        count(&mut self.pairs, least(&stock), least(&sbbk), prediction);
        let others = sbbk.keys().filter(|key| !stock.contains_key(*key));
        for key in stock.keys().chain(others) {
            let [stock, sbbk] = [&stock, &sbbk].map(|distances| distances.get(key).copied());
            count(&mut self.triangles, stock, sbbk, prediction);
        }
        if self.triangles.wrong() > before && self.judged[0].mesh_pairs < JUDGED {
            let pair = Pair { shapes: shapes.each_ref(), pos12: *pos12, prediction };
            if let Some(truth) = pair.truth() {
                for (sum, manifolds) in self.judged.iter_mut().zip(&answers) {
                    *sum += truth.judge_manifolds(manifolds).pairs;
                }
            }
        }
    }

    fn compare_meeting(&mut self, Question { shapes, pos12 }: &Question, prediction: Real) {
        let [shape1, shape2] = shapes;
        let meets = self.dispatchers.each_ref().map(|dispatcher| {
            dispatcher
                .intersection_test(pos12, &**shape1, &**shape2)
                .is_ok_and(|meets| meets.intersecting)
        });
        self.pairs.mesh_pairs += 1;
        let [stock, sbbk] = meets;
        self.pairs.true_pairs += usize::from(stock);
        self.pairs.reported += usize::from(sbbk);
        self.pairs.missed += usize::from(stock && !sbbk);
        self.pairs.phantom += usize::from(sbbk && !stock);
        let is_judged = stock != sbbk && self.judged[0].mesh_pairs < JUDGED;
        let pair = Pair { shapes: shapes.each_ref(), pos12: *pos12, prediction };
        if let Some(truth) = is_judged.then(|| pair.meets()).flatten() {
            for (errors, answer) in self.judged.iter_mut().zip(meets) {
                errors.mesh_pairs += 1;
                errors.true_pairs += 1;
                errors.missed += usize::from(truth && !answer);
                errors.phantom += usize::from(answer && !truth);
            }
        }
    }
}

/// A pair with a mesh.
fn question(world: &PhysicsWorld, pair: [ColliderHandle; 2]) -> Option<Question> {
    let [one, two] = pair.map(|handle| &world.colliders[handle]);
    let shapes = [one, two].map(|collider| collider.shared_shape().clone());
    let pos12 = one.position().inv_mul(two.position());
    shapes.iter().any(|shape| shape.as_trimesh().is_some()).then_some(Question { shapes, pos12 })
}

/// The deepest point of each pair of subshapes.
fn deepest(manifolds: &[ContactManifold]) -> BTreeMap<(u32, u32), Real> {
    let mut found = BTreeMap::new();
    for manifold in manifolds {
        if let Some(distance) = manifold.points.iter().map(|point| point.dist).reduce(Real::min) {
            let least = found.entry((manifold.subshape1, manifold.subshape2)).or_insert(distance);
            *least = least.min(distance);
        }
    }
    found
}

/// Counts a contact that one or both have, by its distance.
fn count(counts: &mut ErrorCount, stock: Option<Real>, sbbk: Option<Real>, prediction: Real) {
    let is_in = |distance: Option<Real>| distance.is_some_and(|d| d <= prediction);
    let is_well_in =
        |distance: Option<Real>| distance.is_some_and(|d| d <= prediction * (1.0 - SET_BAND));
    counts.true_pairs += usize::from(is_in(stock));
    counts.reported += usize::from(is_in(sbbk));
    counts.missed += usize::from(is_well_in(stock) && !is_in(sbbk));
    counts.phantom += usize::from(is_well_in(sbbk) && !is_in(stock));
    let differ = |a: Real, b: Real| (a - b).abs() > DISTANCE_BAND * prediction;
    let both = stock.zip(sbbk).filter(|_| is_in(stock) && is_in(sbbk));
    counts.wrong_depth += usize::from(both.is_some_and(|(a, b)| differ(a, b)));
}
