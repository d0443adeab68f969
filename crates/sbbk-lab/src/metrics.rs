//! Times, errors against the truth in f64, and pairs of shapes that are asked for their contacts.

use crate::prelude::*;

pub use sbbk_testkit::judge::{Errors, Truth};
pub use sbbk_testkit::world::solver_points;

/// Least, middle, mean and greatest of some values. Times are reported by minimum, which other work
/// of the machine disturbs least, and by median.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Summary {
    pub count: usize,
    pub min: f64,
    /// The middle one, or the mean of the middle two.
    pub median: f64,
    /// All but a hundredth are no greater.
    pub p99: f64,
    pub mean: f64,
    pub max: f64,
}

impl Summary {
    /// Returns the summary of some values; `None` without values. NaN is the largest value.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut sorted: Vec<f64> = values.into_iter().collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let count = sorted.len();
        let (&min, &max) = (sorted.first()?, sorted.last()?);
        Some(Self {
            count,
            min,
            median: 0.5 * (sorted[(count - 1) / 2] + sorted[count / 2]),
            p99: sorted[(0.99 * count as f64).ceil() as usize - 1],
            mean: sorted.iter().sum::<f64>() / count as f64,
            max,
        })
    }
}

/// Geometric mean; `None` without values. A value that is not positive makes it 0 or NaN.
pub fn geometric_mean(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let logarithms = Summary::of(values.into_iter().map(f64::ln))?;
    Some(logarithms.mean.exp())
}

/// At most `limit` of some items, evenly spread.
pub fn sample<T>(items: &[T], limit: usize) -> impl ExactSizeIterator<Item = &T> {
    let (count, sample_count) = (items.len(), items.len().min(limit));
    (0..sample_count).map(move |i| &items[i * count / sample_count])
}

/// Two shapes, asked for their contacts at one pose after the other, each with what the query
/// before left.
///
/// Two runs of one scene drift apart, as a different last bit of a contact leads to another
/// trajectory. Here every backend has the same queries.
#[derive(Clone, Debug)]
pub struct Sequence {
    pub shapes: [SharedShape; 2],
    /// Poses of the second one in the frame of the first.
    pub poses: Vec<Pose>,
    /// The prediction distance of all queries.
    pub prediction: Real,
}

impl Sequence {
    /// The mesh-mesh pairs proposed by the broad phase of a world, at their poses now, and their
    /// colliders.
    pub fn captured(world: &PhysicsWorld) -> (Vec<Self>, Vec<[ColliderHandle; 2]>) {
        let pairs = world.contact_pairs().map(|pair| [pair.collider1, pair.collider2]);
        let pairs = pairs.map(|pair| (Self::of(world, pair), pair));
        pairs.filter(|(pair, _)| pair.shapes.iter().all(|s| s.as_trimesh().is_some())).unzip()
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

/// Would catch a median or percentile off by one place.
#[test]
fn numbers_are_summed_up() {
    let odd = Summary::of([9.0, 1.0, 4.0]).unwrap();
    assert_eq!((odd.min, odd.median, odd.max, odd.p99), (1.0, 4.0, 9.0, 9.0));
    let even = Summary::of([9.0, 1.0, 4.0, 2.0]).unwrap();
    assert_eq!((even.count, even.median, even.mean), (4, 3.0, 4.0));
    assert_eq!(Summary::of((1..=200).map(f64::from)).unwrap().p99, 198.0);
    assert!((geometric_mean([2.0, 0.5]).unwrap() - 1.0).abs() < 1e-12);
}
