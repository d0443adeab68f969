//! Contacts of a mesh and a shape missed and added, and wrong distances and normals, by brute force
//! in f64.

use std::collections::{BTreeMap, BTreeSet};

use glamx::{DAffine3, DMat3, DPose3, DVec3, Pose3};
use rapier3d::geometry::{ContactManifold, SharedShape, TypedShape};
use rapier3d::math::{Real, Vector};
use rapier3d::parry::shape::Shape;
use sbbk_core::truth::{ConvexBody, ConvexTruth};

use crate::metrics::ErrorCount;
use crate::study::contacts::errors::{ContactErrors, NORMAL_BAND, distance};

/// Distances this close to the prediction distance, as a share of it, may go either way.
const SET_BAND: f64 = 0.01;
/// A distance off by more than this share of the prediction distance is wrong.
const DISTANCE_BAND: f64 = 0.01;
/// The same of depths, where that is more: as a share of the depth.
const DEPTH_BAND: f64 = 1.0e-5;

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
    /// The corners of the box around it.
    bounds: [DVec3; 2],
}

/// A triangle of the mesh and a part of the shape, 0 if it has no parts.
type Subshapes = (u32, u32);

/// The truth about one pose.
pub(in crate::study) struct Truth {
    /// Of all triangles and parts within the prediction distance and its band, in the frame of the
    /// part.
    contacts: BTreeMap<Subshapes, ConvexTruth>,
    is_mesh_first: bool,
    prediction: f64,
}

impl Judge {
    pub fn new(mesh: &SharedShape, shape: &SharedShape) -> Self {
        let triangles = mesh.as_trimesh().into_iter().flat_map(|mesh| mesh.triangles());
        let corners = |corner: [_; 3]| corner.map(|corner: Vector| corner.as_dvec3());
        let parts = match shape.as_compound() {
            Some(compound) => {
                compound.shapes().iter().map(|(pose, part)| Part::new(pose, &**part)).collect()
            }
            None => vec![Part::new(&Pose3::IDENTITY, &**shape)],
        };
        Self { triangles: triangles.map(|t| corners([t.a, t.b, t.c])).collect(), parts }
    }

    /// With the second of the two at a pose in the frame of the first.
    pub fn truth(&self, pos12: &Pose3, is_mesh_first: bool, prediction: Real) -> Truth {
        let prediction = f64::from(prediction);
        let reach = prediction * (1.0 + SET_BAND);
        let pose = if is_mesh_first { affine(pos12).inverse() } else { affine(pos12) };
        let mut contacts = BTreeMap::new();
        for (part_index, part) in (0..).zip(&self.parts) {
            let pose = part.pose * pose;
            for (triangle_index, triangle) in (0..).zip(&self.triangles) {
                let triangle = triangle.map(|corner| pose.transform_point3(corner));
                if part.is_beyond(&triangle, reach) {
                    continue;
                }
                let contact = part.body.contact(&triangle);
                if contact.distance <= reach {
                    contacts.insert((triangle_index, part_index), contact);
                }
            }
        }
        Truth { contacts, is_mesh_first, prediction }
    }
}

/// A pose as the map that it is: with a quaternion that is not quite of unit length it scales.
fn affine(pose: &Pose3) -> DAffine3 {
    let DPose3 { rotation, translation } = DPose3::from(*pose);
    let columns = DVec3::AXES.map(|axis| rotation * axis);
    DAffine3::from_mat3_translation(
        DMat3::from_cols(columns[0], columns[1], columns[2]),
        translation,
    )
}

impl Part {
    fn new(pose: &Pose3, shape: &dyn Shape) -> Self {
        let bounds = shape.compute_local_aabb();
        Self {
            pose: affine(pose).inverse(),
            body: body(shape),
            bounds: [bounds.mins, bounds.maxs].map(|corner| corner.as_dvec3()),
        }
    }

    /// Whether box and box are farther apart than `reach`.
    fn is_beyond(&self, [a, b, c]: &[DVec3; 3], reach: f64) -> bool {
        let [min, max] = self.bounds;
        (a.min(*b).min(*c) - reach).cmpgt(max).any() || (a.max(*b).max(*c) + reach).cmplt(min).any()
    }
}

impl Truth {
    /// Judges the manifolds of an answer; `number` tells that of a triangle of the mesh.
    pub fn judge(
        &self,
        manifolds: &[ContactManifold],
        number: impl Fn(u32) -> u32,
    ) -> ContactErrors {
        let Self { contacts, is_mesh_first, prediction } = self;
        let mut errors = ErrorCount { mesh_pairs: 1, sampled_from: 1, ..ErrorCount::default() };
        let mut reported = BTreeSet::new();
        let mut are_normals_wrong = Vec::new();
        for manifold in manifolds {
            let mut subshapes = [manifold.subshape1, manifold.subshape2];
            let mut normals = [manifold.local_n1, manifold.local_n2];
            if !is_mesh_first {
                subshapes.reverse();
                normals.reverse();
            }
            let subshapes = (number(subshapes[0]), subshapes[1]);
            let Some(distance) = distance(manifold).map(f64::from).filter(|d| d <= prediction)
            else {
                continue;
            };
            errors.reported += 1;
            let is_repeated = !reported.insert(subshapes);
            match contacts.get(&subshapes) {
                Some(truth) if !is_repeated => {
                    let depth = DEPTH_BAND * -truth.distance;
                    let band = depth.max(DISTANCE_BAND * prediction);
                    let is_wrong = (truth.distance - distance).abs() > band;
                    errors.wrong_depth += usize::from(is_wrong);
                    if !is_wrong && !truth.normals.is_empty() {
                        are_normals_wrong.push(is_off(-normals[1].as_dvec3(), &truth.normals));
                    }
                }
                _ => errors.phantom += 1,
            }
        }
        for (subshapes, ConvexTruth { distance, .. }) in contacts {
            errors.true_pairs += usize::from(distance <= prediction);
            let must = *distance <= prediction * (1.0 - SET_BAND);
            errors.missed += usize::from(must && !reported.contains(subshapes));
        }
        ContactErrors { pairs: errors, ..ContactErrors::default() }.with_normals(are_normals_wrong)
    }
}

/// Whether a normal is off each of the right ones. One that is zero is at no angle to anything.
fn is_off(normal: DVec3, right: &[DVec3]) -> bool {
    !right.iter().any(|right| normal.angle_between(*right).to_degrees() <= NORMAL_BAND)
}

/// A convex shape of Parry's as the reference knows it.
fn body(shape: &dyn Shape) -> ConvexBody {
    let hull = |points: &[Vector]| {
        ConvexBody::hull(points.iter().map(|point| point.as_dvec3()).collect::<Vec<_>>())
    };
    let cuboid = |half_lengths: Vector| {
        let sign = |corner: usize, axis: usize| if corner >> axis & 1 == 0 { -1.0 } else { 1.0 };
        let corner =
            |i| half_lengths.as_dvec3() * DVec3::from_array([0, 1, 2].map(|axis| sign(i, axis)));
        ConvexBody::hull((0..8).map(corner).collect::<Vec<_>>())
    };
    let cylinder =
        |half_height: Real, radius: Real| ConvexBody::cylinder(half_height.into(), radius.into());
    let cone =
        |half_height: Real, radius: Real| ConvexBody::cone(half_height.into(), radius.into());
    let (core, radius) = match shape.as_typed_shape() {
        TypedShape::Ball(ball) => (ConvexBody::hull([DVec3::ZERO]), ball.radius),
        TypedShape::Segment(segment) => (hull(&[segment.a, segment.b]), 0.0),
        TypedShape::Capsule(capsule) => {
            (hull(&[capsule.segment.a, capsule.segment.b]), capsule.radius)
        }
        TypedShape::Triangle(triangle) => (hull(triangle.vertices()), 0.0),
        TypedShape::RoundTriangle(round) => {
            (hull(round.inner_shape.vertices()), round.border_radius)
        }
        TypedShape::Cuboid(shape) => (cuboid(shape.half_extents), 0.0),
        TypedShape::RoundCuboid(round) => {
            (cuboid(round.inner_shape.half_extents), round.border_radius)
        }
        TypedShape::ConvexPolyhedron(shape) => (hull(shape.points()), 0.0),
        TypedShape::RoundConvexPolyhedron(round) => {
            (hull(round.inner_shape.points()), round.border_radius)
        }
        TypedShape::Cylinder(shape) => (cylinder(shape.half_height, shape.radius), 0.0),
        TypedShape::RoundCylinder(round) => {
            (cylinder(round.inner_shape.half_height, round.inner_shape.radius), round.border_radius)
        }
        TypedShape::Cone(shape) => (cone(shape.half_height, shape.radius), 0.0),
        TypedShape::RoundCone(round) => {
            (cone(round.inner_shape.half_height, round.inner_shape.radius), round.border_radius)
        }
        TypedShape::HalfSpace(shape) => (ConvexBody::half_space(shape.normal.as_dvec3()), 0.0),
        _ => unreachable!("no convex shape of the study"),
    };
    core.rounded(radius.into())
}
