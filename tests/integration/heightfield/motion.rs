use glamx::{Quat, Vec3};
use oorandom::Rand32;
use rapier3d::math::{Pose, Real};
use sbbk_testkit::mesh;

use super::terrain::{Terrain, place, rolling, terrains};
use crate::support::{Pair, Question, assert_same, counting, every, nudge, shape};

/// Would catch candidates kept too long, cells that are not looked at again, and anything else that
/// depends on where the pair was before. Proves that candidates were kept.
#[test]
fn motion_never_differs_from_fresh_queries() {
    let terrains = terrains();
    let head = shape(&mesh::monkey_head_with(6));
    for (seed, flipped) in [(0, false), (1, true), (2, false), (4, true), (5, false)] {
        let terrain = &terrains[seed];
        let mut random = Rand32::new(seed as u64);
        let (dispatcher, unaware) = (counting(), every());
        let _tree = unaware.prepare(&head).unwrap();
        let pose = place(&mut random, terrain, &head, 0.02);
        let mut question = Question::new(&terrain.field, &head, pose).flipped(flipped);
        let mut pair: Pair = Pair::default();
        let (mut stride, mut count) = (1e-3, 0);
        for _ in 0..1500 {
            match random.rand_range(0..100) {
                0..=2 => question.pose = place(&mut random, terrain, &head, 0.03),
                3..=5 => stride = [0.0, 1e-5, 1e-3, 5e-3, 3e-2][random.rand_range(0..5) as usize],
                6..=8 => {
                    question.prediction = [0.0, 0.01, 0.02, 0.06][random.rand_range(0..4) as usize]
                }
                9 => pair.workspace = None,
                10 => question.pose.translation.y += 5.0,
                11 => question.pose.translation.z = Real::NAN,
                _ => question.pose = nudge(&mut random, stride) * question.pose,
            }
            if !question.pose.translation.is_finite() || question.pose.translation.y > 4.0 {
                pair.ask(&dispatcher, &question);
                assert_eq!(pair.manifolds.len(), 0);
                question.pose = place(&mut random, terrain, &head, 0.03);
            }
            pair.ask(&dispatcher, &question);
            let expected = question.fresh(&unaware);
            assert_same(&pair.manifolds, &expected, 0.0);
            count += expected.len();
        }
        let stats = dispatcher.stats();
        assert!(stats.reused_queries > 300 && stats.descended_queries > 100, "{stats:?}");
        assert!(stats.unchanged_queries > 10 && count > 5000, "{count}, {stats:?}");
    }
}

/// Would catch contacts at poses that are none, and panics there.
#[test]
fn poses_that_are_none_have_no_contacts() {
    let terrain = Terrain::new(rolling(6.0, 20, 0.5));
    let head = shape(&mesh::monkey_head());
    let dispatcher = every();
    for broken in [Real::NAN, Real::INFINITY, -Real::INFINITY] {
        let shift = Pose::from_parts(Vec3::new(0.1, broken, 0.0), Quat::IDENTITY);
        let turn = Pose::from_parts(Vec3::ZERO, Quat::from_xyzw(broken, 0.0, 0.0, 1.0));
        for (pose, flipped) in [(shift, false), (shift, true), (turn, false), (turn, true)] {
            let good = Question::new(&terrain.field, &head, Pose::IDENTITY);
            let good = good.flipped(flipped);
            let mut pair: Pair = Pair::default();
            assert!(!pair.ask(&dispatcher, &good).manifolds.is_empty());
            let question = good.at(pose);
            assert!(pair.ask(&dispatcher, &question).manifolds.is_empty());
            assert!(question.fresh(&dispatcher).is_empty());
        }
    }
    let question = Question::new(&terrain.field, &head, Pose::IDENTITY);
    assert!(question.within(Real::NAN).fresh(&dispatcher).is_empty());
}
