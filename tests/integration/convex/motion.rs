use glamx::{Pose3, Quat, Vec3};
use oorandom::Rand32;
use rapier3d::math::Real;
use rapier3d::parry::shape::{SharedShape, TriMeshFlags};
use sbbk_testkit::mesh;

use super::question::bits;
use super::shapes::{PREDICTIONS, floor, pose, shapes};
use crate::support::{Pair, Question, counting, every, nudge, shape_with};

/// A pair in motion: small steps, at times a jump, another prediction distance, or a workspace
/// taken away. After each step, the answer of a dispatcher that has never heard of the pair, bit
/// for bit; after some, that of Parry's routine on all triangles.
fn walk(name: &str, shape: &SharedShape, size: Real, flipped: bool, seed: u64) -> [u64; 4] {
    let (dispatcher, unaware) = (counting(), every());
    let head = shape_with(&mesh::monkey_head(), TriMeshFlags::empty());
    let _tree = unaware.prepare(&head).unwrap();
    let mut random = Rand32::new(seed);
    let mut question =
        Question::new(&head, &**shape, pose(&mut random, &head, size)).flipped(flipped);
    let mut pair: Pair = Pair::default();
    let (mut stride, mut contact_count) = (1e-3, 0);
    for step in 0..400 {
        match random.rand_range(0..100) {
            0..=2 => question.pose = pose(&mut random, &head, size),
            3..=5 => question.prediction = PREDICTIONS[random.rand_range(0..4) as usize],
            6 => pair.workspace = None,
            7 => stride = [0.0, 1e-5, 1e-3, 1e-2][random.rand_range(0..4) as usize],
            _ => question.pose = nudge(&mut random, stride) * question.pose,
        }
        pair.ask(&dispatcher, &question);
        let found: Vec<_> = pair.manifolds.iter().map(bits).collect();
        let expected: Vec<_> = question.fresh(&unaware).iter().map(bits).collect();
        assert!(found == expected, "{name} in step {step}");
        contact_count += found.len();
    }
    assert!(contact_count > 400, "{name}: {contact_count} contacts");
    let stats = dispatcher.stats();
    [stats.queries, stats.unchanged_queries, stats.reused_queries, stats.descended_queries]
}

/// Would catch candidates that are kept too long, bounds of distance that are too high, axes that
/// do not hold at another pose, manifolds given to another triangle, and anything else that depends
/// on where the pair was before. Proves that candidates were kept, but for balls.
#[test]
fn motion_is_no_part_of_the_answer() {
    let floor = ("floor", floor());
    for (seed, (name, shape)) in shapes(0.6).into_iter().chain([floor]).enumerate() {
        for flipped in [false, true] {
            let [all, unchanged, reused, descended] = walk(name, &shape, 0.6, flipped, seed as u64);
            assert_eq!(all, 400);
            // A ball keeps no candidates: to make its contacts anew takes less time than to use some.
            assert!(
                descended > 10 && if name == "ball" { reused == 0 } else { reused >= 20 },
                "{name}: {reused} reused, {descended} descended"
            );
            assert!(unchanged > 0, "{name}: always moved");
        }
    }
}

/// Would catch a panic in a descent or in Parry's routine, and contacts at poses that are none.
#[test]
fn poses_that_are_none_have_no_contacts() {
    let head = shape_with(&mesh::monkey_head(), TriMeshFlags::empty());
    let dispatcher = every();
    for (name, shape) in shapes(0.6) {
        for broken in [Real::NAN, Real::INFINITY, -Real::INFINITY] {
            let shift = Pose3::from_parts(Vec3::new(0.1, broken, 0.0), Quat::IDENTITY);
            let turn = Pose3::from_parts(Vec3::ZERO, Quat::from_xyzw(broken, 0.0, 0.0, 1.0));
            for (pose, flipped) in [(shift, false), (shift, true), (turn, false), (turn, true)] {
                let mut question = Question::new(&head, &*shape, Pose3::IDENTITY).flipped(flipped);
                let mut pair: Pair = Pair::default();
                // With a tree and kept contacts, and as a first query.
                pair.ask(&dispatcher, &question);
                question.pose = pose;
                // A half-space reaches to infinity on one side.
                let is_in = name == "half-space" && broken.is_infinite();
                let count = pair.ask(&dispatcher, &question).manifolds.len();
                assert!(count == 0 || is_in, "{name}, {pose:?}: {count} contacts");
                question.fresh(&dispatcher);
            }
        }
    }
    let (_, ball) = shapes(0.6).remove(0);
    let pose = Pose3::IDENTITY;
    let question = Question::new(&head, &*ball, pose).within(Real::NAN);
    assert_eq!(question.fresh(&dispatcher).len(), 0);
}
