//! Long runs, too slow for each build: `cargo test --workspace -- --ignored`.

use crate::determinism::run;
use crate::prelude::*;
use sbbk_testkit::scene::{BoxStack, HeadOnSlope, HelicopterBallDrop, MonkeyPile, Scene, collider};
use std::collections::VecDeque;

/// Bytes of trees that stay when their meshes are gone: little, so that the bound is soon reached.
const IDLE_BYTES: usize = 1 << 20;
/// Bodies at once, and steps between two new ones.
const BODIES: usize = 40;
const SPAWN_EVERY: usize = 4;

struct Soak {
    world: PhysicsWorld,
    dispatcher: SbbkDispatcher,
    random: Rand32,
    /// Oldest first.
    bodies: VecDeque<RigidBodyHandle>,
}

impl Soak {
    /// A mesh floor without bodies.
    fn new() -> Self {
        let dispatcher = with(|config| config.idle_tree_bytes = IDLE_BYTES);
        let world = world_of([collider(&mesh::terrain(24.0, 24, 0.6))], dispatcher.clone());
        Self { world, dispatcher, random: Rand32::new(1), bodies: VecDeque::new() }
    }

    /// Adds a body with a mesh of its own and removes the oldest. Every fourth body exchanges the
    /// mesh of a living one.
    fn spawn(&mut self, count: usize) {
        let collider = collider(&self.new_mesh()).build();
        if count % 4 == 1
            && let Some(&body) = self.bodies.back()
        {
            let old = self.world.bodies[body].colliders()[0];
            self.world.colliders[old].set_shape(collider.shared_shape().clone());
        }
        let place = Vector::new(self.between(-4.0, 4.0), 6.0, self.between(-4.0, 4.0));
        let body = RigidBodyBuilder::dynamic().translation(place);
        self.bodies.push_back(self.world.insert(body, collider).0);
        if self.bodies.len() > BODIES {
            self.remove_oldest();
        }
    }

    fn remove_oldest(&mut self) {
        if let Some(body) = self.bodies.pop_front() {
            self.world.remove_body(body);
        }
    }

    fn new_mesh(&mut self) -> Mesh {
        let size = self.between(0.5, 1.5);
        let stretch = Vec3::new(self.between(0.7, 1.3), self.between(0.7, 1.3), 1.0);
        let detail = self.random.rand_range(4..12);
        let mesh = match self.random.rand_range(0..3) {
            0 => mesh::ball(0.5 * size, detail),
            1 => mesh::torus(0.4 * size, 0.15 * size, 2 * detail, detail),
            _ => mesh::monkey_head_with(detail / 2 + 2).centred().scaled_to(size),
        };
        mesh.mapped(|vertex| stretch * vertex)
    }

    fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.random.rand_float()
    }
}

/// Would catch trees that stay when their meshes are gone, and an idle cache without bound.
#[test]
#[ignore = "takes a minute"]
fn bodies_that_come_and_go_leave_no_tree_behind() {
    let mut soak = Soak::new();
    for step in 1..=4000 {
        if step % SPAWN_EVERY == 0 {
            soak.spawn(step / SPAWN_EVERY);
        }
        soak.world.step();
        assert!(soak.dispatcher.stats().trees < 20 * BODIES, "{:?}", soak.dispatcher.stats());
    }
    while !soak.bodies.is_empty() {
        soak.remove_oldest();
    }
    // Rapier keeps retired pairs, with their workspaces, until it needs a new one.
    (0..3).for_each(|_| soak.world.step());
    drop(soak.world);
    soak.dispatcher.release_idle_trees();
    assert_eq!(soak.dispatcher.stats().trees, 0);
}

/// Would catch worlds that depend on addresses, on hash order, or on memory of earlier steps.
#[test]
#[ignore = "takes a minute"]
fn worlds_are_equal_to_the_bit_after_hundreds_of_steps() {
    let scenes: [Box<dyn Scene>; 5] = [
        Box::new(MonkeyPile::with_heads(60)),
        Box::new(MonkeyPile { contact_recycling: false, ..MonkeyPile::with_heads(30) }),
        Box::new(HelicopterBallDrop),
        Box::new(BoxStack),
        Box::new(HeadOnSlope { angle: 0.17 }),
    ];
    for scene in &scenes {
        let run = |forgets_every| run(&scene.name(), scene.build().world, 300, forgets_every);
        let first = run(None);
        assert!(first == run(None), "{}, again", scene.name());
        assert!(first == run(Some(1)), "{}, without memory", scene.name());
    }
}
