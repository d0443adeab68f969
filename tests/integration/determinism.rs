use rapier_integration::SbbkDispatcher;
use rapier3d::pipeline::PhysicsWorld;
use sbbk_testkit::scene::{BoxStack, HelicopterBallDrop, MonkeyPile, Scene};
use sbbk_testkit::world::fingerprint;

/// Runs a scene; `before_step` may meddle with the world. Its state at some steps.
fn run(scene: &dyn Scene, mut before_step: impl FnMut(usize, &mut PhysicsWorld)) -> Vec<u64> {
    let mut world = scene.build().world;
    world.narrow_phase.set_query_dispatcher(SbbkDispatcher::default());
    let (mut states, mut touching_steps) = (Vec::new(), 0);
    for step in 0..200 {
        before_step(step, &mut world);
        world.step();
        let is_touching = world.contact_pairs().any(|pair| pair.has_any_active_contact());
        touching_steps += usize::from(is_touching);
        if step % 20 == 19 {
            states.push(fingerprint(&world));
        }
    }
    // Less than that has the ball which rolls off the rotor, bounces off the fuselage, and is gone.
    assert!(touching_steps > 20, "something touches in {touching_steps} steps");
    states
}

fn scenes() -> Vec<Box<dyn Scene>> {
    vec![
        Box::new(MonkeyPile { contact_recycling: false, ..MonkeyPile::with_heads(8) }),
        Box::new(MonkeyPile::with_heads(12)),
        Box::new(BoxStack),
    ]
}

/// Would catch uninitialised memory, an order by addresses or hashes, and state left for the next
/// world.
#[test]
fn a_scene_runs_the_same_again() {
    for scene in scenes() {
        assert_eq!(run(&*scene, |_, _| ()), run(&*scene, |_, _| ()), "{}", scene.name());
    }
    let drop = HelicopterBallDrop;
    let states = run(&drop, |_, world| world.integration_parameters.contact_recycling = false);
    assert_eq!(
        states,
        run(&drop, |_, world| world.integration_parameters.contact_recycling = false)
    );
}

/// Would catch contacts, or an order, that depend on memory of the steps before.
#[test]
fn memory_is_never_part_of_the_answer() {
    for scene in scenes() {
        let expected = run(&*scene, |_, _| ());
        for period in [1, 7] {
            let states = run(&*scene, |step, world| {
                if step % period == 0 {
                    world.narrow_phase.set_query_dispatcher(SbbkDispatcher::default());
                }
            });
            assert_eq!(states, expected, "{}, every {period} steps", scene.name());
        }
    }
}

/// The reverse: would catch hashes that are equal because they see nothing.
#[test]
fn other_seeds_have_other_hashes() {
    let [one, other] = [1, 2].map(|seed| MonkeyPile { seed, ..MonkeyPile::with_heads(8) });
    let [one, other] = [one, other].map(|scene| run(&scene, |_, _| ()));
    assert!(one.iter().zip(&other).all(|(one, other)| one != other));
}
