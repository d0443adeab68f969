//! Contacts of both backends at poses of a world, judged by brute force in f64.

use crate::prelude::*;
use rapier3d::geometry::TriMesh;
use rapier3d::parry::bounding_volume::BoundingVolume;

use crate::metrics::Judge;
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
        let prediction = world.integration_parameters.prediction_distance();
        let contacts = world.contact_pairs().map(|pair| [pair.collider1, pair.collider2]);
        let pair = |handles| Pair::new(world, handles, prediction);
        let contacts: Vec<Pair> = contacts.filter_map(pair).collect();
        let sensors = world.intersection_pairs().map(|(one, _, two, ..)| [one, two]);
        let sensors: Vec<Pair> = sensors.filter_map(pair).collect();
        let shapes = contacts.iter().chain(&sensors).flat_map(|pair| &pair.shapes);
        self.primed.push(Primed::new(&self.dispatchers[1], shapes));
        let answers = |pair| (pair, self.dispatchers.each_ref().map(|d| Pair::contacts(pair, d)));
        let touching = contacts.iter().map(answers);
        let touching: Vec<_> =
            touching.filter(|(_, answers)| answers.iter().any(|found| !found.is_empty())).collect();
        for index in sample_indices(touching.len(), limit) {
            let (pair, answers) = &touching[index];
            if let Some(truth) = pair.truth() {
                for (errors, manifolds) in self.judged.iter_mut().zip(answers) {
                    *errors += truth.judge_manifolds(manifolds).pairs;
                }
            }
        }
        for index in sample_indices(sensors.len(), limit) {
            self.judge_sensor(&sensors[index]);
        }
    }

    fn judge_sensor(&mut self, pair: &Pair) {
        let Some(truth) = pair.meets() else { return };
        let [shape1, shape2] = &pair.shapes;
        for (errors, dispatcher) in self.judged.iter_mut().zip(&self.dispatchers) {
            let answer = dispatcher.intersection_test(&pair.pos12, &**shape1, &**shape2);
            let answer = answer.is_ok_and(|meets| meets.intersecting);
            errors.mesh_pairs += 1;
            errors.true_pairs += 1;
            errors.missed += usize::from(truth && !answer);
            errors.phantom += usize::from(answer && !truth);
        }
    }
}

/// A pair of shapes, at least one of them a mesh.
struct Pair {
    shapes: [SharedShape; 2],
    pos12: Pose,
    prediction: Real,
}

impl Pair {
    /// `None` without a mesh, and with `FIX_INTERNAL_EDGES`, where contacts are not those of the
    /// triangles alone.
    fn new(world: &PhysicsWorld, pair: [ColliderHandle; 2], prediction: Real) -> Option<Self> {
        let [one, two] = pair.map(|handle| &world.colliders[handle]);
        let shapes = [one, two].map(|collider| collider.shared_shape().clone());
        let mut meshes = shapes.iter().filter_map(|shape| shape.as_trimesh()).peekable();
        meshes.peek()?;
        if meshes.any(|mesh| mesh.flags().contains(TriMeshFlags::FIX_INTERNAL_EDGES)) {
            return None;
        }
        let pos12 = one.position().inv_mul(two.position());
        Some(Self { shapes, pos12, prediction })
    }

    fn contacts(&self, dispatcher: &Dispatcher) -> Vec<ContactManifold> {
        let mut memory = Memory::default();
        let shapes = self.shapes.each_ref().map(|shape| &**shape);
        memory.ask(dispatcher, shapes, &self.pos12, self.prediction);
        memory.manifolds.retain(|manifold| !manifold.points.is_empty());
        memory.manifolds
    }

    /// All true contacts.
    fn truth(&self) -> Option<Truth> {
        let [shape1, shape2] = &self.shapes;
        let convex = |near: Near, other: &SharedShape, is_mesh_first: bool| {
            let truth = ConvexJudge::new(&near.shape, other);
            let truth = truth.truth(&self.pos12, is_mesh_first, self.prediction);
            truth.renumbered(|one, two| match is_mesh_first {
                true => (near.number(one), two),
                false => (one, near.number(two)),
            })
        };
        match self.near() {
            [Some(near1), Some(near2)] => Some(self.truth_near([&near1?, &near2?])),
            [Some(near), None] => Some(convex(near?, shape2, true)),
            [None, Some(near)] => Some(convex(near?, shape1, false)),
            [None, None] => None,
        }
    }

    /// True if the surfaces of two meshes meet; `None` for other shapes.
    fn meets(&self) -> Option<bool> {
        let [near1, near2] = self.near();
        let near = near1?.zip(near2?);
        Some(near.is_some_and(|(near1, near2)| self.truth_near([&near1, &near2]).meets()))
    }

    /// For each mesh the triangles near the other shape, if there are any.
    fn near(&self) -> [Option<Option<Near>>; 2] {
        let poses = [self.pos12, self.pos12.inverse()];
        [0, 1].map(|side| {
            let mesh = self.shapes[side].as_trimesh()?;
            Some(Near::new(mesh, &self.shapes[1 - side], &poses[side], self.prediction))
        })
    }

    fn truth_near(&self, near: [&Near; 2]) -> Truth {
        let shapes = near.map(|near| &near.shape);
        let question = Question::new(&self.pos12, shapes.map(|shape| &**shape), self.prediction);
        let truth = Judge::new(shapes).truth(&question);
        truth.renumbered(|one, two| (near[0].number(one), near[1].number(two)))
    }
}

/// The triangles of a mesh near a shape, as a mesh of their own.
struct Near {
    shape: SharedShape,
    /// Indices of the triangles in the whole mesh.
    triangles: Vec<u32>,
}

impl Near {
    /// `pose` is that of the shape in the frame of the mesh. `None` without such triangles.
    fn new(mesh: &TriMesh, shape: &SharedShape, pose: &Pose, prediction: Real) -> Option<Self> {
        let bounds = shape.compute_aabb(pose).loosened(2.0 * prediction);
        let triangles: Vec<u32> = mesh.bvh().intersect_aabb(&bounds).collect();
        let corners =
            triangles.iter().flat_map(|&index| mesh.triangle(index).vertices().to_owned());
        let vertices: Vec<Vector> = corners.collect();
        let indices = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
        let shape = SharedShape::trimesh(vertices, indices.collect()).ok()?;
        Some(Self { shape, triangles })
    }

    fn number(&self, triangle: u32) -> u32 {
        self.triangles[triangle as usize]
    }
}
