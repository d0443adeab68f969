//! Promises that hold for a pair of every kind: see [`kinds`].

use allocation_counter::measure;
use glamx::{Quat, Vec3};
use oorandom::Rand32;
use rapier_integration::{SbbkDispatcher, SbbkStats};
use rapier3d::geometry::{ContactData, ContactManifoldData};
use rapier3d::math::{Pose, Real};
use rapier3d::parry::query::DefaultQueryDispatcher;

use crate::kinds::{Kind, kinds, mesh_pairs};
use crate::support::{
    Pair, Question, assert_bits, counting, counting_patches, distance, every, nudge,
};

const PREDICTIONS: [Real; 4] = [0.0, 0.002, 0.02, 0.2];
/// Lengths of a step in units and radians, from far below any slack to beyond it.
const STRIDES: [Real; 5] = [0.0, 1e-5, 1e-3, 1e-2, 3e-2];

/// Moves a pair at random, with jumps, lost workspaces, other dispatchers, and poses far away or NaN. Each result must
/// equal that of a dispatcher without memory, bit for bit.
fn walk(kind: &Kind, seed: u64, steps: usize) -> (SbbkStats, usize) {
    let (dispatcher, unaware, another) = (counting(), every(), every());
    let mut random = Rand32::new(seed);
    let mut question = kind.question(kind.pose(&mut random, 0.0)).flipped(seed % 2 == 1);
    let mut pair: Pair = Pair::default();
    let (mut stride, mut contacts) = (1e-3, 0);
    for step in 0..steps {
        let pick = random.rand_range(0..5) as usize;
        match random.rand_range(0..100) {
            0..=2 => question.pose = kind.pose(&mut random, -0.02),
            3..=5 => question.prediction = PREDICTIONS[pick % 4],
            6 => pair.workspace = None,
            7..=9 => stride = STRIDES[pick],
            10 => question.pose.translation.y += 50.0,
            11 => question.pose.translation.z = Real::NAN,
            12 => _ = pair.ask(&another, &question),
            13 => _ = pair.ask(&DefaultQueryDispatcher, &question),
            _ => question.pose = nudge(&mut random, stride) * question.pose,
        }
        pair.ask(&dispatcher, &question);
        let expected = question.fresh(&unaware);
        assert_bits(&pair.manifolds, &expected, &format!("{}, step {step}", kind.name));
        contacts += expected.len();
        let at = question.pose.translation;
        if !(at.is_finite() && at.length() < 20.0) {
            question.pose = kind.pose(&mut random, -0.01);
        }
    }
    (dispatcher.stats(), contacts)
}

/// Would catch candidates kept too long, anything that outlives its reason, bounds of distance that are too high, and manifolds of
/// another subshape.
#[test]
fn the_answer_does_not_depend_on_the_motion_before() {
    let pairs = mesh_pairs();
    let kinds = kinds().iter().map(|kind| (kind, 400)).chain(pairs.iter().map(|pair| (pair, 1200)));
    for (seed, (kind, steps)) in (0..).zip(kinds) {
        let (stats, contacts) = walk(kind, seed, steps);
        let name = &kind.name;
        assert_eq!(stats.queries, steps as u64, "{name}");
        assert!(contacts > steps / 2, "{name}: {contacts} contacts");
        assert!(stats.descended_queries > 10, "{name}: {stats:?}");
        assert!((stats.internals.unchanged_queries > 0) != kind.is_soft, "{name}: {stats:?}");
        assert!((stats.internals.walks > 50) || name != "large mesh", "{name}: {stats:?}");
        assert!(
            (stats.internals.reused_queries >= 20) == kind.keeps_candidates,
            "{name}: {stats:?}"
        );
    }
}

/// Would catch a panic, and contacts at poses that are not finite.
#[test]
fn poses_that_are_not_finite_have_no_contacts() {
    let dispatcher = every();
    for (seed, kind) in (0..).zip(kinds()) {
        let start = kind.pose(&mut Rand32::new(seed), -0.02);
        for broken in [Real::NAN, Real::INFINITY, -Real::INFINITY] {
            let shift = Pose::from_parts(Vec3::new(0.1, broken, 0.0), Quat::IDENTITY);
            let turn = Pose::from_parts(Vec3::ZERO, Quat::from_xyzw(broken, 0.0, 0.0, 1.0));
            for (pose, flipped) in [(shift, false), (shift, true), (turn, false), (turn, true)] {
                let question = kind.question(start).flipped(flipped);
                let mut pair: Pair = Pair::default();
                assert!(!pair.ask(&dispatcher, &question).manifolds.is_empty(), "{}", kind.name);
                pair.ask(&dispatcher, &question.at(pose));
                // A half-space reaches to infinity on one side.
                let is_in = kind.name == "half-space" && broken.is_infinite();
                assert!(pair.manifolds.is_empty() || is_in, "{}, {pose:?}", kind.name);
                assert!(question.at(pose).fresh(&dispatcher).is_empty() || is_in);
                assert!(question.within(Real::NAN).fresh(&dispatcher).is_empty());
            }
        }
    }
}

/// Would catch candidates of a shape that is no longer there, if a host keeps the workspace.
#[test]
fn another_shape_with_the_same_workspace_is_noticed() {
    let dispatcher = every();
    let pose = Pose::translation(0.9, 0.1, 0.0);
    let (mut pair, mut touching) = (Pair::default(), 0);
    let pairs = mesh_pairs();
    for kind in kinds().iter().chain(&pairs).chain(kinds().iter().rev()) {
        let question = kind.question(pose);
        for _ in 0..2 {
            let expected = question.fresh(&every());
            assert_bits(&pair.ask(&dispatcher, &question).manifolds, &expected, &kind.name);
            touching += usize::from(!expected.is_empty());
        }
    }
    assert!(touching > 60, "{touching} queries with contacts");
}

/// Counts the allocations of a pair that shakes about a place by `stride` (units and radians),
/// after its buffers have reached their size.
fn allocations(dispatcher: &SbbkDispatcher, question: &Question, stride: Real) -> u64 {
    let mut random = Rand32::new(1);
    let shake = |_| nudge(&mut random, 0.5 * stride) * question.pose;
    let poses: Vec<Pose> = (0..20).map(shake).collect();
    let mut pair = Pair::<ContactManifoldData, ContactData>::default();
    for &pose in poses.iter().cycle().take(20 * 40) {
        pair.ask(dispatcher, &question.at(pose));
    }
    assert!(!pair.manifolds.is_empty(), "the pair must stay in contact");
    let steady = poses.iter().cycle().take(20 * 5);
    steady.map(|&pose| measure(|| _ = pair.ask(dispatcher, &question.at(pose))).count_total).sum()
}

/// Would catch manifolds, points, candidates or lists that are allocated in each step, at rest or
/// in motion.
#[test]
fn steady_contact_allocates_nothing() {
    for (seed, kind) in (0..).zip(kinds()) {
        let mut random = Rand32::new(seed);
        let pose = kind.pose(&mut random, -0.03);
        for (detail, dispatcher) in [("every", counting()), ("patches", counting_patches())] {
            // The last case has less slack than its steps are long.
            for (flipped, stride, prediction) in
                [(false, 1e-4, 0.02), (true, 1e-3, 0.02), (false, 2.5e-2, 0.002)]
            {
                let question = kind.question(pose).within(prediction).flipped(flipped);
                let count = allocations(&dispatcher, &question, stride);
                assert_eq!(count, 0, "{}, {detail}, steps of {stride}", kind.name);
            }
            let stats = dispatcher.stats();
            assert!(stats.descended_queries > 100, "{}: {stats:?}", kind.name);
        }
    }
}

/// Would catch a counter of allocations that counts nothing.
#[test]
fn the_first_query_allocates() {
    let kind = &kinds()[0];
    let question = kind.question(kind.pose(&mut Rand32::new(1), -0.02));
    let (mut pair, dispatcher) = (Pair::<(), ()>::default(), SbbkDispatcher::default());
    assert!(measure(|| _ = pair.ask(&dispatcher, &question)).count_total > 10);
    assert!(pair.manifolds.iter().any(|manifold| distance(manifold) < 0.0));
}
