//! One way to answer for a head on a terrain.

use std::sync::Arc;
use std::time::{Duration, Instant};

use glamx::Pose3;
use rapier_integration::{SbbkConfig, SbbkDispatcher};
use rapier3d::geometry::{ContactManifold, SharedShape};
use rapier3d::math::Real;

use super::plan::PREDICTION;
use crate::backend::{Answer, Backend, Question, Reported, SharedDispatcher};
use crate::metrics::{ErrorCount, Judge};
use crate::scene::Ground;
use crate::study::contacts::{Memory, STEP_COUNT};

/// A terrain and who answers for it.
pub(super) struct Way<'a> {
    pub backend: Backend,
    pub dispatcher: &'a SharedDispatcher,
    pub ground: Ground,
    pub shape: &'a SharedShape,
}

impl Way<'_> {
    fn ask(&self, memory: &mut Memory, head: &SharedShape, pose: &Pose3) {
        memory.ask_pair(self.dispatcher, [&*self.shape.0, &*head.0], pose, PREDICTION);
    }

    pub fn fresh(&self, head: &SharedShape, motions: &[Vec<Pose3>]) -> (Duration, usize) {
        let start = Instant::now();
        for poses in motions {
            self.ask(&mut Memory::default(), head, &poses[0]);
        }
        (start.elapsed(), motions.len())
    }

    pub fn steady(&self, head: &SharedShape, motions: &[Vec<Pose3>]) -> (Duration, usize) {
        let mut time = Duration::ZERO;
        for poses in motions {
            let mut memory = Memory::default();
            self.ask(&mut memory, head, &poses[0]);
            let start = Instant::now();
            poses[1..].iter().for_each(|pose| self.ask(&mut memory, head, pose));
            time += start.elapsed();
        }
        (time, motions.len() * STEP_COUNT)
    }

    /// Judges the first and the last answer of each motion.
    pub fn errors(
        &self,
        judge: &Judge,
        (ground, head): (&SharedShape, &SharedShape),
        cells: u32,
        motions: &[Vec<Pose3>],
    ) -> ErrorCount {
        let mut errors = ErrorCount::default();
        for poses in motions {
            let mut memory = Memory::default();
            for (index, pose) in poses.iter().enumerate() {
                self.ask(&mut memory, head, pose);
                if index == 0 || index == STEP_COUNT {
                    let question = Question::new(pose, [&*ground.0, &*head.0], PREDICTION);
                    let reported = memory.manifolds.iter().filter_map(|m| self.reported(m, cells));
                    let answer = Answer { question, reported: reported.collect() };
                    errors += judge.truth(&question).judge(&answer);
                }
            }
        }
        errors
    }

    /// A manifold with the number that its triangle has in the mesh of the terrain.
    fn reported(&self, manifold: &ContactManifold, cells: u32) -> Option<Reported> {
        let distances = manifold.points.iter().map(|point| point.dist);
        let distance = distances.reduce(Real::min).filter(|&distance| distance <= PREDICTION)?;
        let id = manifold.subshape1;
        let triangle1 = match self.shape.as_heightfield() {
            None => id,
            Some(_) => {
                let (cell, side) = (id % (cells * cells), id / (cells * cells));
                2 * ((cell % cells) * cells + cell / cells) + side
            }
        };
        Some(Reported { triangle1, triangle2: manifold.subshape2, distance })
    }

    /// Cells read by a first query, on the mean; `None` on a mesh.
    pub fn cells_read(&self, head: &SharedShape, motions: &[Vec<Pose3>]) -> Option<f64> {
        self.shape.as_heightfield()?;
        let mut config = SbbkConfig::default();
        config.count_queries = true;
        let counting = SbbkDispatcher::new(config);
        let dispatcher: &SharedDispatcher = &(Arc::new(counting.clone()) as _);
        for poses in motions {
            Way { dispatcher, ..*self }.ask(&mut Memory::default(), head, &poses[0]);
        }
        Some(counting.stats().descent.cells as f64 / motions.len().max(1) as f64)
    }
}
