//! The same pairs of meshes at the same poses for every backend.
//!
//! Two runs of one scene on different backends drift apart: contacts that differ in the last bit
//! soon lead to other trajectories. Times of whole runs therefore compare different questions.
//! Here one run supplies the questions, and every backend answers all of them.

use std::time::{Duration, Instant};

use rapier3d::geometry::{ColliderHandle, SharedShape};
use rapier3d::math::{Pose, Real};
use rapier3d::pipeline::PhysicsWorld;

use crate::backend::{Answer, Memory, Question, SharedDispatcher};

/// The mesh-mesh pairs proposed by a world's broad phase, at its poses after two steps in a row.
///
/// Every pair is asked twice: *fresh* at the first pose, with nothing known about it, and
/// *steady* at the second, with the manifolds and the workspace of the first. A pair is asked
/// whether or not Rapier would have recycled its contacts.
#[derive(Debug)]
pub struct PosePairs {
    prediction: Real,
    pairs: Vec<Pair>,
}

#[derive(Debug)]
struct Pair {
    shapes: [SharedShape; 2],
    pos12: [Pose; 2],
}

/// Time of all queries, one after the other on one thread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sweep {
    /// All pairs at their first poses. The time to free the manifolds is not in it.
    pub fresh: Duration,
    /// All pairs again at their second poses.
    pub steady: Duration,
}

impl PosePairs {
    /// Collects the pairs of `world` and their poses now, then lets `step` step it once, and
    /// collects the poses again.
    pub fn capture(world: &mut PhysicsWorld, step: impl FnOnce(&mut PhysicsWorld)) -> Self {
        let pos12 = |world: &PhysicsWorld, handles: [ColliderHandle; 2]| {
            let [pos1, pos2] = handles.map(|handle| world.colliders[handle].position());
            pos1.inv_mul(pos2)
        };
        let mut asked = Vec::new();
        for pair in world.narrow_phase.contact_pairs() {
            let handles = [pair.collider1, pair.collider2];
            let shapes = handles.map(|handle| world.colliders[handle].shared_shape().clone());
            if shapes.iter().all(|shape| shape.as_trimesh().is_some()) {
                asked.push((handles, shapes, pos12(world, handles)));
            }
        }
        step(world);
        let pairs = asked.into_iter().map(|(handles, shapes, before)| Pair {
            shapes,
            pos12: [before, pos12(world, handles)],
        });
        let prediction = world.integration_parameters.prediction_distance();
        Self { prediction, pairs: pairs.collect() }
    }

    /// Number of pairs.
    pub fn pair_count(&self) -> usize {
        self.pairs.len()
    }

    /// Asks `dispatcher` about every pair, fresh and steady, and takes the time.
    pub fn sweep(&self, dispatcher: &SharedDispatcher) -> Sweep {
        let mut memories: Vec<Memory> = Vec::new();
        memories.resize_with(self.pairs.len(), Memory::default);
        let [fresh, steady] = [0, 1].map(|pose_index| {
            let start = Instant::now();
            for (index, memory) in memories.iter_mut().enumerate() {
                self.ask(dispatcher, index, pose_index, memory);
            }
            start.elapsed()
        });
        Sweep { fresh, steady }
    }

    /// The fresh (0) or steady (1) question about a pair. Panics when `index` is out of range.
    pub fn question(&self, index: usize, pose_index: usize) -> Question {
        let Pair { shapes: [shape1, shape2], pos12 } = &self.pairs[index];
        Question::new(&pos12[pose_index], [&**shape1, &**shape2], self.prediction)
    }

    /// The answers of `dispatcher` to the fresh and the steady question about a pair. Panics when
    /// `index` is out of range.
    pub fn answers(&self, dispatcher: &SharedDispatcher, index: usize) -> [Answer; 2] {
        let mut memory = Memory::default();
        [0, 1].map(|pose_index| {
            self.ask(dispatcher, index, pose_index, &mut memory);
            Answer::new(self.question(index, pose_index), &memory.manifolds)
        })
    }

    /// All shapes, those shared by several colliders repeated.
    pub fn shapes(&self) -> impl Iterator<Item = &SharedShape> {
        self.pairs.iter().flat_map(|pair| &pair.shapes)
    }

    fn ask(
        &self,
        dispatcher: &SharedDispatcher,
        index: usize,
        pose_index: usize,
        memory: &mut Memory,
    ) {
        let Pair { shapes, pos12 } = &self.pairs[index];
        let shapes = shapes.each_ref().map(|shape| &**shape);
        memory.ask(dispatcher, shapes, &pos12[pose_index], self.prediction);
    }
}
