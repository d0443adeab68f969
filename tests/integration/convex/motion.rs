use std::collections::BTreeMap;

use glamx::{Pose3, Quat, Vec3};
use oorandom::Rand32;
use rapier_integration::SbbkDispatcher;
use rapier3d::math::Real;
use rapier3d::parry::query::DefaultQueryDispatcher;
use rapier3d::parry::shape::{SharedShape, TriMeshFlags};
use sbbk_lab::mesh;

use super::question::{Question, touches};
use super::shapes::{PREDICTIONS, floor, pose, shapes};
use crate::support::{Manifold, Pair, counting, distance, nudge, shape_with};

/// Points and whole manifolds that Parry keeps from step to step it only moves along, while they drift by up to a
/// thousandth of a unit and a degree: distances this close to the prediction distance may go either way.
const BAND: Real = 2e-3;

/// How far a kept depth may be off for the same reason: a degree over a unit.
const DEPTH: Real = 2e-2;

/// A pair in motion: small steps, at times a jump, another prediction distance, or a workspace taken away.
fn walk(name: &str, shape: &SharedShape, size: Real, flipped: bool, seed: u64) -> [u64; 4] {
    let dispatcher = counting();
    let head = shape_with(&mesh::monkey_head(), TriMeshFlags::empty());
    let mut random = Rand32::new(seed);
    let mut question = Question {
        mesh: &head,
        shape,
        pose: pose(&mut random, &head, size),
        prediction: 0.02,
        flipped,
    };
    let mut pair: Pair = Pair::default();
    let mut stride = 1e-3;
    // Parry's GJK sees or does not see contacts by where it begins: here where stock begins.
    let mut stock: Pair = Pair::default();
    let (mut contact_count, mut unseen_count) = (0, 0);
    for _ in 0..400 {
        match random.rand_range(0..100) {
            0..=2 => question.pose = pose(&mut random, &head, size),
            3..=5 => question.prediction = PREDICTIONS[random.rand_range(0..4) as usize],
            6 => (pair.workspace, stock.workspace) = (None, None),
            7 => stride = [0.0, 1e-5, 1e-3, 1e-2][random.rand_range(0..4) as usize],
            _ => question.pose = nudge(&mut random, stride) * question.pose,
        }
        question.ask(&dispatcher, &mut pair);
        question.ask(&DefaultQueryDispatcher, &mut stock);
        let wider = Question { prediction: question.prediction + BAND, ..question };
        let all = wider.brute_force();
        let mut found = BTreeMap::new();
        for manifold in pair.manifolds.iter().filter(|m| touches(m, question.prediction)) {
            let triangle = question.triangle_of(manifold);
            assert!(
                found.insert(triangle, distance(manifold)).is_none(),
                "{name}: {triangle} twice"
            );
        }
        for (triangle, near) in &found {
            let expected = all.get(triangle).map(distance);
            // Parry's GJK does not see every contact of a cylinder: its distance is another way to ask.
            let is_unseen = expected.is_none() && question.apart(*triangle) <= wider.prediction;
            let off = expected.map_or(Real::INFINITY, |expected| (near - expected).abs());
            assert!(
                is_unseen || off <= DEPTH,
                "{name}: {triangle} is {near} deep, fresh {expected:?}"
            );
        }
        let has = |manifold: &Manifold, triangle| {
            question.triangle_of(manifold) == triangle && touches(manifold, question.prediction)
        };
        for (&triangle, expected) in &all {
            let is_in = distance(expected) < question.prediction - BAND;
            contact_count += usize::from(is_in);
            if is_in && !found.contains_key(&triangle) {
                let is_stocks = stock.manifolds.iter().any(|manifold| has(manifold, triangle));
                assert!(!is_stocks, "{name}: {triangle} is lost");
                unseen_count += 1;
            }
        }
    }
    assert!(100 * unseen_count <= contact_count, "{name}: {unseen_count} of {contact_count}");
    let stats = dispatcher.stats();
    [stats.queries, stats.unchanged_queries, stats.reused_queries, stats.descended_queries]
}

/// Would catch candidates that are kept too long, bounds of distance that are too high, axes that do not hold at another
/// pose, manifolds given to another triangle, and anything else that depends on where the pair was before. Proves
/// that candidates were kept.
#[test]
fn motion_loses_no_contact() {
    let floor = ("floor", floor());
    for (seed, (name, shape)) in shapes(0.6).into_iter().chain([floor]).enumerate() {
        for flipped in [false, true] {
            let [all, unchanged, reused, descended] = walk(name, &shape, 0.6, flipped, seed as u64);
            assert_eq!(all, 400);
            assert!(
                reused >= 20 && descended > 10,
                "{name}: {reused} reused, {descended} descended"
            );
            assert!(unchanged + reused + descended <= all);
        }
    }
}

/// Would catch a panic in a descent or in Parry's routine, and contacts at poses that are none.
#[test]
fn poses_that_are_none_have_no_contacts() {
    let head = shape_with(&mesh::monkey_head(), TriMeshFlags::empty());
    let dispatcher = SbbkDispatcher::default();
    for (name, shape) in shapes(0.6) {
        for broken in [Real::NAN, Real::INFINITY, -Real::INFINITY] {
            let shift = Pose3::from_parts(Vec3::new(0.1, broken, 0.0), Quat::IDENTITY);
            let turn = Pose3::from_parts(Vec3::ZERO, Quat::from_xyzw(broken, 0.0, 0.0, 1.0));
            for (pose, flipped) in [(shift, false), (shift, true), (turn, false), (turn, true)] {
                let mut question = Question {
                    mesh: &head,
                    shape: &shape,
                    pose: Pose3::IDENTITY,
                    prediction: 0.02,
                    flipped,
                };
                let mut pair: Pair = Pair::default();
                // With a tree and kept contacts, and as a first query.
                question.ask(&dispatcher, &mut pair);
                question.pose = pose;
                // A half-space reaches to infinity on one side.
                let is_in = name == "half-space" && broken.is_infinite();
                let count = question.ask(&dispatcher, &mut pair).manifolds.len();
                assert!(count == 0 || is_in, "{name}, {pose:?}: {count} contacts");
                question.fresh(&dispatcher);
            }
        }
    }
    let (_, ball) = shapes(0.6).remove(0);
    let pose = Pose3::IDENTITY;
    let question =
        Question { mesh: &head, shape: &ball, pose, prediction: Real::NAN, flipped: false };
    assert_eq!(question.fresh(&dispatcher).len(), 0);
}
