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

    /// Brings the manifolds up to date for one pose. Panics when `step` is out of range.
    pub fn ask(&self, memory: &mut Memory, dispatcher: &SharedDispatcher, step: usize) {
        let [shape1, shape2] = self.shapes.each_ref().map(|shape| &**shape);
        let (pos12, Memory { manifolds, workspace }) = (&self.poses[step], memory);
        dispatcher
            .contact_manifolds(pos12, shape1, shape2, self.prediction, manifolds, workspace)
            .expect("every backend supports a mesh and the shapes of the studies");
    }

    /// The answer to a first query at the first pose.
    pub fn first_answer(&self, dispatcher: &SharedDispatcher) -> Vec<ContactManifold> {
        let mut memory = Memory::default();
        self.ask(&mut memory, dispatcher, 0);
        memory.manifolds
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
        let found = parallel::map(sequences, parallel::threads(), |_, sequence| {
            let mut errors = vec![Errors::default(); dispatchers.len()];
            let mut memories = dispatchers.iter().map(|_| Memory::default()).collect::<Vec<_>>();
            for step in 0..sequence.poses.len() {
                let truth = is_judged(step).then(|| sequence.truth(step));
                for (index, memory) in memories.iter_mut().enumerate() {
                    sequence.ask(memory, &dispatchers[index], step);
                    if let Some(truth) = &truth {
                        errors[index] += truth.judge(&memory.manifolds);
                    }
                }
            }
            errors
        });
        let mut sums = vec![Errors::default(); dispatchers.len()];
        for errors in found {
            sums.iter_mut().zip(errors).for_each(|(sum, errors)| *sum += errors);
        }
        sums
    }
}
