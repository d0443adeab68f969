//! A triangle and a part: what their contact says, and how it becomes points of a manifold.

use glamx::{DVec3, Vec3};
use parry3d::math::{Pose, Real};
use parry3d::query::TrackedContact;
use parry3d::query::details::{NormalConstraints, NormalConstraintsPair};
use sbbk_core::contact::Feature;
use sbbk_core::contact::convex::ConvexContact;
use sbbk_core::surface::strays::seam;
use sbbk_core::surface::{area_vector, longest_side};
use sbbk_core::volumes::Sphere;

use super::contact::{NormalSource, PartContact, core_contact, core_support};
use super::pair::ConvexPair;
use super::parts::{Part, PlacedPart};
use super::points::{FACE, PointPair, contact_points, is_over, ray_length};
use super::shape::{ConvexShape, KeptHull};
use crate::pair::borders::is_past_border;
use crate::pair::query::ContactPoints;
use crate::pair::reduce::{ContactSummary, PatchPlan};
use crate::pair::tuning::{BORDER_DEPTH, HARDLY_BEHIND, SAME_SIDE};

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

/// Sine between the normals of a contact and its triangle below which the contact is no ghost.
/// Higher: bodies stumble. Lower: flat contacts search for strays in vain.
const UPRIGHT: f64 = 1.0e-3;

/// Sine of a corner's direction up to which the corner counts as level. Higher: ghosts stay;
/// lower: rounding of the normals of curved shapes counts.
const LEVEL: f64 = 2.0e-3;

/// Barycentric coordinate from which a point counts as within a triangle. Higher: rounding hides
/// walls from what stands at their feet. Lower: walls have contacts above them.
const OVER_SLACK: f64 = 1.0e-4;

impl TrianglePartPair<'_> {
    /// Returns the point of a contact in the frame of the mesh, and the distance up to which
    /// triangles touch that point. A contact with the normal of its triangle is no ghost and has
    /// `None`.
    pub(super) fn touched_place(&self, contact: &ConvexContact) -> Option<(Vec3, f64)> {
        let corners = self.corners.map(|corner| corner.as_dvec3());
        let [normal, _] = self.placed.directions(contact.normal);
        let is_upright = is_parallel(area_vector(&corners), normal);
        (!is_upright).then(|| (self.placed.in_mesh(contact.on_triangle), seam(&corners)))
    }

    /// Replaces `out` by the points of a contact.
    pub(super) fn write(&self, contact: &PartContact, out: &mut ContactPoints) {
        out.points.clear();
        out.poses = self.pair.mesh_place.swap([None, self.part.pose.copied()]);
        match self.part.shape {
            ConvexShape::Ball(ball) => {
                // The nearest triangle has the only point.
                if contact.source != NormalSource::Neighbour {
                    self.write_ball(ball.radius, &contact.contact, out);
                }
            }
            ConvexShape::HalfSpace(half_space) => {
                self.write_half_space(half_space, contact, out);
            }
            _ => self.write_features(contact, out),
        }
    }

    /// Writes the only point of a ball, from the contact of its centre.
    #[inline(always)]
    fn write_ball(&self, radius: Real, contact: &ConvexContact, out: &mut ContactPoints) {
        let Some(Normals { normals, are_turned, .. }) = self.constrained_normals(contact) else {
            return;
        };
        let Self { placed, pair: ConvexPair { mesh_place, .. }, .. } = self;
        let [from_triangle, to_triangle] = mesh_place.swap(normals);
        let (mut on_triangle, mut distance) = (contact.on_triangle, contact.distance);
        if are_turned {
            let direction = -from_triangle.as_dvec3().normalize();
            let Some(length) = ray_length(&placed.in_part(self.corners), direction) else {
                return;
            };
            (on_triangle, distance) = (direction * length, length);
        }
        let points = mesh_place.swap([placed.in_mesh(on_triangle), to_triangle * radius]);
        let [point1, point2] = points;
        let distance = (distance - f64::from(radius)) as Real;
        out.points.push(TrackedContact::new(point1, point2, *FACE, *FACE, distance));
        out.normals = normals;
    }

    /// Writes the points of a shape with features; none if normal cones reject the contact.
    fn write_features(&self, contact: &PartContact, out: &mut ContactPoints) {
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
        let corners = &placed.in_part(self.corners);
        let push = |point| {
            let PointPair { on_triangle, on_shape, distance, features } = point;
            // Drops points that another normal puts much deeper than the contact, by Parry's limit.
            if is_limited && distance < 5.0 * depth.min(0.0) {
                return;
            }
            let points = [placed.in_mesh(on_triangle), on_shape.as_vec3() + to_triangle * radius];
            let ([point1, point2], [fid1, fid2]) =
                (mesh_place.swap(points), mesh_place.swap(features));
            let distance = (distance - f64::from(radius)) as Real;
            out.points.push(TrackedContact::new(point1, point2, fid1, fid2, distance));
        };
        let radius = placed.extent.ball().radius;
        let PatchPlan { equal_depth, .. } = PatchPlan::of_convex(self.pair.pose.prediction, radius);
        contact_points(corners, *shape, contact, turned, equal_depth.into(), push);
        out.normals = normals;
    }

    /// Returns the summary of a contact for contact reduction, in the frame of the part; `None` if
    /// it has no points. `points` is memory.
    pub(super) fn summary(
        &self,
        contact: &PartContact,
        points: &mut ContactPoints,
    ) -> Option<ContactSummary> {
        let Normals { normals, has_cones, .. } = self.constrained_normals(&contact.contact)?;
        let [of_mesh, of_part] = self.pair.mesh_place.swap(normals);
        let normal = if self.placed.has_mesh_axes { -of_mesh } else { of_part };
        let ConvexContact { on_triangle, distance, .. } = contact.contact;
        let mut distance = (distance - f64::from(self.part.shape.radius())) as Real;
        if contact.source == NormalSource::Neighbour || has_cones {
            // Only the points are as deep as another normal makes them.
            self.write(contact, points);
            distance = points.points.iter().map(|point| point.dist).reduce(Real::min)?;
        }
        let part = if self.part.pose.is_some() { self.placed.index } else { 0 };
        let spread = if self.pair.half_space_by_vertices().is_some() { 0.0 } else { self.spread() };
        Some(ContactSummary { part, normal, point: on_triangle.as_vec3(), distance, spread })
    }

    /// Returns a distance from a point of the contact that no other point exceeds.
    fn spread(&self) -> Real {
        let side = longest_side(&self.corners.map(|corner| corner.as_dvec3()));
        (side as Real).min(2.0 * self.placed.extent.ball().radius)
    }

    /// Returns unit vectors from each shape to the other, in its frame, in the order of the pair.
    #[inline(always)]
    pub(super) fn normals(&self, contact: &ConvexContact) -> [Vec3; 2] {
        let [in_mesh, in_part] = self.placed.directions(contact.normal);
        self.pair.mesh_place.swap([in_mesh, -in_part]).map(|normal| normal.as_vec3())
    }

    /// Returns the normals, turned into the normal cones of triangle and part; `None` if these
    /// reject the contact.
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
        extends_beyond(&self.placed.in_part(self.corners), contact)
    }

    /// Returns the contact along the normal of the triangle, for another contact of the part.
    /// `None` if the bodies cross nowhere along that normal, or if the contact leads against the
    /// other one and is not [`HARDLY_BEHIND`].
    pub(super) fn face_contact_for(&self, other: &ConvexContact) -> Option<ConvexContact> {
        let corners = &self.placed.in_part(self.corners);
        let (face, feature) = (self.face_contact(corners)?, Feature::Face);
        let contact = PartContact { contact: face, feature, source: NormalSource::Neighbour };
        let mut is_crossing = false;
        contact_points(corners, self.part.shape, &contact, None, 0.0, |point| {
            is_crossing |= point.distance < 0.0;
        });
        let reach = |direction| self.placed.extent.height_along(self.part.shape, direction);
        let height = || reach(face.normal) + reach(-face.normal);
        let is_safe =
            || other.normal.dot(face.normal) >= 0.0 || -face.distance <= HARDLY_BEHIND * height();
        (is_crossing && is_safe()).then_some(face)
    }

    /// Returns the least deep contact that moves the part out of the wedge behind the planes of
    /// this triangle and another one. The way leads over the edge of the wedge, or along the normal
    /// of the other triangle. `None` unless each triangle is behind the other one, and the edge is
    /// sharp.
    pub(super) fn contact_of_wedge(
        &self,
        other: [Vec3; 3],
        hull: &KeptHull,
    ) -> Option<ConvexContact> {
        let Self { placed, part, corners, .. } = *self;
        let triangles @ [own, other] = [corners, other].map(|corners| placed.in_part(corners));
        let normals = [outward(&own, &other)?, outward(&other, &own)?];
        let within = within_edge(&placed.extent.ball(), normals, [own[0], other[0]])?;
        let is_parting = |contact: &ConvexContact| {
            contact.distance < 0.0 && !triangles.iter().any(|t| extends_beyond(t, contact))
        };
        let over_edge = core_contact(placed, &within, part.shape, hull, 0.0).filter(is_parting);
        let [_, normal] = normals;
        let on_shape = core_support(part.shape, hull, -normal)?;
        let distance = normal.dot(on_shape - other[0]);
        let on_triangle = on_shape - normal * distance;
        let along_normal = ConvexContact { distance, normal, on_triangle, on_shape };
        let is_over_edge = |over_edge: &ConvexContact| distance < over_edge.distance;
        over_edge.filter(is_over_edge).or(Some(along_normal))
    }

    /// Returns a contact at a border with the normal of the face, if the part is on one side of the
    /// plane of the triangle. True if the way along this normal leads past the border.
    pub(super) fn upright_at_border(
        &self,
        contact: &ConvexContact,
    ) -> Option<(ConvexContact, bool)> {
        let ConvexContact { distance, normal: own, on_shape, .. } = *contact;
        let face = self.face_contact(&self.placed.in_part(self.corners))?;
        let radius = self.radius();
        if radius - face.distance > BORDER_DEPTH * f64::from(self.pair.pose.prediction) {
            return None;
        }
        let normal = face.normal;
        let (to_border, cosine) = (distance - radius, normal.dot(own));
        // Measures the way between the nearest points along the normal of the face.
        let distance = radius + to_border * cosine.max(0.0);
        // Under the part: a part that rolls would seem to come down on a point ahead.
        let on_triangle = on_shape - distance * normal;
        let upright = ConvexContact { distance, normal, on_triangle, on_shape };
        Some((upright, is_past_border(to_border, cosine)))
    }

    /// Returns the rounding radius of the part.
    pub(super) fn radius(&self) -> f64 {
        f64::from(self.part.shape.radius())
    }

    /// Returns the contact of a wall with its own normal, if the part stands at its foot. `floor`
    /// is the contact of the triangle at the foot, with the corners `of_floor`. Once it has lifted
    /// the part, the part touches the wall.
    pub(super) fn wall_contact(
        &self,
        floor: &ConvexContact,
        of_floor: [Vec3; 3],
    ) -> Option<ConvexContact> {
        let corners = &self.placed.in_part(self.corners);
        let wall = self.face_contact(corners)?;
        let depth = f64::from(self.part.shape.radius()) - floor.distance;
        if depth <= 0.0 || wall.normal.dot(floor.normal) >= SAME_SIDE {
            return None;
        }
        // Each triangle is in front of the other one.
        let of_floor = &self.placed.in_part(of_floor);
        let is_upright = is_parallel(area_vector(of_floor), floor.normal);
        let middle = self.placed.extent.ball().centre.as_dvec3();
        let is_under = is_upright && floor.normal.dot(middle - of_floor[0]) > 0.0;
        if !is_under || !extends_beyond(corners, floor) || !extends_beyond(of_floor, &wall) {
            return None;
        }
        let lifted = wall.on_shape + depth * floor.normal;
        is_over(corners, lifted, OVER_SLACK).then_some(wall)
    }

    /// Returns the contact of the part with the plane of the triangle, on the side of the part's
    /// middle.
    fn face_contact(&self, corners @ [a, ..]: &[DVec3; 3]) -> Option<ConvexContact> {
        let Self { placed: PlacedPart { extent, .. }, part: Part { shape, .. }, .. } = *self;
        let normal = area_vector(corners).try_normalize()?;
        let middle = extent.ball().centre.as_dvec3();
        let normal = if normal.dot(middle - a) < 0.0 { -normal } else { normal };
        let reach = extent.height_along(*shape, -normal) - f64::from(shape.radius());
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

/// Returns true if a unit vector is along a line. False for a triangle without an area.
fn is_parallel(up: DVec3, normal: DVec3) -> bool {
    up.cross(normal).length_squared() < UPRIGHT * UPRIGHT * up.length_squared()
}

/// Returns true if a triangle extends beyond a contact along its normal.
fn extends_beyond(corners: &[DVec3; 3], contact: &ConvexContact) -> bool {
    let ConvexContact { on_triangle, normal, .. } = *contact;
    corners.iter().any(|corner| {
        let way = corner - on_triangle;
        normal.dot(way) > LEVEL * way.length()
    })
}

/// Returns the unit normal of a triangle by its winding. `None` unless another one is behind it.
fn outward(corners @ [a, ..]: &[DVec3; 3], other: &[DVec3; 3]) -> Option<DVec3> {
    let normal = area_vector(corners).try_normalize()?;
    let is_behind = |corner: &DVec3| normal.dot(corner - a) <= LEVEL * corner.distance(*a);
    other.iter().all(is_behind).then_some(normal)
}

/// Returns a triangle that halves a wedge and ends at its edge. It reaches beyond a ball. `points`
/// are on the sides with these normals. `None` if both push the [same way](SAME_SIDE).
fn within_edge(
    ball: &Sphere,
    normals @ [one, other]: [DVec3; 2],
    points: [DVec3; 2],
) -> Option<[DVec3; 3]> {
    /// Radii of the ball up to which the triangle reaches. Higher: less exact. Lower: shapes pass
    /// its ends.
    const WEDGE_REACH: f64 = 8.0;
    if one.dot(other) >= SAME_SIDE {
        return None;
    }
    let along = one.cross(other);
    let (centre, radius) = (ball.centre.as_dvec3(), f64::from(ball.radius));
    let heights = [0, 1].map(|i| normals[i].dot(points[i] - centre));
    // The point of the edge that is nearest to the centre.
    let to_edge = heights[0] * other.cross(along) + heights[1] * along.cross(one);
    let edge = centre + to_edge / along.length_squared();
    let [along, inward] = [along.try_normalize()?, -(one + other).try_normalize()?];
    let reach = WEDGE_REACH * radius;
    Some([edge - reach * along, edge + reach * along, edge + reach * inward])
}
