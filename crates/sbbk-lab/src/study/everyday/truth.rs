//! Who is right where stock and SBBK differ: by brute force in f64, over the triangles near by.

use rapier3d::geometry::{SharedShape, TriMesh, TriMeshFlags};
use rapier3d::math::{Pose, Real, Vector};
use rapier3d::parry::bounding_volume::BoundingVolume;

use crate::backend::Question;
use crate::metrics::{Judge, Truth};
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
    /// Their numbers in the whole mesh.
    triangles: Vec<u32>,
}

impl Pair<'_> {
    /// What is true of them; `None` if that cannot be said: with `FIX_INTERNAL_EDGES` contacts are
    /// not those of the triangles alone.
    pub fn truth(&self) -> Option<Truth> {
        let Self { shapes: [shape1, shape2], pos12, prediction } = self;
        let meshes = [shape1, shape2].map(|shape| shape.as_trimesh());
        let is_plain = |mesh: &TriMesh| !mesh.flags().contains(TriMeshFlags::FIX_INTERNAL_EDGES);
        if !meshes.iter().flatten().all(|mesh| is_plain(mesh)) {
            return None;
        }
        Some(match self.near() {
            [Some(near1), Some(near2)] => self.truth_near([&near1?, &near2?]),
            [Some(near), None] => {
                let near = near?;
                let truth = ConvexJudge::new(&near.shape, shape2).truth(pos12, true, *prediction);
                truth.renumbered(|triangle, part| (near.number(triangle), part))
            }
            [None, Some(near)] => {
                let near = near?;
                let truth = ConvexJudge::new(&near.shape, shape1).truth(pos12, false, *prediction);
                truth.renumbered(|part, triangle| (part, near.number(triangle)))
            }
            [None, None] => return None,
        })
    }

    /// Whether the surfaces of two meshes meet; `None` of a mesh and another shape.
    pub fn meets(&self) -> Option<bool> {
        let [near1, near2] = self.near();
        let near = near1?.zip(near2?);
        Some(near.is_some_and(|(near1, near2)| self.truth_near([&near1, &near2]).meets()))
    }

    /// Of each mesh the triangles near the other shape, if there are any.
    fn near(&self) -> [Option<Option<Near>>; 2] {
        let Self { shapes: [shape1, shape2], pos12, prediction } = self;
        let near = |of: &SharedShape, other: &SharedShape, pose: &Pose| {
            Some(Near::new(of.as_trimesh()?, other, pose, *prediction))
        };
        [near(shape1, shape2, pos12), near(shape2, shape1, &pos12.inverse())]
    }

    fn truth_near(&self, near: [&Near; 2]) -> Truth {
        let shapes = near.map(|near| &near.shape);
        let question = Question::new(&self.pos12, shapes.map(|shape| &**shape), self.prediction);
        let truth = Judge::new(shapes).truth(&question);
        truth.renumbered(|one, two| (near[0].number(one), near[1].number(two)))
    }
}

impl Near {
    /// `None` if there are no such triangles. `pose` is that of the shape in the mesh's frame.
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

    /// The number in the whole mesh of a triangle of these.
    fn number(&self, triangle: u32) -> u32 {
        self.triangles[triangle as usize]
    }
}
