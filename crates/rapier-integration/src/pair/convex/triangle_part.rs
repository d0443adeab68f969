//! A triangle and a part: what their contact says, and how it becomes points of a manifold.

use glamx::{DVec3, Vec3};
use parry3d::math::{Pose, Real};
use parry3d::query::details::{NormalConstraints, NormalConstraintsPair};
use parry3d::query::{ContactManifold, TrackedContact};
use parry3d::shape::{HalfSpace, PackedFeatureId};
use sbbk_core::contact::Feature;
use sbbk_core::contact::convex::ConvexContact;

use super::contact::{NormalSource, PartContact};
use super::pair::ConvexPair;
use super::parts::Part;
use super::placed::PlacedPart;
use super::points::{PointPair, contact_points, ray_length, set_only_point};
use super::shape::ConvexShape;
use crate::pair::outline::Outline;

/// A triangle and a part at the pose of a query.
pub(super) struct TrianglePartPair<'a> {
    pub(super) pair: &'a ConvexPair<'a>,
    pub(super) placed: &'a PlacedPart,
    pub(super) part: &'a Part<'a>,
    /// In the frame of the mesh.
    pub(super) corners: [Vec3; 3],
    /// Normal cone of the triangle.
    pub(super) cone: Option<&'a dyn NormalConstraints>,
}

/// Normals of a contact as the manifold has them.
struct Normals {
    /// Unit vectors from each shape to the other, in its frame, in the order of the pair.
    normals: [Vec3; 2],
    /// True if normal cones have turned the normals.
    are_turned: bool,
    has_cones: bool,
}

impl TrianglePartPair<'_> {
    /// Writes the points of a contact. Earlier points with the same features keep their data.
    pub(super) fn write<M, C: Default + Copy>(
        &self,
        contact: &PartContact,
        previous_points: &mut Vec<TrackedContact<C>>,
        manifold: &mut ContactManifold<M, C>,
    ) {
        if let ConvexShape::Ball(ball) = self.part.shape {
            // The nearest triangle has the only point.
            return match contact.source {
                NormalSource::Neighbour => manifold.points.clear(),
                _ => self.write_ball(ball.radius, &contact.contact, manifold),
            };
        }
        std::mem::swap(&mut manifold.points, previous_points);
        manifold.points.clear();
        manifold.local_n1 = Vec3::ZERO;
        if let ConvexShape::HalfSpace(half_space) = self.part.shape {
            self.write_half_space(half_space, &contact.contact, manifold);
        } else {
            self.write_features(contact, manifold);
        }
        manifold.match_contacts(previous_points);
    }

    /// Writes the only point of a ball, from the contact of its centre.
    #[inline(always)]
    pub(super) fn write_ball<M, C: Default + Copy>(
        &self,
        radius: Real,
        contact: &ConvexContact,
        manifold: &mut ContactManifold<M, C>,
    ) {
        let Some(Normals { normals, are_turned, .. }) = self.constrained_normals(contact) else {
            return manifold.points.clear();
        };
        let Self { placed, pair: ConvexPair { mesh_place, .. }, .. } = self;
        let [from_triangle, to_triangle] = mesh_place.swap(normals);
        let (mut on_triangle, mut distance) = (contact.on_triangle, contact.distance);
        if are_turned {
            let direction = -from_triangle.as_dvec3().normalize();
            let Some(length) = ray_length(&placed.to_part(self.corners), direction) else {
                return manifold.points.clear();
            };
            (on_triangle, distance) = (direction * length, length);
        }
        let points = mesh_place.swap([placed.to_mesh(on_triangle), to_triangle * radius]);
        set_only_point(points, (distance - f64::from(radius)) as Real, manifold);
        [manifold.local_n1, manifold.local_n2] = normals;
    }

    /// Writes the corners of the triangle that are within the prediction distance of a half-space.
    fn write_half_space<M, C: Default + Copy>(
        &self,
        half_space: &HalfSpace,
        contact: &ConvexContact,
        manifold: &mut ContactManifold<M, C>,
    ) {
        let ConvexPair { mesh_place, pose, .. } = self.pair;
        let normal = half_space.normal.as_dvec3();
        let corners = self.placed.to_part(self.corners);
        for (index, (corner, vertex)) in (0..).zip(corners.iter().zip(self.corners)) {
            let distance = corner.dot(normal);
            if distance <= f64::from(pose.prediction) {
                manifold.points.push(TrackedContact::flipped(
                    (corner - normal * distance).as_vec3(),
                    vertex,
                    PackedFeatureId::face(0),
                    PackedFeatureId::vertex(index),
                    distance as Real,
                    !mesh_place.is_second(),
                ));
            }
        }
        [manifold.local_n1, manifold.local_n2] = self.normals(contact);
    }

    /// Writes the points of a shape with features; none if normal cones reject the contact.
    fn write_features<M, C: Default + Copy>(
        &self,
        contact: &PartContact,
        manifold: &mut ContactManifold<M, C>,
    ) {
        let Some(Normals { normals, are_turned, has_cones }) =
            self.constrained_normals(&contact.contact)
        else {
            return;
        };
        let Self { placed, part: Part { shape, .. }, pair: ConvexPair { mesh_place, .. }, .. } =
            self;
        let [_, to_triangle] = mesh_place.swap(normals);
        let turned = are_turned.then(|| -to_triangle.as_dvec3().normalize());
        let (radius, depth) = (shape.radius(), contact.contact.distance);
        let is_limited = contact.source == NormalSource::Neighbour || has_cones && depth < 0.0;
        let corners = &placed.to_part(self.corners);
        contact_points(corners, *shape, contact, turned, |point| {
            let PointPair { on_triangle, on_shape, distance, features } = point;
            // Drops points that another normal puts much deeper than the contact, by Parry's limit.
            if is_limited && distance < 5.0 * depth.min(0.0) {
                return;
            }
            let points = [placed.to_mesh(on_triangle), on_shape.as_vec3() + to_triangle * radius];
            let ([point1, point2], [fid1, fid2]) =
                (mesh_place.swap(points), mesh_place.swap(features));
            let distance = (distance - f64::from(radius)) as Real;
            manifold.points.push(TrackedContact::new(point1, point2, fid1, fid2, distance));
        });
        [manifold.local_n1, manifold.local_n2] = normals;
    }

    /// Returns the summary of a contact for contact reduction, in the frame of the part; `None` if
    /// normal cones reject the contact.
    pub(super) fn outline(&self, contact: &PartContact) -> Option<Outline> {
        let Normals { normals, has_cones, .. } = self.constrained_normals(&contact.contact)?;
        let [of_mesh, of_part] = self.pair.mesh_place.swap(normals);
        let normal = if self.placed.centre_in_mesh.is_some() { -of_mesh } else { of_part };
        let PartContact { contact: ConvexContact { on_triangle, distance, .. }, source, .. } =
            contact;
        Some(Outline {
            part: if self.part.pose.is_some() { self.placed.index } else { 0 },
            normal,
            point: on_triangle.as_vec3(),
            distance: (distance - f64::from(self.part.shape.radius())) as Real,
            has_cones: *source == NormalSource::Neighbour || has_cones,
        })
    }

    /// Returns unit vectors from each shape to the other, in its frame, in the order of the pair.
    #[inline(always)]
    fn normals(&self, contact: &ConvexContact) -> [Vec3; 2] {
        let [in_mesh, in_part] = self.placed.directions(contact.normal);
        self.pair.mesh_place.swap([in_mesh, -in_part]).map(|normal| normal.as_vec3())
    }

    /// Returns the normals, turned into the normal cones of triangle and part; `None` if these reject
    /// the contact.
    #[inline(always)]
    fn constrained_normals(&self, contact: &ConvexContact) -> Option<Normals> {
        let free = self.normals(contact);
        let cones = self.pair.mesh_place.swap([self.cone, self.part.cone]);
        if cones.iter().all(Option::is_none) {
            return Some(Normals { normals: free, are_turned: false, has_cones: false });
        }
        let [mut normal1, mut normal2] = free;
        let cones = (cones[0], cones[1]);
        if !cones.project_local_normals(&self.pos12(), &mut normal1, &mut normal2) {
            return None;
        }
        // Parry computes one normal from the other: a normal without a cone differs by rounding.
        let are_turned =
            cones.0.is_some() && normal1 != free[0] || cones.1.is_some() && normal2 != free[1];
        let normals = if are_turned { [normal1, normal2] } else { free };
        Some(Normals { normals, are_turned, has_cones: true })
    }

    /// Returns the pose of body 2 in the frame of body 1, with the part as one of them.
    fn pos12(&self) -> Pose {
        let ConvexPair { pose, mesh_place, .. } = self.pair;
        let Some(part) = self.part.pose else { return pose.pos12 };
        let to_mesh = mesh_place.shape_in_mesh(&pose.pos12) * *part;
        if mesh_place.is_second() { to_mesh.inverse() } else { to_mesh }
    }

    /// Returns true if the triangle extends beyond a contact along its normal.
    pub(super) fn extends_beyond(&self, contact: &ConvexContact) -> bool {
        /// Sine of a corner's direction up to which the corner counts as level. Higher: ghosts stay;
        /// lower: rounding of the normals of curved shapes counts.
        const LEVEL: f64 = 2.0e-3;
        let ConvexContact { on_triangle, normal, .. } = *contact;
        let corners = self.placed.to_part(self.corners).map(|corner| corner - on_triangle);
        corners.iter().any(|corner| normal.dot(*corner) > LEVEL * corner.length())
    }

    /// Returns the contact along the normal of the triangle, if the bodies cross along it somewhere.
    pub(super) fn crossing_face_contact(&self) -> Option<ConvexContact> {
        let corners = &self.placed.to_part(self.corners);
        let (contact, feature) = (self.face_contact(corners)?, Feature::Face);
        let contact = PartContact { contact, feature, source: NormalSource::Neighbour };
        let mut is_crossing = false;
        contact_points(corners, self.part.shape, &contact, None, |point| {
            is_crossing |= point.distance < 0.0;
        });
        is_crossing.then_some(contact.contact)
    }

    /// Returns the contact of the part with the plane of the triangle, on the side of the part's middle.
    fn face_contact(&self, [a, b, c]: &[DVec3; 3]) -> Option<ConvexContact> {
        let Self { placed: PlacedPart { extent, .. }, part: Part { shape, .. }, .. } = *self;
        let normal = (b - a).cross(c - a).try_normalize()?;
        let middle = extent.ball().centre.as_dvec3();
        let normal = if normal.dot(middle - a) < 0.0 { -normal } else { normal };
        let reach = extent.reach(*shape, -normal) - f64::from(shape.radius());
        let distance = -normal.dot(*a) - reach;
        let on_shape = match shape {
            ConvexShape::Features { map, .. } => {
                map.local_support_point(-normal.as_vec3()).as_dvec3()
            }
            _ => normal * -reach,
        };
        let on_triangle = on_shape - normal * distance;
        Some(ConvexContact { distance, normal, on_triangle, on_shape })
    }
}
