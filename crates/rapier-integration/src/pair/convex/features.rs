//! The contact of a triangle and a shape with polygonal features, exact at every scale.
//!
//! Distance, normal and closest points are those of [`sbbk_core::contact::convex`]; the other
//! points come from Parry's clip of the features that support them.

use glamx::DVec3;
use parry3d::math::{Pose, Real, Vector};
use parry3d::query::details::{NormalConstraints, NormalConstraintsPair};
use parry3d::query::{ContactManifold, TrackedContact};
use parry3d::shape::{
    PackedFeatureId, PolygonalFeature, PolygonalFeatureMap, Segment, Shape, Triangle, TypedShape,
};
use sbbk_core::contact::convex::{
    ConeSupport, ConvexContact, CuboidSupport, CylinderSupport, SegmentSupport, TriangleSupport,
    convex_contact,
};
use sbbk_core::traverse::Placement;
use sbbk_core::volumes::rounding::gamma;

use crate::pair::pose::MeshPlace;

/// The contact of a triangle with a shape without its radius, in the shape's frame.
pub(super) fn core_contact(
    triangle: &[DVec3; 3],
    shape: &dyn Shape,
    margin: f64,
) -> Option<ConvexContact> {
    let segment = |segment: &Segment| {
        let core = SegmentSupport([segment.a, segment.b].map(|end| end.as_dvec3()));
        convex_contact(triangle, &core, margin)
    };
    let of_triangle = |other: &Triangle| {
        let core = TriangleSupport(other.vertices().map(|corner| corner.as_dvec3()));
        convex_contact(triangle, &core, margin)
    };
    let cylinder = |half_height: Real, radius: Real| {
        let [half_height, radius] = [half_height, radius].map(f64::from);
        convex_contact(triangle, &CylinderSupport { half_height, radius }, margin)
    };
    let cone = |half_height: Real, radius: Real| {
        let [half_height, radius] = [half_height, radius].map(f64::from);
        convex_contact(triangle, &ConeSupport { half_height, radius }, margin)
    };
    let hull = |points: &[Vector]| {
        let support = |direction: DVec3| {
            let (mut farthest, mut most) = (Vector::ZERO, f64::NEG_INFINITY);
            for &point in points {
                let along = point.as_dvec3().dot(direction);
                if along > most {
                    (farthest, most) = (point, along);
                }
            }
            farthest.as_dvec3()
        };
        convex_contact(triangle, &support, margin)
    };
    match shape.as_typed_shape() {
        TypedShape::Segment(shape) => segment(shape),
        TypedShape::Capsule(shape) => segment(&shape.segment),
        TypedShape::Triangle(shape) => of_triangle(shape),
        TypedShape::RoundTriangle(shape) => of_triangle(&shape.inner_shape),
        TypedShape::Cylinder(shape) => cylinder(shape.half_height, shape.radius),
        TypedShape::RoundCylinder(shape) => {
            cylinder(shape.inner_shape.half_height, shape.inner_shape.radius)
        }
        TypedShape::Cone(shape) => cone(shape.half_height, shape.radius),
        TypedShape::RoundCone(shape) => {
            cone(shape.inner_shape.half_height, shape.inner_shape.radius)
        }
        TypedShape::RoundCuboid(shape) => {
            let half_lengths = shape.inner_shape.half_extents.as_dvec3();
            convex_contact(triangle, &CuboidSupport(half_lengths), margin)
        }
        TypedShape::ConvexPolyhedron(shape) => hull(shape.points()),
        TypedShape::RoundConvexPolyhedron(shape) => hull(shape.inner_shape.points()),
        _ => None,
    }
}

/// Two bodies that touch, in the order of the pair.
pub(super) struct Touching<'a> {
    /// The pose of body 2 in the frame of body 1.
    pub(super) pos12: &'a Pose,
    pub(super) bodies: [&'a dyn PolygonalFeatureMap; 2],
    pub(super) cones: [Option<&'a dyn NormalConstraints>; 2],
    /// Radii around both.
    pub(super) radii: [Real; 2],
    /// Unit vectors from each body to the other, in its frame; the closest points, radii not
    /// counted; and their distance.
    pub(super) normals: [Vector; 2],
    pub(super) points: [Vector; 2],
    pub(super) distance: Real,
}

impl<'a> Touching<'a> {
    /// A triangle of a mesh and a shape whose frame the mesh is in at `placement`.
    pub(super) fn new(
        mesh_place: MeshPlace,
        contact: &ConvexContact,
        placement: &Placement,
        pos12: &'a Pose,
        bodies: [&'a dyn PolygonalFeatureMap; 2],
        cones: [Option<&'a dyn NormalConstraints>; 2],
        radius: Real,
    ) -> Self {
        let at_mesh = placement.inverse * (contact.on_triangle - placement.translation);
        let normal = (placement.inverse * contact.normal).normalize();
        Self {
            pos12,
            bodies: mesh_place.swap(bodies),
            cones: mesh_place.swap(cones),
            radii: mesh_place.swap([0.0, radius]),
            normals: mesh_place.swap([normal, -contact.normal]).map(|normal| normal.as_vec3()),
            points: mesh_place.swap([at_mesh, contact.on_shape]).map(|point| point.as_vec3()),
            distance: contact.distance as Real,
        }
    }

    /// Fills an empty manifold; leaves it empty where the cones reject the contact.
    pub(super) fn fill<M, C: Default + Copy>(&self, manifold: &mut ContactManifold<M, C>) {
        let Self { pos12, bodies: [body1, body2], points: [point1, point2], distance, .. } = *self;
        let [mut normal1, mut normal2] = self.normals;
        let constraints = (self.cones[0], self.cones[1]);
        let has_cones = self.cones.iter().any(Option::is_some);
        if has_cones && !constraints.project_local_normals(pos12, &mut normal1, &mut normal2) {
            return;
        }
        let mut features = [PolygonalFeature::default(), PolygonalFeature::default()];
        body1.local_support_feature_toward(normal1, point1, &mut features[0]);
        body2.local_support_feature_toward(normal2, point2, &mut features[1]);
        let [feature1, feature2] = &features;
        let pos21 = &pos12.inverse();
        PolygonalFeature::contacts(
            pos12, pos21, normal1, normal2, feature1, feature2, manifold, false,
        );
        if normal1 == self.normals[0] {
            // No point of the bodies is nearer along the normal than the closest ones. Where a face
            // is seen edge on, Parry's clip makes some that are.
            let size = point1.abs().max_element() + point2.abs().max_element();
            let nearest = distance - gamma(64) * size;
            manifold.points.retain(|point| point.dist >= nearest);
            let unknown = PackedFeatureId::UNKNOWN;
            let closest = TrackedContact::new(point1, point2, unknown, unknown, distance);
            manifold.points.push(closest);
        }
        if has_cones {
            // As Parry: points that a constrained normal puts much deeper than the bodies are.
            manifold.points.retain(|point| {
                distance >= 0.0 || point.dist >= 0.0 || point.dist >= 5.0 * distance
            });
        }
        let [radius1, radius2] = self.radii;
        for point in &mut manifold.points {
            point.local_p1 += normal1 * radius1;
            point.local_p2 += normal2 * radius2;
            point.dist -= radius1 + radius2;
        }
        [manifold.local_n1, manifold.local_n2] = [normal1, normal2];
    }
}
