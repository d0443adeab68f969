//! Pairs of shapes, asked for their contacts at one pose after the other.
//!
//! Two runs of one scene drift apart, as a different last bit of a contact leads to another
//! trajectory. Here every backend has the same queries.

use super::Judge;
use crate::prelude::*;

/// Two shapes, asked for their contacts at one pose after the other, each with what the query
/// before left.
#[derive(Clone, Debug)]
pub struct Sequence {
    pub shapes: [SharedShape; 2],
    /// Poses of the second one in the frame of the first.
    pub poses: Vec<Pose>,
    /// The prediction distance of all queries.
    pub prediction: Real,
}

impl Sequence {
    /// The mesh-mesh pairs proposed by the broad phase of `world`, at their poses now, and at those
    /// after `step` has stepped it once. A pair is asked whether or not Rapier would have recycled
    /// its contacts.
    pub fn captured(world: &mut PhysicsWorld, step: impl FnOnce(&mut PhysicsWorld)) -> Vec<Self> {
        let pos12 = |world: &PhysicsWorld, handles: [ColliderHandle; 2]| {
            let [pos1, pos2] = handles.map(|handle| world.colliders[handle].position());
            pos1.inv_mul(pos2)
        };
        let prediction = world.integration_parameters.prediction_distance();
        let mut handles = Vec::new();
        let mut sequences = Vec::new();
        for pair in world.narrow_phase.contact_pairs() {
            let pair = [pair.collider1, pair.collider2];
            let shapes = pair.map(|handle| world.colliders[handle].shared_shape().clone());
            if shapes.iter().all(|shape| shape.as_trimesh().is_some()) {
                handles.push(pair);
                sequences.push(Self { shapes, poses: vec![pos12(world, pair)], prediction });
            }
        }
        step(world);
        for (sequence, pair) in sequences.iter_mut().zip(handles) {
            sequence.poses.push(pos12(world, pair));
        }
        sequences
    }

    /// Asks `dispatcher` at one pose. Panics when `step` is out of range.
    pub fn ask(&self, memory: &mut Memory, dispatcher: &SharedDispatcher, step: usize) {
        let shapes = self.shapes.each_ref().map(|shape| &**shape);
        memory.ask(dispatcher, shapes, &self.poses[step], self.prediction);
    }

    /// Asks everything, and shows the manifolds after each query, by its number.
    pub fn walk(
        &self,
        dispatcher: &SharedDispatcher,
        mut seen: impl FnMut(usize, &[ContactManifold]),
    ) {
        let mut memory = Memory::default();
        for step in 0..self.poses.len() {
            self.ask(&mut memory, dispatcher, step);
            seen(step, &memory.manifolds);
        }
    }

    /// The truth about one pose of two meshes. Panics when `step` is out of range.
    pub fn truth(&self, step: usize) -> Truth {
        let shapes = self.shapes.each_ref().map(|shape| &**shape);
        let question = Question::new(&self.poses[step], shapes, self.prediction);
        Judge::new(&self.shapes).truth(&question)
    }

    /// Errors of each dispatcher, all sequences together, where `truth` tells it of the step of a
    /// sequence, both by their numbers.
    pub fn errors<const N: usize>(
        sequences: &[Self],
        dispatchers: [&SharedDispatcher; N],
        truth: impl Fn(usize, usize) -> Option<Truth> + Sync,
    ) -> [ContactErrors; N] {
        let errors = parallel::map(sequences, parallel::threads(), |index, sequence| {
            let truths: Vec<Option<Truth>> =
                (0..sequence.poses.len()).map(|step| truth(index, step)).collect();
            dispatchers.map(|dispatcher| {
                let mut errors = ContactErrors::default();
                sequence.walk(dispatcher, |step, manifolds| {
                    errors += (truths[step].iter()).map(|t| t.judge_manifolds(manifolds)).sum();
                });
                errors
            })
        });
        std::array::from_fn(|side| errors.iter().map(|sides| sides[side]).sum())
    }
}
