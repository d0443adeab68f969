use crate::heightfield::terrain::rolling;
use crate::prelude::*;
use sbbk_testkit::scene::{MonkeyPile, Scene};
use sbbk_testkit::world::fingerprint;

/// Steps until heads lie on each other.
const BEFORE: usize = 60;
/// Steps that a world and its copy take side by side.
const AFTER: usize = 40;

/// Saves and loads a world. A snapshot holds no dispatcher.
fn restored(world: &PhysicsWorld, dispatcher: Option<&SbbkDispatcher>) -> PhysicsWorld {
    let bytes = postcard::to_stdvec(world).expect("a world with SBBK can be saved");
    let mut restored: PhysicsWorld = postcard::from_bytes(&bytes).expect("and loaded");
    if let Some(dispatcher) = dispatcher {
        restored.narrow_phase.set_query_dispatcher(dispatcher.clone());
    }
    restored
}

/// The farthest that a body is from where it is in the other world, in units.
fn difference(left: &PhysicsWorld, right: &PhysicsWorld) -> Real {
    let pairs = left.bodies.iter().zip(right.bodies.iter());
    let apart = pairs.map(|((_, l), (_, r))| (l.translation() - r.translation()).length());
    apart.fold(0.0, Real::max)
}

fn step(worlds: [&mut PhysicsWorld; 2], count: usize) {
    worlds.into_iter().for_each(|world| (0..count).for_each(|_| world.step()));
}

/// Worlds of bodies of every kind that come to lie on something.
fn worlds() -> Vec<(&'static str, PhysicsWorld)> {
    let pile = |contact_recycling| {
        MonkeyPile { contact_recycling, ..MonkeyPile::with_heads(8) }.build().world
    };
    let field = SharedShape::new(rolling(12.0, 24, 0.4));
    let ground = mesh::terrain(12.0, 24, 0.4).shape();
    vec![
        ("pile", pile(true)),
        ("pile without recycling", pile(false)),
        ("heads on a height field", heads_above(field, None).world),
        ("compounds on a mesh", dumbbells(None).world),
        ("soft body on a mesh", soft_ball_above(&ground, None)),
        ("soft body on a height field", soft_ball_above(&bowl(), None)),
        ("soft body on a compound", soft_ball_above(&table(), None)),
    ]
}

/// Would catch a workspace that cannot be saved, lost manifolds, order or impulses, and a tree for
/// each copy of a mesh.
#[test]
fn a_restored_world_goes_on_bit_for_bit() {
    for (name, mut world) in worlds() {
        world.narrow_phase.set_query_dispatcher(SbbkDispatcher::default());
        (0..BEFORE).for_each(|_| world.step());
        let other = counting_patches();
        let mut copy = restored(&world, Some(&other));
        for step in 0..AFTER {
            world.step();
            copy.step();
            assert!(fingerprint(&world) == fingerprint(&copy), "{name}, step {step}");
            assert_eq!(particles(&world), particles(&copy), "{name}, step {step}");
        }
        let stats = other.stats();
        assert!(stats.queries > 10 && stats.trees <= 2, "{name}: {stats:?}");
        assert!(stats.trees == 1 || !name.starts_with("pile"), "{name}: {stats:?}");
        let touches = world.contact_pairs().any(|pair| pair.has_any_active_contact());
        assert!(touches || name.starts_with("soft"), "{name}: nothing touches");
    }
}

/// Would catch a snapshot that only a world with SBBK can load, or contacts lost when the
/// dispatcher changes. Another order in the solver takes the worlds a little apart.
#[test]
fn a_world_goes_on_without_sbbk_or_begins_with_it() {
    const FEW: usize = 3;
    for was_sbbk in [true, false] {
        let dispatcher = per_triangle();
        let mut world = MonkeyPile::with_heads(8).build().world;
        if was_sbbk {
            world.narrow_phase.set_query_dispatcher(dispatcher.clone());
        }
        (0..BEFORE).for_each(|_| world.step());
        let mut copy = restored(&world, (!was_sbbk).then_some(&dispatcher));
        let [early, late] = [FEW, AFTER - FEW].map(|count| {
            step([&mut world, &mut copy], count);
            difference(&world, &copy)
        });
        assert!(early < 0.01 && late < 0.5, "{early} units apart, then {late}");
        assert!(late > 0.0, "both worlds have the same dispatcher");
    }
}
