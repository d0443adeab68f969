use crate::kinds::kinds;
use crate::prelude::*;
use rapier3d::parry::query::ContactManifold;
use sbbk_core::traverse::Placement;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Calls `check` with a pair of each kind in contact, in both orders, and another pose in contact.
fn for_each_pair(mut check: impl FnMut(&str, &Question, Pose)) {
    for (seed, kind) in (0..).zip(kinds()) {
        let mut random = Rand32::new(seed);
        let [pose, other] = [(); 2].map(|()| kind.pose(&mut random, -0.01));
        for flipped in [false, true] {
            let name = format!("{}, flipped: {flipped}", kind.name);
            check(&name, &kind.question(pose).flipped(flipped), other);
        }
    }
}

/// Data of a host that panics when the countdown is over.
#[derive(Clone)]
struct Fragile;

static COUNTDOWN: AtomicUsize = AtomicUsize::new(usize::MAX);

impl Default for Fragile {
    fn default() -> Self {
        let left = COUNTDOWN.load(Ordering::Relaxed);
        assert!(left > 0, "the host panics");
        COUNTDOWN.store(left - 1, Ordering::Relaxed);
        Self
    }
}

/// The manifolds with the data of another host.
fn plain(manifolds: &[ContactManifold<Fragile, ()>]) -> Vec<Vec<u32>> {
    manifolds.iter().map(bits).collect()
}

/// Would catch a query that a type of the host cut short and that counts as answered.
#[test]
fn a_query_cut_short_by_a_panic_is_asked_again() {
    for_each_pair(|name, question, other| {
        let dispatcher = SbbkDispatcher::default();
        let [before, expected] = [other, question.pose]
            .map(|pose| question.at(pose).fresh(&SbbkDispatcher::default()))
            .map(|found| found.iter().map(bits).collect::<Vec<_>>());
        let apart = Pose::translation(0.0, 1.5, 0.0) * other;
        for countdown in 0..5 {
            for known in [None, Some(apart), Some(other)] {
                let mut pair = Pair::<Fragile, ()>::default();
                if let Some(last) = known {
                    pair.ask(&dispatcher, &question.at(other));
                    pair.ask(&dispatcher, &question.at(last));
                }
                COUNTDOWN.store(countdown, Ordering::Relaxed);
                let is_cut_short =
                    catch_unwind(AssertUnwindSafe(|| _ = pair.ask(&dispatcher, question)));
                COUNTDOWN.store(usize::MAX, Ordering::Relaxed);
                let must_be = countdown == 0 && known.is_none();
                assert!(is_cut_short.is_err() || !must_be, "{name}: nothing was cut short");
                if known == Some(other) {
                    pair.ask(&dispatcher, &question.at(other));
                    assert!(plain(&pair.manifolds) == before, "{name}: {countdown}");
                }
                for _ in 0..2 {
                    pair.ask(&dispatcher, question);
                    assert!(plain(&pair.manifolds) == expected, "{name}: {countdown}");
                }
            }
        }
    });
}

/// Would catch overflow that loses contacts of a smaller prediction distance.
#[test]
fn no_prediction_distance_is_too_large() {
    for_each_pair(|name, question, _| {
        let near = sequence(&question.fresh(&every()));
        for prediction in [1e3, 1e9, 2e19, 1e30, Real::MAX] {
            let (mut pair, question) = (Pair::<(), ()>::default(), question.within(prediction));
            for _ in 0..2 {
                let found = sequence(&pair.ask(&every(), &question).manifolds);
                let lost = near.iter().filter(|near| !found.contains(near)).count();
                assert_eq!(lost, 0, "{name} within {prediction}");
            }
        }
    });
}

/// Would catch boxes that rounding makes too small, in the first query of a pair and later. Each
/// mesh is far from its origin and the prediction distance away, turned or not.
#[test]
fn meshes_far_from_their_origin_are_seen_in_the_first_query() {
    let (mut random, mut found) = (Rand32::new(1), [0; 4]);
    for i in 0..600 {
        let is_turned = i % 3 > 0;
        let offset = 1e4 * (1.0 + random.rand_float());
        let offset = offset * if is_turned { direction(&mut random) } else { Vec3::Y };
        let far = shape(&mesh::cuboid(Vec3::ONE, 1).mapped(|x| x + offset));
        let turn = if is_turned { rotation(&mut random) } else { Quat::IDENTITY };
        let reach = Vec3::AXES.iter().map(|&axis| (turn * axis).y.abs()).sum::<Real>();
        let pose = Pose::from_parts(Vec3::new(0.1, 1.02 + reach, 0.2) - turn * offset, turn);
        for (ground, found) in grounds().iter().zip(&mut found) {
            let question = Question::new(&**ground, &far, pose);
            *found += check_far(question) + check_far(question.flipped(true));
        }
    }
    assert!(found.iter().all(|&found| found > 600), "{found:?} contacts");
}

/// Shapes whose upper side is at a height of one.
fn grounds() -> [SharedShape; 4] {
    let slab = Vec3::new(5.0, 1.0, 5.0);
    let cuboid = SharedShape::cuboid(slab.x, slab.y, slab.z);
    [
        mesh::cuboid(slab, 1).shape(),
        cuboid.clone(),
        SharedShape::cylinder(1.0, 5.0),
        SharedShape::compound(vec![(Pose::IDENTITY, cuboid)]),
    ]
}

/// Asks within the distance of a mesh from the ground. The number of contacts.
fn check_far(question: Question) -> usize {
    let dispatcher = SbbkDispatcher::default();
    let placement = Placement::new(&question.pos12());
    let placement = if question.is_flipped { placement.inverted() } else { placement };
    let corners = question.mesh().vertices().iter();
    let heights = corners.map(|&x| placement.to_frame1(x, Vec3::ZERO).y);
    let gap = (heights.fold(f64::INFINITY, f64::min) - 1.0) as Real;
    if gap < 1e-4 {
        return 0;
    }
    let mut count = 0;
    // A frame may be longer than the other by the rounding of its quaternion.
    for (prediction, is_sure) in [(gap.next_up(), false), (1.000_01 * gap, true)] {
        let question = question.within(prediction);
        let mut pair: Pair = Pair::default();
        let beside = Pose::translation(-0.1, -0.1, 0.0) * question.pose;
        pair.ask(&dispatcher, &question.at(beside));
        pair.ask(&dispatcher, &question);
        assert_bits(&pair.manifolds, &question.fresh(&dispatcher), &format!("{gap} apart"));
        assert!(!pair.manifolds.is_empty() || !is_sure, "{gap} apart, {}", question.is_flipped);
        count += pair.manifolds.len();
        if is_sure && question.shapes[0].as_composite_shape().is_none() {
            let ([g1, g2], pos12) = (question.host_shapes(), question.pos12());
            let nearest = dispatcher.closest_points(&pos12, g1, g2, prediction).unwrap();
            assert!(nearest != ClosestPoints::Disjoint, "{gap} apart, {}", question.is_flipped);
        }
    }
    count
}
