use glamx::Vec3;
use rapier_integration::SbbkDispatcher;
use rapier3d::dynamics::{RigidBodyBuilder, SoftBodyBuilder};
use rapier3d::geometry::ColliderBuilder;
use rapier3d::math::{Pose, Real, Vector};
use rapier3d::parry::shape::{HeightField, HeightFieldCellStatus, SharedShape};
use rapier3d::parry::utils::Array2;
use rapier3d::pipeline::PhysicsWorld;
use sbbk_testkit::mesh;

use crate::support::counting;

/// A bowl of twelve units across: bodies stay in it.
fn bowl() -> SharedShape {
    let lines = 41;
    let at = |i: usize| 12.0 * (i as Real / (lines - 1) as Real - 0.5);
    let heights = Array2::from_fn(lines, lines, |i, j| {
        0.05 * (at(i).powi(2) + at(j).powi(2)) + 0.05 * (3.0 * at(i)).sin() * (3.0 * at(j)).cos()
    });
    let mut field = HeightField::new(heights, Vec3::new(12.0, 1.0, 12.0));
    for status in field.cells_statuses_mut().data_mut() {
        *status = HeightFieldCellStatus::ZIGZAG_SUBDIVISION;
    }
    SharedShape::new(field)
}

/// A table of boxes with a rim.
fn table() -> SharedShape {
    let mut parts = vec![(Pose::translation(0.0, -0.5, 0.0), SharedShape::cuboid(4.0, 0.5, 4.0))];
    for (x, z) in [(4.0, 0.0), (-4.0, 0.0), (0.0, 4.0), (0.0, -4.0)] {
        let half = if x == 0.0 { [4.0, 0.2] } else { [0.2, 4.0] };
        let rim = SharedShape::cuboid(half[0], 0.6, half[1]);
        parts.push((Pose::translation(x, 0.6, z), rim));
    }
    SharedShape::compound(parts)
}

/// A soft ball above fixed ground.
fn world(ground: &SharedShape, dispatcher: Option<&SbbkDispatcher>) -> PhysicsWorld {
    let mut world = PhysicsWorld::new();
    if let Some(dispatcher) = dispatcher {
        world.narrow_phase.set_query_dispatcher(dispatcher.clone());
    }
    world.insert(RigidBodyBuilder::fixed(), ColliderBuilder::new(ground.clone()));
    let ball = mesh::ball(0.6, 5);
    let vertices = ball.vertices.iter().map(|v| *v + Vec3::new(0.4, 1.5, 0.3)).collect();
    let soft = SoftBodyBuilder::trimesh(vertices, ball.triangles.clone()).expect("a mesh");
    world.insert_soft_body(soft);
    world
}

fn particles(world: &PhysicsWorld) -> Vec<Vector> {
    world.soft_bodies().flat_map(|(_, body)| body.particle_positions()).collect()
}

/// The lowest particle, and the mean height.
fn heights(world: &PhysicsWorld) -> [Real; 2] {
    let heights: Vec<Real> = particles(world).iter().map(|particle| particle.y).collect();
    let mean = heights.iter().sum::<Real>() / heights.len() as Real;
    [heights.iter().copied().fold(Real::INFINITY, Real::min), mean]
}

fn step(world: &mut PhysicsWorld, count: usize) {
    (0..count).for_each(|_| world.step());
}

/// The reason for all this: under stock Rapier a soft body falls through a height field. Here it is
/// caught, in each step by contacts of the mesh as it is then, and comes to rest.
#[test]
fn a_soft_body_rests_on_a_height_field() {
    let ground = bowl();
    let mut stock = world(&ground, None);
    step(&mut stock, 300);
    assert!(heights(&stock)[0] < -50.0, "stock has learnt it: {:?}", heights(&stock));
    let dispatcher = counting();
    let mut ours = world(&ground, Some(&dispatcher));
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

/// Would catch contacts with the wrong part, or in its frame: the body rests where it does under
/// stock.
#[test]
fn a_soft_body_rests_on_a_compound_as_with_stock() {
    let ground = table();
    let dispatcher = counting();
    let (mut stock, mut ours) = (world(&ground, None), world(&ground, Some(&dispatcher)));
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

/// A world with a soft body on a height field, saved and restored, goes on bit for bit.
#[test]
fn a_restored_soft_body_goes_on_bit_for_bit() {
    for ground in [bowl(), table()] {
        let (dispatcher, other) = (counting(), counting());
        let mut world = world(&ground, Some(&dispatcher));
        step(&mut world, 60);
        let bytes = postcard::to_stdvec(&world).expect("a world with SBBK can be saved");
        let mut copy: PhysicsWorld = postcard::from_bytes(&bytes).expect("and loaded");
        copy.narrow_phase.set_query_dispatcher(other.clone());
        step(&mut world, 30);
        step(&mut copy, 30);
        assert_eq!(particles(&world), particles(&copy));
        assert!(other.stats().descended_queries > 20, "{:?}", other.stats());
    }
}
