use crate::prelude::*;
use sbbk_testkit::scene::{BoxStack, HelicopterBallDrop, MonkeyPile, Scene};
use sbbk_testkit::world::fingerprint;

const STEPS: usize = 200;

/// Poses and contacts of bodies, and the places of particles.
type State = (u64, Vec<Vector>);

/// Runs a world, with a new dispatcher every so many steps. Its state at some steps.
pub fn run(
    name: &str,
    mut world: PhysicsWorld,
    steps: usize,
    forgets_every: Option<usize>,
) -> Vec<State> {
    let dispatcher = counting_patches();
    world.narrow_phase.set_query_dispatcher(dispatcher.clone());
    let (mut states, mut touching_steps) = (Vec::new(), 0);
    for step in 0..steps {
        if forgets_every.is_some_and(|period| step % period == 0) {
            world.narrow_phase.set_query_dispatcher(SbbkDispatcher::default());
        }
        world.step();
        let is_touching = world.contact_pairs().any(|pair| pair.has_any_active_contact());
        touching_steps += usize::from(is_touching);
        if step % 20 == 19 {
            states.push((fingerprint(&world), particles(&world)));
        }
    }
    // Less than that has the ball which rolls off the rotor, bounces off the fuselage, and is gone.
    assert!(touching_steps > 20, "{name}: touches in {touching_steps} steps");
    let stats = dispatcher.stats();
    assert!(stats.queries >= 10 || forgets_every.is_some(), "{name}: {stats:?}");
    let must_reuse = name.starts_with("bodies") && forgets_every.is_none();
    assert!(stats.internals.reused_queries > 100 || !must_reuse, "{name}: {stats:?}");
    states
}

fn pile(seed: u64) -> MonkeyPile {
    MonkeyPile { contact_recycling: false, seed, ..MonkeyPile::with_heads(8) }
}

/// Bodies of every kind, and soft ones.
fn worlds() -> Vec<(String, PhysicsWorld)> {
    let scenes: [&dyn Scene; 4] =
        [&pile(1), &MonkeyPile::with_heads(12), &BoxStack, &HelicopterBallDrop];
    let mut worlds = Vec::from(scenes.map(|scene| (scene.name(), scene.build().world)));
    for (name, ground) in
        [("mesh", mesh::terrain(12.0, 24, 0.4).shape()), ("field", bowl()), ("boxes", table())]
    {
        worlds.push((format!("soft ball on a {name}"), soft_ball_above(&ground, None)));
    }
    for unit in [0.01, 0.1, 1.0, 100.0] {
        for has_soft_ccd in [false, true] {
            let name = format!("bodies of every kind in units of {unit}, soft CCD {has_soft_ccd}");
            worlds.push((name, mixed(unit, has_soft_ccd)));
        }
    }
    worlds
}

/// Would catch uninitialised memory, an order by addresses or hashes, and state left for the next
/// world. Would also catch contacts that depend on memory of the steps before.
#[test]
fn a_world_runs_the_same_again_whatever_it_forgets() {
    let periods = [None, Some(1), Some(7)].map(|period| (period, worlds()));
    let first = worlds().into_iter().map(|(name, world)| run(&name, world, STEPS, None));
    let first: Vec<_> = first.collect();
    for (period, worlds) in periods {
        for ((name, world), expected) in worlds.into_iter().zip(&first) {
            assert!(
                run(&name, world, STEPS, period) == *expected,
                "{name}, forgets every {period:?}"
            );
        }
    }
}

/// The reverse: would catch hashes that are equal because they see nothing.
#[test]
fn other_seeds_have_other_hashes() {
    let [one, other] = [1, 2].map(|seed| run("pile", pile(seed).build().world, STEPS, None));
    assert!(one.iter().zip(&other).all(|(one, other)| one != other));
}
