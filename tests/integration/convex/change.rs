use oorandom::Rand32;
use rapier_integration::SbbkDispatcher;
use rapier3d::math::{Pose, Real};
use rapier3d::parry::query::DefaultQueryDispatcher;
use sbbk_testkit::mesh;

use super::shapes::{pose, shapes};
use crate::support::{Pair, Question, per_triangle, shape};

/// Would catch manifolds of stock's that are taken for ours, or dropped with their data where the
/// shapes are the same.
#[test]
fn stock_can_hand_over_a_pair() {
    let head = shape(&mesh::monkey_head());
    let dispatcher = per_triangle();
    let mut random = Rand32::new(7);
    for (name, shape) in shapes(0.6) {
        let pose = pose(&mut random, &head, 0.5);
        let question = Question::new(&head, &*shape, pose).within(0.05).flipped(true);
        let mut pair: Pair<u32> = Pair::default();
        pair.ask(&DefaultQueryDispatcher, &question);
        pair.manifolds.iter_mut().for_each(|manifold| manifold.data = manifold.subshape2 + 1);
        pair.ask(&dispatcher, &question);
        let expected: Vec<_> = question.fresh(&dispatcher).iter().map(|m| m.subshape2).collect();
        let found: Vec<_> = pair.manifolds.iter().map(|m| m.subshape2).collect();
        assert_eq!(found, expected, "{name}");
        let mut manifolds = pair.manifolds.iter();
        assert!(manifolds.all(|m| m.data == m.subshape2 + 1), "{name}: data is lost");
    }
}

/// Would catch impulses that are lost as a shape slides, or that another triangle gets.
#[test]
fn points_keep_their_data() {
    let floor = shape(&mesh::floor(4.0, 2));
    let dispatcher = SbbkDispatcher::default();
    for (name, shape) in shapes(1.0) {
        if !["cuboid", "round cuboid"].contains(&name) {
            continue;
        }
        let mut pair = Pair::<(), u32>::default();
        let mut before: Vec<u32> = Vec::new();
        for step in 0..5 {
            let pose = Pose::translation(0.3 + 1e-5 * step as Real, 0.3, 0.2);
            pair.ask(&dispatcher, &Question::new(&floor, &*shape, pose).within(0.002));
            let points = || pair.manifolds.iter().flat_map(|manifold| &manifold.points);
            let data: Vec<u32> = points().map(|point| point.data).collect();
            assert!(!data.is_empty() && (step == 0 || data == before), "{name}: {data:?}");
            before = (1..).take(data.len()).collect();
            let points = pair.manifolds.iter_mut().flat_map(|manifold| &mut manifold.points);
            points.zip(&before).for_each(|(point, mark)| point.data = *mark);
        }
    }
}
