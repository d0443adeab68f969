//! Who is right where stock and SBBK differ: by brute force in f64, over the triangles near by.

use rapier3d::geometry::{ContactManifold, SharedShape, TriMesh, TriMeshFlags};
use rapier3d::math::{Pose, Real, Vector};
use rapier3d::parry::bounding_volume::BoundingVolume;

use crate::backend::{Answer, Question};
use crate::metrics::{ErrorCount, Judge, Truth};
use crate::study::convex::errors::Judge as ConvexJudge;

/// A pair of shapes, at least one of them a mesh.
pub(super) struct Pair<'a> {
    pub shapes: [&'a SharedShape; 2],
    pub pos12: Pose,
    pub prediction: Real,
}

/// The triangles of a mesh that come near a shape, as a mesh of their own.
struct Near {
    shape: SharedShape,
    /// Their numbers in the whole mesh, ascending.
    triangles: Vec<u32>,
}

impl Pair<'_> {
    /// The errors of some answers; `None` if it cannot be judged: with `FIX_INTERNAL_EDGES`
    /// contacts are not those of the triangles alone.
    pub fn judge(&self, answers: [&[ContactManifold]; 2]) -> Option<[ErrorCount; 2]> {
        let Self { shapes: [shape1, shape2], pos12, prediction } = self;
        let meshes = [shape1, shape2].map(|shape| shape.as_trimesh());
        let is_plain = |mesh: &TriMesh| !mesh.flags().contains(TriMeshFlags::FIX_INTERNAL_EDGES);
        if !meshes.iter().flatten().all(|mesh| is_plain(mesh)) {
            return None;
        }
        Some(match self.near() {
            [Some(Some(near1)), Some(Some(near2))] => {
                let (question, truth) = self.truth([&near1, &near2]);
                answers.map(|manifolds| {
                    let mut answer = Answer::new(question, manifolds);
                    for pair in &mut answer.reported {
                        pair.triangle1 = near1.number(pair.triangle1);
                        pair.triangle2 = near2.number(pair.triangle2);
                    }
                    truth.judge(&answer)
                })
            }
            [Some(Some(near)), None] => {
                let judge = ConvexJudge::new(&near.shape, shape2);
                let truth = judge.truth(pos12, true, *prediction);
                answers.map(|manifolds| truth.judge(manifolds, |index| near.number(index)).pairs)
            }
            [None, Some(Some(near))] => {
                let judge = ConvexJudge::new(&near.shape, shape1);
                let truth = judge.truth(pos12, false, *prediction);
                answers.map(|manifolds| truth.judge(manifolds, |index| near.number(index)).pairs)
            }
            _ => return None,
        })
    }

    /// Whether the surfaces of two meshes meet; `None` of a mesh and another shape.
    pub fn meets(&self) -> Option<bool> {
        let [near1, near2] = self.near();
        Some(match (near1?, near2?) {
            (Some(near1), Some(near2)) => {
                let (_, truth) = self.truth([&near1, &near2]);
                truth.contacts().any(|pair| pair.distance <= 0.0)
            }
            _ => false,
        })
    }

    /// Of each mesh the triangles near the other shape, if there are any.
    fn near(&self) -> [Option<Option<Near>>; 2] {
        let Self { shapes: [shape1, shape2], pos12, prediction } = self;
        let near = |of: &SharedShape, other: &SharedShape, pose: &Pose| {
            Some(Near::new(of.as_trimesh()?, other, pose, *prediction))
        };
        [near(shape1, shape2, pos12), near(shape2, shape1, &pos12.inverse())]
    }

    fn truth(&self, near: [&Near; 2]) -> (Question, Truth) {
        let shapes = near.map(|near| &near.shape);
        let question = Question::new(&self.pos12, shapes.map(|shape| &**shape), self.prediction);
        (question, Judge::new(shapes).truth(&question))
    }
}

impl Near {
    /// `None` if there are no such triangles. `pose` is that of the shape in the mesh's frame.
    fn new(mesh: &TriMesh, shape: &SharedShape, pose: &Pose, prediction: Real) -> Option<Self> {
        let bounds = shape.compute_aabb(pose).loosened(2.0 * prediction);
        let mut triangles: Vec<u32> = mesh.bvh().intersect_aabb(&bounds).collect();
        triangles.sort_unstable();
        let corners =
            triangles.iter().flat_map(|&index| mesh.triangle(index).vertices().to_owned());
        let vertices: Vec<Vector> = corners.collect();
        let indices = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
        let shape = SharedShape::trimesh(vertices, indices.collect()).ok()?;
        Some(Self { shape, triangles })
    }

    /// The number here of a triangle of the whole mesh; of one that is not near, none.
    fn number(&self, triangle: u32) -> u32 {
        self.triangles.binary_search(&triangle).map_or(u32::MAX, |index| index as u32)
    }
}
