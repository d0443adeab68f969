//! The error count, against answers with known faults.

use rapier3d::geometry::{ContactManifold, SharedShape};
use rapier3d::math::{Pose, Real, Vector};
use sbbk_core::truth::pairs_within;
use sbbk_lab::backend::{Backend, Question};
use sbbk_lab::mesh;
use sbbk_lab::metrics::{Judge, Truth, sample_indices};

const PREDICTION: Real = 0.02;

/// Two heads pressed into each other, and what SBBK leaves behind for them.
struct Case {
    truth: Truth,
    manifolds: Vec<ContactManifold>,
}

impl Case {
    fn new() -> Self {
        let head: SharedShape = mesh::monkey_head().shared_shape().unwrap();
        let pos12 = Pose::new(Vector::new(0.3, 0.1, 0.8), Vector::new(0.3, 2.6, 0.2));
        let question = Question::new(&pos12, [&*head, &*head], PREDICTION);
        let mut manifolds = Vec::new();
        Backend::Sbbk
            .per_triangle()
            .contact_manifolds(&pos12, &*head, &*head, PREDICTION, &mut manifolds, &mut None)
            .unwrap();
        manifolds.retain(|manifold| !manifold.points.is_empty());
        let truth = Judge::new([&head]).truth(&question);
        Self { truth, manifolds }
    }

    /// Missed, phantom and wrong depth.
    fn errors(&self, manifolds: &[ContactManifold]) -> [usize; 3] {
        let errors = self.truth.judge_manifolds(manifolds).pairs;
        assert_eq!(errors.wrong(), errors.missed + errors.phantom + errors.wrong_depth);
        [errors.missed, errors.phantom, errors.wrong_depth]
    }

    /// The errors after a fault in the manifolds.
    fn with(&self, fault: impl FnOnce(&mut Vec<ContactManifold>)) -> [usize; 3] {
        let mut manifolds = self.manifolds.clone();
        fault(&mut manifolds);
        self.errors(&manifolds)
    }
}

fn distance(manifold: &ContactManifold) -> Real {
    manifold.points.iter().map(|point| point.dist).fold(Real::INFINITY, Real::min)
}

/// Would catch a count that blames right answers, is about nothing, does not see what is missing,
/// believes everything that is reported, or tolerates depths by another share of the prediction
/// distance than a twentieth.
#[test]
fn each_fault_is_counted_once() {
    let case = Case::new();
    assert!(case.truth.pairs().count() > 100);
    assert_eq!(case.errors(&case.manifolds), [0, 0, 0]);

    // Pairs in the band around the prediction distance may be missing.
    let is_certain = |index: &usize| distance(&case.manifolds[*index]) <= 0.99 * PREDICTION;
    let missed = (0..case.manifolds.len()).step_by(10).filter(is_certain).count();
    let every_tenth_lost = |manifolds: &mut Vec<ContactManifold>| {
        let mut index = 0..;
        manifolds.retain(|_| index.next().is_some_and(|index| index % 10 != 0));
    };
    assert_eq!(case.with(every_tenth_lost), [missed, 0, 0]);
    assert!(missed > 10);

    let is_true = |pair: &(u32, u32)| case.truth.pairs().any(|truth| truth == *pair);
    let mut invented = case.manifolds[0].clone();
    let far = (0..).map(|triangle| (invented.subshape1, triangle)).find(|pair| !is_true(pair));
    invented.subshape2 = far.unwrap().1;
    assert_eq!(case.with(|manifolds| manifolds.push(invented)), [0, 1, 0]);
    let repeated = case.manifolds[1].clone();
    assert_eq!(case.with(|manifolds| manifolds.push(repeated)), [0, 1, 0]);

    let by_depth = |a: &usize, b: &usize| {
        distance(&case.manifolds[*a]).total_cmp(&distance(&case.manifolds[*b]))
    };
    let deepest = (0..case.manifolds.len()).min_by(by_depth).unwrap();
    let moved = |by: Real| {
        case.with(|manifolds| {
            manifolds[deepest].points.iter_mut().for_each(|point| point.dist += by * PREDICTION);
        })
    };
    assert_eq!([0.06, -0.06, 0.04, -0.04].map(|by| moved(by)[2]), [1, 1, 0, 0]);

    // Points of an earlier pose, which stock Parry keeps, and NaN are no contacts.
    for beyond in [2.0, Real::NAN] {
        let errors = case.with(|manifolds| {
            manifolds[deepest].points.iter_mut().for_each(|point| point.dist = beyond * PREDICTION);
        });
        assert_eq!(errors, [1, 0, 0]);
    }
}

/// Would catch a truth that leaves out what is near, or that mixes up triangles: against the brute
/// force of all triangles.
#[test]
fn the_truth_is_that_of_whole_meshes() {
    let ball = mesh::ball(1.0, 8);
    let shape = ball.shared_shape().unwrap();
    let pos12 = Pose::new(Vector::new(1.0, 1.2, 1.1), Vector::new(0.3, -0.8, 0.5));
    let question = Question::new(&pos12, [&*shape, &*shape], 0.05);
    let mut pairs: Vec<(u32, u32)> = Judge::new([&shape]).truth(&question).pairs().collect();
    pairs.sort_unstable();
    let vertices: Vec<_> = ball.vertices.iter().map(|v| v.as_dvec3()).collect();
    let margin = f64::from(question.prediction) * 1.01;
    let triangles = &ball.triangles;
    let all = pairs_within(&vertices, triangles, &vertices, triangles, pos12.into(), margin);
    assert!(!pairs.is_empty());
    assert_eq!(pairs, all.iter().map(|p| (p.triangle1, p.triangle2)).collect::<Vec<_>>());
}

/// Would catch samples that repeat a pair, leave the end out or run over it.
#[test]
fn samples_are_spread_evenly() {
    assert_eq!(sample_indices(10, 4), [0, 2, 5, 7]);
    assert_eq!(sample_indices(3, 200), [0, 1, 2]);
    assert!(sample_indices(0, 5).is_empty());
}
