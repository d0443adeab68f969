//! Contacts of both backends at poses of a world, judged by brute force in f64.

use crate::prelude::*;

use crate::study::pair::SIDES;

/// Pairs that are judged at most: in all, and of one step. Higher: slower studies; lower: less
/// certain verdicts.
const JUDGED: usize = 20;
const JUDGED_AT_ONCE: usize = 7;

/// Wrong contacts of stock and of SBBK, without memory of a pair, for all contacts of triangles.
pub(super) struct Comparison {
    dispatchers: [Dispatcher; 2],
    pub judged: [Errors; 2],
}

impl Comparison {
    pub fn new() -> Self {
        let dispatchers = SIDES.map(|backend| backend.per_triangle([]));
        Self { dispatchers, judged: Default::default() }
    }

    /// Judges some of the pairs of the broad phase of a world.
    pub fn look(&mut self, world: &PhysicsWorld) {
        let limit = JUDGED_AT_ONCE.min(JUDGED - self.judged[0].pairs.min(JUDGED));
        if limit == 0 {
            return;
        }
        let contacts = world.contact_pairs().map(|pair| [pair.collider1, pair.collider2]);
        let contacts: Vec<Sequence> = contacts.filter_map(|pair| plain_pair(world, pair)).collect();
        let sensors = world.intersection_pairs().map(|(one, _, two, ..)| [one, two]);
        let sensors: Vec<Sequence> = sensors.filter_map(|pair| plain_pair(world, pair)).collect();
        let shapes = contacts.iter().chain(&sensors).flat_map(|pair| &pair.shapes);
        self.dispatchers[1].prepare(shapes);
        let touches = |pair: &Sequence| {
            self.dispatchers.iter().any(|dispatcher| {
                let answer = pair.first_answer(dispatcher);
                answer.iter().any(|manifold| !manifold.points.is_empty())
            })
        };
        let touching: Vec<Sequence> = contacts.into_iter().filter(touches).collect();
        let touching: Vec<Sequence> = sample(&touching, limit).cloned().collect();
        let found = Sequence::errors(&touching, &self.dispatchers, |_| true);
        for (errors, found) in self.judged.iter_mut().zip(found) {
            *errors += found.without_normals();
        }
        sample(&sensors, limit).for_each(|pair| self.judge_sensor(pair));
    }

    /// Judges if the surfaces of two meshes meet; ignores other shapes.
    fn judge_sensor(&mut self, pair: &Sequence) {
        let [shape1, shape2] = &pair.shapes;
        if shape1.as_trimesh().and(shape2.as_trimesh()).is_none() {
            return;
        }
        let meets = pair.truth(0).meets();
        for (errors, dispatcher) in self.judged.iter_mut().zip(&self.dispatchers) {
            let answer = dispatcher.intersection_test(&pair.poses[0], &**shape1, &**shape2);
            let answer = answer.is_ok_and(|answer| answer.intersecting);
            errors.pairs += 1;
            errors.true_pairs += 1;
            errors.missed += usize::from(meets && !answer);
            errors.phantom += usize::from(answer && !meets);
        }
    }
}

/// Returns a pair at its pose in a world. `None` without a mesh, and with `FIX_INTERNAL_EDGES`: that
/// flag changes the contacts of triangles.
fn plain_pair(world: &PhysicsWorld, pair: [ColliderHandle; 2]) -> Option<Sequence> {
    let pair = Sequence::of(world, pair);
    let mut meshes = pair.shapes.iter().filter_map(|shape| shape.as_trimesh()).peekable();
    meshes.peek()?;
    let is_fixed = meshes.any(|mesh| mesh.flags().contains(TriMeshFlags::FIX_INTERNAL_EDGES));
    (!is_fixed).then_some(pair)
}
