//! The error count, against answers with known faults.

use rapier3d::geometry::{ContactManifold, SharedShape};
use rapier3d::math::{Pose, Real, Vector};
use sbbk_lab::backend::{Answer, Backend, Question};
use sbbk_lab::mesh;
use sbbk_lab::metrics::{ErrorCount, Judge, Truth, sample_indices};

const PREDICTION: Real = 0.02;

/// Two heads pressed into each other, and what a dispatcher leaves behind for them.
struct Case {
    question: Question,
    truth: Truth,
    manifolds: Vec<ContactManifold>,
}

impl Case {
    fn new() -> Self {
        let head: SharedShape = mesh::monkey_head().shared_shape().unwrap();
        let pos12 = Pose::new(Vector::new(0.3, 0.1, 0.8), Vector::new(0.3, 2.6, 0.2));
        let question = Question::new(&pos12, [&*head, &*head], PREDICTION);
        let (mut manifolds, mut workspace) = (Vec::new(), None);
        Backend::Sbbk
            .dispatcher()
            .contact_manifolds(&pos12, &*head, &*head, PREDICTION, &mut manifolds, &mut workspace)
            .unwrap();
        manifolds.retain(|manifold| !manifold.points.is_empty());
        let truth = Judge::new([&head]).truth(&question);
        Self { question, truth, manifolds }
    }

    fn judge(&self, manifolds: &[ContactManifold]) -> ErrorCount {
        self.truth.judge(&Answer::new(self.question, manifolds))
    }
}

fn distance(manifold: &ContactManifold) -> Real {
    let distances = manifold.points.iter().map(|point| point.dist);
    distances.fold(Real::INFINITY, Real::min)
}

/// Would catch a count that blames right answers, or one about nothing.
#[test]
fn exact_contacts_are_without_error() {
    let case = Case::new();
    let errors = case.judge(&case.manifolds);
    assert!(errors.true_pairs > 100, "{errors:?}");
    assert_eq!(errors.wrong(), 0, "{errors:?}");
    assert_eq!(errors.share(), Some(0.0));
}

/// Would catch a count that does not see what is not there: a dispatcher that loses every tenth
/// manifold misses exactly these pairs.
#[test]
fn dropped_manifolds_are_missed() {
    let case = Case::new();
    let (mut kept, mut dropped) = (Vec::new(), 0);
    for (index, manifold) in case.manifolds.iter().enumerate() {
        if index % 10 == 3 {
            // Pairs in the band around the prediction distance may be missing.
            dropped += usize::from(distance(manifold) <= 0.99 * PREDICTION);
        } else {
            kept.push(manifold.clone());
        }
    }
    assert!(dropped > 10);
    let errors = case.judge(&kept);
    assert_eq!((errors.missed, errors.phantom, errors.wrong_depth), (dropped, 0, 0));
}

/// Would catch a count that believes everything that is reported: a pair of triangles far from
/// each other, and a true pair reported twice, are phantoms.
#[test]
fn invented_and_repeated_pairs_are_phantoms() {
    let case = Case::new();
    let is_true = |pair: &(u32, u32)| case.truth.pairs().any(|truth| truth == *pair);
    let mut invented = case.manifolds[0].clone();
    let far = (0..).map(|triangle| (invented.subshape1, triangle)).find(|pair| !is_true(pair));
    invented.subshape2 = far.unwrap().1;
    let mut manifolds = case.manifolds.clone();
    manifolds.push(invented);
    let errors = case.judge(&manifolds);
    assert_eq!((errors.missed, errors.phantom, errors.wrong_depth), (0, 1, 0));
    manifolds.push(case.manifolds[1].clone());
    assert_eq!(case.judge(&manifolds).phantom, 2);
}

/// Would catch a tolerance of the wrong size: 6 % of the prediction distance off is wrong, 4 % is
/// not, either way.
#[test]
fn depths_may_be_off_by_a_twentieth() {
    let case = Case::new();
    let deepest = (0..case.manifolds.len())
        .min_by(|&a, &b| distance(&case.manifolds[a]).total_cmp(&distance(&case.manifolds[b])))
        .unwrap();
    for (off, wrong) in [(0.06, 1), (-0.06, 1), (0.04, 0), (-0.04, 0)] {
        let mut manifolds = case.manifolds.clone();
        for point in &mut manifolds[deepest].points {
            point.dist += off * PREDICTION;
        }
        let errors = case.judge(&manifolds);
        assert_eq!((errors.missed, errors.phantom, errors.wrong_depth), (0, 0, wrong), "{off}");
    }
}

/// Would catch points of an earlier pose, which stock Parry keeps beyond the prediction distance,
/// counted as phantoms; and a NaN distance counted as a contact.
#[test]
fn points_beyond_the_prediction_distance_are_not_reported() {
    let case = Case::new();
    for beyond in [2.0 * PREDICTION, Real::NAN] {
        let mut manifolds = case.manifolds.clone();
        manifolds[0].points.iter_mut().for_each(|point| point.dist = beyond);
        let errors = case.judge(&manifolds);
        assert_eq!(errors.reported, case.manifolds.len() - 1);
        assert_eq!((errors.missed, errors.phantom), (1, 0));
    }
}

/// Would catch samples that repeat a pair, leave the end out or run over it.
#[test]
fn samples_are_spread_evenly() {
    assert_eq!(sample_indices(10, 4), [0, 2, 5, 7]);
    assert_eq!(sample_indices(3, 200), [0, 1, 2]);
    assert!(sample_indices(0, 5).is_empty());
    let sampled = sample_indices(12_345, 200);
    assert!(sampled.windows(2).all(|pair| (61..=62).contains(&(pair[1] - pair[0]))));
    assert!(sampled[199] < 12_345 && sampled[199] + 62 >= 12_345);
}
