//! Both sides on the same queries, in turn.

use std::time::{Duration, Instant};

use glamx::Pose3;
use rapier3d::geometry::{ContactManifold, SharedShape};
use rapier3d::math::Real;

use super::errors::{Expected, Posed};
use crate::backend::SharedDispatcher;
use crate::metrics::ErrorCount;
use crate::study::contacts::{Contest, Measured, Memory};

/// A mesh and a shape, and sequences of poses of the mesh in the shape's frame.
pub(super) struct Course<'a> {
    pub mesh: &'a SharedShape,
    pub shape: &'a SharedShape,
    pub prediction: Real,
    /// Each is asked with what the query before left. The first query of a longer one is not timed.
    pub sequences: Vec<Vec<Pose3>>,
}

impl Course<'_> {
    /// Times and judges both sides.
    pub fn measure(&self, contest: &Contest, repeats: usize) -> [Measured<ErrorCount>; 2] {
        let timed = self.sequences.iter().map(|poses| (poses.len() - 1).max(1)).sum();
        let times = contest.race(repeats, timed, |dispatcher| self.sweep(dispatcher));
        Measured::both(times, self.judge(contest))
    }

    fn sweep(&self, dispatcher: &SharedDispatcher) -> Duration {
        let mut time = Duration::ZERO;
        for (index, poses) in self.sequences.iter().enumerate() {
            let mut memory = Memory::default();
            let (first, rest) = poses.split_at(usize::from(poses.len() > 1));
            first.iter().for_each(|pose| self.ask(&mut memory, dispatcher, index, pose));
            let start = Instant::now();
            rest.iter().for_each(|pose| self.ask(&mut memory, dispatcher, index, pose));
            if first.is_empty() {
                drop(memory);
            }
            time += start.elapsed();
        }
        time
    }

    /// Every other sequence is asked with the mesh first.
    fn ask(&self, memory: &mut Memory, dispatcher: &SharedDispatcher, index: usize, pose: &Pose3) {
        let (mesh, shape) = (&*self.mesh.0, &*self.shape.0);
        let pair = if is_mesh_first(index) { [mesh, shape] } else { [shape, mesh] };
        memory.ask_pair(dispatcher, pair, &pos12(index, pose), self.prediction);
    }

    fn judge(&self, contest: &Contest) -> [ErrorCount; 2] {
        let mut errors = [ErrorCount::default(); 2];
        for (index, poses) in self.sequences.iter().enumerate() {
            let mut memories = [Memory::default(), Memory::default()];
            let subshapes = |manifold: &ContactManifold| {
                let (one, two) = (manifold.subshape1, manifold.subshape2);
                if is_mesh_first(index) { (one, two) } else { (two, one) }
            };
            for pose in poses {
                let &Self { mesh, shape, prediction, .. } = self;
                let (pos12, is_mesh_first) = (pos12(index, pose), is_mesh_first(index));
                let expected =
                    Expected::new(Posed { mesh, shape, pos12, is_mesh_first }, prediction);
                for side in 0..2 {
                    self.ask(&mut memories[side], &contest.dispatchers[side], index, pose);
                    errors[side] += expected.judge(&memories[side].manifolds, subshapes);
                }
            }
        }
        errors
    }
}

/// The pose of the second shape in the frame of the first.
fn pos12(index: usize, pose: &Pose3) -> Pose3 {
    if is_mesh_first(index) { pose.inverse() } else { *pose }
}

fn is_mesh_first(index: usize) -> bool {
    index.is_multiple_of(2)
}
