//! Contacts of a mesh and a shape missed and added, and wrong distances, by brute force in f64.

use std::collections::{BTreeMap, BTreeSet};

use glamx::{DPose3, DVec3, Pose3};
use rapier3d::geometry::{ContactManifold, SharedShape, TypedShape};
use rapier3d::math::{Real, Vector};
use rapier3d::parry::shape::Shape;
use sbbk_core::truth::ConvexBody;

use crate::metrics::ErrorCount;

/// Distances this close to the prediction distance, as a share of it, may go either way.
const SET_BAND: f64 = 0.01;
/// A distance off by more than this share of the prediction distance is wrong.
const DISTANCE_BAND: f64 = 0.05;

/// A triangle of the mesh and a part of the shape, 0 if it has no parts.
pub(in crate::study) type Subshapes = (u32, u32);

/// Knows a mesh and a shape in f64.
pub(in crate::study) struct Judge {
    triangles: Vec<[DVec3; 3]>,
    parts: Vec<Part>,
}

/// A convex part of a shape.
struct Part {
    /// The shape in the frame of the part.
    pose: DPose3,
    body: ConvexBody,
    /// The corners of the box around it.
    bounds: [DVec3; 2],
}

/// The truth about one pose.
pub(in crate::study) struct Truth {
    /// Of all triangles and parts within the prediction distance and its band. `None`: they cross,
    /// how deep is not known.
    distances: BTreeMap<Subshapes, Option<f64>>,
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

    /// With the mesh at a pose in the frame of the shape.
    pub fn truth(&self, pose: &Pose3, prediction: Real) -> Truth {
        let prediction = f64::from(prediction);
        let reach = prediction * (1.0 + SET_BAND);
        let mut distances = BTreeMap::new();
        for (part_index, part) in (0..).zip(&self.parts) {
            let pose = part.pose * DPose3::from(*pose);
            for (triangle_index, triangle) in (0..).zip(&self.triangles) {
                let triangle = triangle.map(|corner| pose * corner);
                if part.is_beyond(&triangle, reach) {
                    continue;
                }
                let distance = part.body.distance(&triangle);
                if distance.is_none_or(|distance| distance <= reach) {
                    distances.insert((triangle_index, part_index), distance);
                }
            }
        }
        Truth { distances, prediction }
    }
}

impl Part {
    fn new(pose: &Pose3, shape: &dyn Shape) -> Self {
        let bounds = shape.compute_local_aabb();
        Self {
            pose: DPose3::from(*pose).inverse(),
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
    /// Judges the manifolds of an answer; `subshapes` tells the triangle and the part of each.
    pub fn judge(
        &self,
        manifolds: &[ContactManifold],
        subshapes: impl Fn(&ContactManifold) -> Subshapes,
    ) -> ErrorCount {
        let Self { distances, prediction } = self;
        let mut errors = ErrorCount { mesh_pairs: 1, sampled_from: 1, ..ErrorCount::default() };
        let mut reported = BTreeSet::new();
        for manifold in manifolds {
            let subshapes = subshapes(manifold);
            let distances_of_points = manifold.points.iter().map(|point| f64::from(point.dist));
            let Some(distance) = distances_of_points.reduce(f64::min).filter(|d| d <= prediction)
            else {
                continue;
            };
            errors.reported += 1;
            let is_repeated = !reported.insert(subshapes);
            match distances.get(&subshapes) {
                Some(truth) if !is_repeated => {
                    let is_wrong =
                        |truth: f64| (truth - distance).abs() > DISTANCE_BAND * prediction;
                    errors.wrong_depth += usize::from(truth.is_some_and(is_wrong));
                }
                _ => errors.phantom += 1,
            }
        }
        for (subshapes, distance) in distances {
            let is_within = |limit: f64| distance.is_none_or(|distance| distance <= limit);
            errors.true_pairs += usize::from(is_within(*prediction));
            let must = is_within(prediction * (1.0 - SET_BAND));
            errors.missed += usize::from(must && !reported.contains(subshapes));
        }
        errors
    }
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
