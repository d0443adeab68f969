//! A long run in which bodies and meshes come and go all the time: does anything grow, slow down
//! or get lost?

use std::collections::VecDeque;
use std::mem::take;
use std::sync::Arc;

use glamx::Vec3;
use memory_stats::memory_stats;
use oorandom::Rand32;
use rapier_integration::{SbbkConfig, SbbkDispatcher};
use rapier3d::dynamics::{RigidBodyBuilder, RigidBodyHandle};
use rapier3d::math::Vector;
use rapier3d::pipeline::PhysicsWorld;

use super::Progress;
use crate::backend::{Backend, Probe, Timed};
use crate::mesh::{self, Mesh};
use crate::metrics::{ErrorCount, Summary, judged_step, timed_step};
use crate::report::{self, ERROR_NOTE, Results, Row, TableSpec, number, time};
use crate::scene::Solid;

/// How long, and how much at once.
#[derive(Clone, Copy, Debug)]
pub struct SoakPlan {
    /// Steps in all.
    pub steps: usize,
    /// Steps between two new bodies.
    pub spawn_every: usize,
    /// Bodies at once: with one more, the oldest is taken away.
    pub body_limit: usize,
    /// Steps of one row of the table.
    pub window: usize,
    /// Steps between two samples.
    pub sample_every: usize,
    /// Mesh pairs judged in a sampled step at most.
    pub sample_size: usize,
}

impl Default for SoakPlan {
    /// 10,000 steps, 40 bodies at once, 2500 in all.
    fn default() -> Self {
        Self {
            steps: 10_000,
            spawn_every: 4,
            body_limit: 40,
            window: 1000,
            sample_every: 100,
            sample_size: 12,
        }
    }
}

/// What trees of meshes that are gone may keep: little, so that the bound is reached soon and
/// memory must be flat from then on.
const IDLE_TREE_BYTES: usize = 1 << 20;

const SOAK: &str = "soak";

/// What a long run left behind.
pub struct SoakEnd {
    /// Wrong contacts, of all that were judged.
    pub wrong: u64,
    /// Trees left after all bodies were taken away, the world dropped and idle trees released.
    pub trees_left: usize,
}

/// Runs it: window by window, and the end.
pub fn soak(plan: &SoakPlan, progress: &Progress) -> (Results, SoakEnd) {
    let mut run = SoakRun::new();
    let mut rows = Vec::new();
    progress.phase("bodies come and go", plan.steps);
    let (mut times, mut errors) = (Vec::new(), ErrorCount::default());
    for step in 1..=plan.steps {
        if step % plan.spawn_every == 0 {
            run.spawn(plan.body_limit);
        }
        if step % plan.sample_every == 0 {
            errors += judged_step(&mut run.world, &run.probe, plan.sample_size, true);
        } else {
            times.push(timed_step(&mut run.world, &run.probe).step);
        }
        if step % plan.window == 0 {
            rows.push(run.row(step, take(&mut times), take(&mut errors)));
        }
        progress.step();
    }
    progress.finish();
    let body_count = run.body_count;
    let end = SoakEnd {
        wrong: rows.iter().map(|row| row.wrong("errors")).sum(),
        trees_left: run.clear(),
    };
    let spec = TableSpec::new(
        format!("{body_count} bodies, {} at once, on a mesh terrain", plan.body_limit),
        SOAK,
        &["until_step"],
        [
            time("ms a step", "time"),
            number("process, MiB", "memory"),
            number("trees built", "tree_builds"),
            number("trees", "trees"),
            number("idle", "idle_trees"),
            number("trees, MiB", "tree_memory"),
            number("mesh pairs judged", "errors.mesh_pairs"),
            report::errors("errors", "errors"),
        ],
    )
    .note(format!(
        "trees left after all bodies and the world went and idle trees were released: {}",
        end.trees_left
    ))
    .note("times: min / median over the steps")
    .note(ERROR_NOTE);
    let tables = vec![spec.of(&rows)];
    (Results::new(rows, tables, Vec::new()), end)
}

struct SoakRun {
    world: PhysicsWorld,
    dispatcher: Arc<SbbkDispatcher>,
    probe: Probe,
    random: Rand32,
    /// Oldest first.
    bodies: VecDeque<RigidBodyHandle>,
    /// A mesh that many bodies share.
    head: Solid,
    body_count: usize,
}

impl SoakRun {
    /// A mesh floor, and nothing on it.
    fn new() -> Self {
        let mut world = PhysicsWorld::new();
        let floor = Solid::new(&mesh::terrain(24.0, 24, 0.6));
        world.insert(RigidBodyBuilder::fixed(), floor.collider());
        let mut config = SbbkConfig::default();
        config.idle_tree_bytes = IDLE_TREE_BYTES;
        let dispatcher = Arc::new(SbbkDispatcher::new(config));
        let probe = Probe::default();
        world.narrow_phase.set_query_dispatcher(Timed::new(dispatcher.clone(), probe.clone()));
        Self {
            world,
            dispatcher,
            probe,
            random: Rand32::new(1),
            bodies: VecDeque::new(),
            head: Solid::new(&mesh::monkey_head_with(6).centred().scaled_to(1.5)),
            body_count: 0,
        }
    }

    /// One more body. Of each four, one has a mesh that it shares with others, two have a mesh of
    /// their own, and one exchanges the mesh of a living body.
    fn spawn(&mut self, limit: usize) {
        self.body_count += 1;
        let solid = match self.body_count % 4 {
            0 => self.head.clone(),
            _ => Solid::new(&self.new_mesh()),
        };
        let collider = solid.collider().build();
        if self.body_count % 4 == 1
            && let Some(&body) = self.bodies.back()
        {
            let old = self.world.bodies[body].colliders()[0];
            self.world.colliders[old].set_shape(collider.shared_shape().clone());
        }
        let place = Vector::new(self.between(-4.0, 4.0), 6.0, self.between(-4.0, 4.0));
        let body = RigidBodyBuilder::dynamic().translation(place);
        self.bodies.push_back(self.world.insert(body, collider).0);
        while self.bodies.len() > limit {
            self.remove_oldest();
        }
    }

    fn remove_oldest(&mut self) {
        if let Some(body) = self.bodies.pop_front() {
            self.world.remove_body(body);
        }
    }

    /// A mesh that never was before.
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

    /// Of the steps up to this one, in milliseconds and MiB.
    fn row(&self, step: usize, times: Vec<f64>, errors: ErrorCount) -> Row {
        let mebibytes = |bytes: usize| bytes as f64 / (1 << 20) as f64;
        let stats = self.dispatcher.stats();
        Row::new(SOAK, Backend::Sbbk)
            .key("until_step", step)
            .with("time", Summary::of(times))
            .with("memory", memory_stats().map(|memory| mebibytes(memory.physical_mem)))
            .with("trees", stats.trees)
            .with("idle_trees", stats.idle_trees)
            .with("tree_memory", mebibytes(stats.tree_bytes))
            .with("tree_builds", stats.tree_builds)
            .with("errors", errors)
    }

    /// Takes everything away, and the world last: Rapier keeps the pairs that it has retired, with
    /// what they hold, until it needs a new one. The trees that are left.
    fn clear(mut self) -> usize {
        while !self.bodies.is_empty() {
            self.remove_oldest();
        }
        for _ in 0..3 {
            self.world.step();
        }
        drop(self.world);
        self.dispatcher.release_idle_trees();
        self.dispatcher.stats().trees
    }
}
