//! Contacts of both backends at poses of a world, judged by brute force in f64.

use crate::prelude::*;
use rapier3d::parry::bounding_volume::BoundingVolume;

use crate::study::convex::errors::Judge as ConvexJudge;

/// Pairs that are judged at most: in all, and of one step. Higher: slower studies; lower: less
/// certain verdicts.
const JUDGED: usize = 20;
const JUDGED_AT_ONCE: usize = 7;

/// Wrong contacts of stock and of SBBK, without memory of a pair, for all contacts of triangles.
pub(super) struct Comparison {
    dispatchers: [Dispatcher; 2],
    primed: Vec<Primed>,
    pub judged: [ErrorCount; 2],
}

impl Comparison {
    pub fn new() -> Self {
        let dispatchers = [Backend::Stock, Backend::Sbbk].map(Backend::per_triangle);
        Self { dispatchers, primed: Vec::new(), judged: Default::default() }
    }

    /// Judges some of the pairs of the broad phase of a world.
    pub fn look(&mut self, world: &PhysicsWorld) {
        let limit = JUDGED_AT_ONCE.min(JUDGED - self.judged[0].mesh_pairs.min(JUDGED));
        if limit == 0 {
            return;
        }
        let contacts = world.contact_pairs().map(|pair| [pair.collider1, pair.collider2]);
        let contacts: Vec<Sequence> = contacts.filter_map(|pair| plain_pair(world, pair)).collect();
        let sensors = world.intersection_pairs().map(|(one, _, two, ..)| [one, two]);
        let sensors: Vec<Sequence> = sensors.filter_map(|pair| plain_pair(world, pair)).collect();
        let shapes = contacts.iter().chain(&sensors).flat_map(|pair| &pair.shapes);
        self.primed.push(Primed::new(&self.dispatchers[1], shapes));
        let answers = |pair| (pair, self.dispatchers.each_ref().map(|d| found(pair, d)));
        let touching = contacts.iter().map(answers);
        let touching: Vec<_> =
            touching.filter(|(_, answers)| answers.iter().any(|found| !found.is_empty())).collect();
        for index in sample_indices(touching.len(), limit) {
            let (pair, answers) = &touching[index];
            if let Some(truth) = truth(pair) {
                for (errors, manifolds) in self.judged.iter_mut().zip(answers) {
                    *errors += truth.judge_manifolds(manifolds).pairs;
                }
            }
        }
        for index in sample_indices(sensors.len(), limit) {
            self.judge_sensor(&sensors[index]);
        }
    }

    /// Judges if the surfaces of two meshes meet; ignores other shapes.
    fn judge_sensor(&mut self, pair: &Sequence) {
        let [shape1, shape2] = &pair.shapes;
        if shape1.as_trimesh().and(shape2.as_trimesh()).is_none() {
            return;
        }
        let meets = truth(pair).is_some_and(|truth| truth.meets());
        for (errors, dispatcher) in self.judged.iter_mut().zip(&self.dispatchers) {
            let answer = dispatcher.intersection_test(&pair.poses[0], &**shape1, &**shape2);
            let answer = answer.is_ok_and(|answer| answer.intersecting);
            errors.mesh_pairs += 1;
            errors.true_pairs += 1;
            errors.missed += usize::from(meets && !answer);
            errors.phantom += usize::from(answer && !meets);
        }
    }
}

/// Returns a pair at its pose in a world. `None` without a mesh, and with `FIX_INTERNAL_EDGES`: that flag changes
/// the contacts of triangles.
fn plain_pair(world: &PhysicsWorld, pair: [ColliderHandle; 2]) -> Option<Sequence> {
    let [one, two] = pair.map(|handle| &world.colliders[handle]);
    let shapes = [one, two].map(|collider| collider.shared_shape().clone());
    let mut meshes = shapes.iter().filter_map(|shape| shape.as_trimesh()).peekable();
    meshes.peek()?;
    if meshes.any(|mesh| mesh.flags().contains(TriMeshFlags::FIX_INTERNAL_EDGES)) {
        return None;
    }
    let poses = vec![one.position().inv_mul(two.position())];
    Some(Sequence { shapes, poses, prediction: world.integration_parameters.prediction_distance() })
}

/// The manifolds with points.
fn found(pair: &Sequence, dispatcher: &SharedDispatcher) -> Vec<ContactManifold> {
    let mut memory = Memory::default();
    pair.ask(&mut memory, dispatcher, 0);
    memory.manifolds.retain(|manifold| !manifold.points.is_empty());
    memory.manifolds
}

/// All true contacts; `None` if a mesh has no triangle near the other shape.
fn truth(pair: &Sequence) -> Option<Truth> {
    let Sequence { shapes: [shape1, shape2], poses, prediction } = pair;
    let pos12 = &poses[0];
    let near1 = Near::new(shape1, shape2, pos12, *prediction)?;
    let near2 = Near::new(shape2, shape1, &pos12.inverse(), *prediction)?;
    let shapes = [near1.shape.clone(), near2.shape.clone()];
    let truth = match shapes.each_ref().map(|shape| shape.as_trimesh().is_some()) {
        [true, true] => Sequence { shapes, ..pair.clone() }.truth(0),
        [true, false] => ConvexJudge::new(&shapes[0], shape2).truth(pos12, true, *prediction),
        _ => ConvexJudge::new(&shapes[1], shape1).truth(pos12, false, *prediction),
    };
    Some(truth.renumbered(|one, two| (near1.number(one), near2.number(two))))
}

/// The triangles of a mesh near a shape, as a mesh of their own, or a shape that is no mesh.
struct Near {
    shape: SharedShape,
    /// Indices of the triangles in the whole mesh.
    triangles: Vec<u32>,
}

impl Near {
    /// `pose` is that of the other shape in the frame of the first. `None` without such triangles.
    fn new(
        shape: &SharedShape,
        other: &SharedShape,
        pose: &Pose,
        prediction: Real,
    ) -> Option<Self> {
        let Some(mesh) = shape.as_trimesh() else {
            return Some(Self { shape: shape.clone(), triangles: Vec::new() });
        };
        let bounds = other.compute_aabb(pose).loosened(2.0 * prediction);
        let triangles: Vec<u32> = mesh.bvh().intersect_aabb(&bounds).collect();
        let corners =
            triangles.iter().flat_map(|&index| mesh.triangle(index).vertices().to_owned());
        let vertices: Vec<Vector> = corners.collect();
        let indices = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
        let shape = SharedShape::trimesh(vertices, indices.collect()).ok()?;
        Some(Self { shape, triangles })
    }

    /// Number of a subshape in the whole shape.
    fn number(&self, subshape: u32) -> u32 {
        self.triangles.get(subshape as usize).copied().unwrap_or(subshape)
    }
}
