use rapier_integration::SbbkDispatcher;
use rapier3d::dynamics::RigidBodyHandle;
use rapier3d::math::{Pose, Real};
use rapier3d::pipeline::PhysicsWorld;
use sbbk_testkit::scene::{MonkeyPile, Scene, SceneWorld};

use crate::support::per_triangle;

/// Steps until heads lie on each other.
const BEFORE: usize = 60;
/// Steps that a world and its copy take side by side.
const AFTER: usize = 40;

/// A small pile in full contact, under SBBK or stock.
fn pile(dispatcher: Option<&SbbkDispatcher>, contact_recycling: bool) -> SceneWorld {
    let scene = MonkeyPile { contact_recycling, ..MonkeyPile::with_heads(8) };
    let mut pile = scene.build();
    if let Some(dispatcher) = dispatcher {
        pile.world.narrow_phase.set_query_dispatcher(dispatcher.clone());
    }
    for _ in 0..BEFORE {
        pile.world.step();
    }
    pile
}

/// What a user does who saves a world and loads it again. A snapshot holds no dispatcher.
fn restored(world: &PhysicsWorld, dispatcher: Option<&SbbkDispatcher>) -> PhysicsWorld {
    let bytes = postcard::to_stdvec(world).expect("a world with SBBK can be saved");
    let mut restored: PhysicsWorld = postcard::from_bytes(&bytes).expect("and loaded");
    if let Some(dispatcher) = dispatcher {
        restored.narrow_phase.set_query_dispatcher(dispatcher.clone());
    }
    restored
}

fn poses(world: &PhysicsWorld, watched: &[RigidBodyHandle]) -> Vec<Pose> {
    watched.iter().map(|&body| *world.bodies[body].position()).collect()
}

/// The farthest that a body is from where it is in the other world, in units.
fn difference(left: &PhysicsWorld, right: &PhysicsWorld, watched: &[RigidBodyHandle]) -> Real {
    let poses = poses(left, watched).into_iter().zip(poses(right, watched));
    poses.map(|(l, r)| (l.translation - r.translation).length()).fold(0.0, Real::max)
}

/// How far a world and its copy are apart after a few steps and after all.
fn apart_after(
    left: &mut PhysicsWorld,
    right: &mut PhysicsWorld,
    watched: &[RigidBodyHandle],
) -> [Real; 2] {
    const FEW: usize = 3;
    [FEW, AFTER - FEW].map(|steps| {
        for _ in 0..steps {
            left.step();
            right.step();
        }
        difference(left, right, watched)
    })
}

/// Would catch a workspace that cannot be saved (which makes the whole world unreadable),
/// manifolds, their order or impulses lost on the way, and a tree for each of the copies that
/// loading makes of one mesh.
#[test]
fn a_restored_world_goes_on_bit_for_bit() {
    for contact_recycling in [true, false] {
        let dispatcher = SbbkDispatcher::default();
        let SceneWorld { mut world, watched } = pile(Some(&dispatcher), contact_recycling);
        let other = SbbkDispatcher::default();
        let mut copy = restored(&world, Some(&other));
        assert_eq!(apart_after(&mut world, &mut copy, &watched), [0.0; 2]);
        assert_eq!(poses(&world, &watched), poses(&copy, &watched));
        assert_eq!(other.stats().trees, 1);
    }
}

/// Would catch a snapshot that only a world with SBBK can load, or contacts that are lost when the
/// dispatcher changes: both find the same contacts and solve them in another order; chaos then takes
/// the worlds a few hundredths of a unit apart.
#[test]
fn a_world_goes_on_without_sbbk_or_begins_with_it() {
    for was_sbbk in [true, false] {
        let dispatcher = per_triangle();
        let SceneWorld { mut world, watched } = pile(was_sbbk.then_some(&dispatcher), true);
        let mut copy = restored(&world, (!was_sbbk).then_some(&dispatcher));
        let [early, late] = apart_after(&mut world, &mut copy, &watched);
        assert!(early < 0.01 && late < 0.5, "{early} units apart, then {late}");
        assert!(late > 0.0, "both worlds have the same dispatcher");
    }
}
