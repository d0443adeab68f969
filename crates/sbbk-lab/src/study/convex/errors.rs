//! Contacts of a mesh and a convex shape or compound by brute force in f64.

use crate::prelude::*;
use glamx::DAffine3;
use sbbk_core::truth::ConvexBody;
use sbbk_testkit::truth::{affine, convex_body};

use crate::metrics::TrueContact;

/// Largest distance of contacts, in prediction distances.
const REACH: f64 = 1.01;
/// Tolerated errors of a distance, as shares of the prediction distance and of the depth.
const BANDS: [f64; 2] = [0.01, 1.0e-5];

/// A mesh and a shape in f64.
pub(in crate::study) struct Judge {
    triangles: Vec<[DVec3; 3]>,
    parts: Vec<Part>,
}

/// A convex part of a shape.
struct Part {
    /// The shape in the frame of the part.
    pose: DAffine3,
    body: ConvexBody,
    /// Corners of the box around the part.
    bounds: [DVec3; 2],
}

impl Judge {
    pub fn new(mesh: &SharedShape, shape: &SharedShape) -> Self {
        let triangles = mesh.as_trimesh().into_iter().flat_map(|mesh| mesh.triangles());
        let corners = |corner: [_; 3]| corner.map(|corner: Vector| corner.as_dvec3());
        let parts = match shape.as_compound() {
            Some(compound) => {
                compound.shapes().iter().map(|(pose, part)| Part::new(pose, part)).collect()
            }
            None => vec![Part::new(&Pose3::IDENTITY, shape)],
        };
        Self { triangles: triangles.map(|t| corners([t.a, t.b, t.c])).collect(), parts }
    }

    /// Computes the truth for a pose of the second shape in the frame of the first. A shape without
    /// parts is part 0. Normals belong to the part.
    pub fn truth(&self, pos12: &Pose3, is_mesh_first: bool, prediction: Real) -> Truth {
        let reach = f64::from(prediction) * REACH;
        let pose = if is_mesh_first { affine(pos12).inverse() } else { affine(pos12) };
        let mut contacts = Vec::new();
        for (part_index, part) in (0..).zip(&self.parts) {
            let pose = part.pose * pose;
            for (triangle_index, triangle) in (0..).zip(&self.triangles) {
                let triangle = triangle.map(|corner| pose.transform_point3(corner));
                if part.is_beyond(&triangle, reach) {
                    continue;
                }
                let found = part.body.contact(&triangle);
                if found.distance <= reach {
                    let normals = found.normals.into_iter().map(|normal| -normal).collect();
                    let truth = TrueContact { distance: found.distance, normals };
                    let [one, two] = [triangle_index, part_index];
                    contacts.push((if is_mesh_first { (one, two) } else { (two, one) }, truth));
                }
            }
        }
        Truth::new(contacts, prediction, BANDS, usize::from(is_mesh_first))
    }
}

impl Part {
    fn new(pose: &Pose3, shape: &SharedShape) -> Self {
        let bounds = shape.compute_local_aabb();
        Self {
            pose: affine(pose).inverse(),
            body: convex_body(shape),
            bounds: [bounds.mins, bounds.maxs].map(|corner| corner.as_dvec3()),
        }
    }

    /// True if the boxes are farther apart than `reach`.
    fn is_beyond(&self, [a, b, c]: &[DVec3; 3], reach: f64) -> bool {
        let [min, max] = self.bounds;
        (a.min(*b).min(*c) - reach).cmpgt(max).any() || (a.max(*b).max(*c) + reach).cmplt(min).any()
    }
}
