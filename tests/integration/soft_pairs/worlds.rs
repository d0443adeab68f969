use crate::prelude::*;

/// The lowest particle, and the mean height.
fn heights(world: &PhysicsWorld) -> [Real; 2] {
    let heights: Vec<Real> = particles(world).iter().map(|particle| particle.y).collect();
    let mean = heights.iter().sum::<Real>() / heights.len() as Real;
    [heights.iter().copied().fold(Real::INFINITY, Real::min), mean]
}

fn step(world: &mut PhysicsWorld, count: usize) {
    (0..count).for_each(|_| world.step());
}

/// Under stock Rapier the soft body falls through.
#[test]
fn a_soft_body_rests_on_a_height_field() {
    let ground = bowl();
    let mut stock = soft_ball_above(&ground, None);
    step(&mut stock, 300);
    assert!(heights(&stock)[0] < -50.0, "stock has learnt it: {:?}", heights(&stock));
    let dispatcher = every();
    let mut ours = soft_ball_above(&ground, Some(&dispatcher));
    let mut lowest = Real::INFINITY;
    for _ in 0..500 {
        ours.step();
        lowest = lowest.min(heights(&ours)[0]);
    }
    let before = heights(&ours);
    step(&mut ours, 60);
    let after = heights(&ours);
    assert!(lowest > -0.15, "sank to {lowest}");
    assert!((0.1..0.9).contains(&after[1]), "is at {after:?}");
    assert!((before[1] - after[1]).abs() < 0.01, "{before:?}, later {after:?}");
    let stats = dispatcher.stats();
    assert!(stats.descended_queries > 200, "{stats:?}");
    assert_eq!((stats.unsupported_queries, stats.trees), (0, 0));
}

/// Would catch contacts with the wrong part, in its frame, or of old vertices. The body rests where
/// it does under stock.
#[test]
fn a_soft_body_rests_on_a_compound_or_a_mesh_as_with_stock() {
    for ground in [table(), mesh::floor(12.0, 24).shape()] {
        let dispatcher = every();
        let (mut stock, mut ours) =
            (soft_ball_above(&ground, None), soft_ball_above(&ground, Some(&dispatcher)));
        for _ in 0..40 {
            step(&mut stock, 10);
            step(&mut ours, 10);
            let [expected, found] = [heights(&stock), heights(&ours)];
            assert!((found[1] - expected[1]).abs() < 0.05, "{found:?}, with stock {expected:?}");
            assert!(found[0] > -0.1, "sank to {found:?}");
        }
        let stats = dispatcher.stats();
        // At rest the body sleeps.
        assert!(stats.descended_queries > 50, "{stats:?}");
        assert_eq!((stats.unsupported_queries, stats.trees), (0, 0));
    }
}
