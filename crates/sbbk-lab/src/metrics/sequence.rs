//! Pairs of shapes, asked for their contacts at one pose after the other.
//!
//! Two runs of one scene drift apart, as a different last bit of a contact leads to another
//! trajectory. Here every backend has the same queries.

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
    /// The mesh-mesh pairs proposed by the broad phase of a world, at their poses now. Rapier may
    /// recycle the contacts of some.
    pub fn captured(world: &PhysicsWorld) -> Vec<Self> {
        let pairs = world.contact_pairs().map(|pair| [pair.collider1, pair.collider2]);
        let pairs = pairs.map(|pair| Self::of(world, pair));
        pairs.filter(|pair| pair.shapes.iter().all(|s| s.as_trimesh().is_some())).collect()
    }

    /// Two colliders at their poses now.
    pub fn of(world: &PhysicsWorld, pair: [ColliderHandle; 2]) -> Self {
        let [one, two] = pair.map(|handle| &world.colliders[handle]);
        Self {
            shapes: [one, two].map(|collider| collider.shared_shape().clone()),
            poses: vec![one.position().inv_mul(two.position())],
            prediction: world.integration_parameters.prediction_distance(),
        }
    }

    /// Asks `dispatcher` at one pose. Panics when `step` is out of range.
    pub fn ask(&self, memory: &mut Memory, dispatcher: &SharedDispatcher, step: usize) {
        let shapes = self.shapes.each_ref().map(|shape| &**shape);
        memory.ask(dispatcher, shapes, &self.poses[step], self.prediction);
    }

    /// The truth about one pose. Panics when `step` is out of range.
    pub fn truth(&self, step: usize) -> Truth {
        Truth::of(self.shapes.each_ref(), &self.poses[step], self.prediction)
    }

    /// Errors of each dispatcher in the judged steps of all sequences together.
    pub fn errors(
        sequences: &[Self],
        dispatchers: &[Dispatcher],
        is_judged: impl Fn(usize) -> bool + Sync,
    ) -> Vec<Errors> {
        let errors = parallel::map(sequences, parallel::threads(), |_, sequence| {
            let mut errors = vec![Errors::default(); dispatchers.len()];
            let mut memories = dispatchers.iter().map(|_| Memory::default()).collect::<Vec<_>>();
            for step in 0..sequence.poses.len() {
                let truth = is_judged(step).then(|| sequence.truth(step));
                for (index, memory) in memories.iter_mut().enumerate() {
                    sequence.ask(memory, &dispatchers[index], step);
                    errors[index] += truth.iter().map(|t| t.judge(&memory.manifolds)).sum();
                }
            }
            errors
        });
        let sum = |index: usize| errors.iter().map(|errors| errors[index]).sum();
        (0..dispatchers.len()).map(sum).collect()
    }
}
