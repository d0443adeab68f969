//! A triangle and a convex shape at a pose, and the manifold of their contact.

use glamx::{DQuat, DVec3, Vec3};
use parry3d::math::{Pose, Real};
use parry3d::query::details::NormalConstraints;
use parry3d::query::{ContactManifold, TrackedContact};
use parry3d::shape::Triangle;
use sbbk_core::contact::convex::ConvexContact;
use sbbk_core::traverse::Placement;
use sbbk_core::volumes::Sphere;

use super::ball::{keep_one, ray_length};
use super::features::{Normals, Point, Touching};
use super::half_space::half_space_points;
use super::pair::ConvexPair;
use super::parts::Part;
use super::shape::{ConvexShape, Extent};
use super::touch::{Along, Touch};
use crate::pair::outline::Outline;
use crate::pair::pose::MeshPlace;

/// A part at the pose of a query: what is computed once for all triangles near it.
pub(crate) struct PlacedPart {
    /// Its number.
    pub(super) index: u32,
    pub(super) extent: Extent,
    /// The mesh in the frame of the part.
    pub(super) placement: Placement,
    /// The reverse.
    pub(super) inverse: Placement,
    /// Where the mesh has the centre of a ball, if its frame has the axes of the mesh: a ball has none
    /// of its own, and no triangle need be turned.
    centre: Option<DVec3>,
    /// The mesh in the frame of the part and the reverse, in f32.
    to_part: Pose,
    to_mesh: Pose,
}

impl PlacedPart {
    pub(super) fn new(index: u32, part: &Part<'_>, pair: &ConvexPair<'_>, extent: Extent) -> Self {
        let whole_in_mesh = pair.mesh_place.shape_in_mesh(&pair.pose.pos12);
        let to_mesh = part.pose.map_or(whole_in_mesh, |part| whole_in_mesh * *part);
        let to_part = to_mesh.inverse();
        let whole = pair.mesh_place.placements(pair.pose).map(|placement| *placement);
        // Not from the poses of the part: in f32 these are off by some 1e-7 of the way.
        let [placement, inverse] = part.pose.map_or(whole, |part| {
            let mesh_in_part = Placement::new(part).inverted().of(&whole[0]);
            [mesh_in_part, mesh_in_part.inverted()]
        });
        Self { index, extent, placement, inverse, centre: None, to_part, to_mesh }
    }

    /// The same part, which is a whole shape, where shape 2 of the pair is at `placement` in the frame
    /// of shape 1.
    pub(crate) fn moved(&self, mesh_place: MeshPlace, placement: &Placement) -> Self {
        let [inverse, placement] = mesh_place.swap([*placement, placement.inverted()]);
        let [to_mesh, to_part] = [&inverse, &placement].map(rounded);
        Self {
            index: self.index,
            extent: self.extent,
            placement,
            inverse,
            centre: None,
            to_part,
            to_mesh,
        }
    }

    /// The same in the axes of the mesh, if it is a ball: contacts then are, but for what is written
    /// to manifolds.
    pub(super) fn unturned(mut self, part: &Part<'_>) -> Self {
        if matches!(part.shape, ConvexShape::Ball(_)) {
            let is_somewhere = self.placement.is_finite();
            self.centre = Some(if is_somewhere { self.inverse.translation } else { DVec3::NAN });
        }
        self
    }

    /// The part in the frame of the mesh.
    pub(super) fn pose_in_mesh(&self) -> &Pose {
        &self.to_mesh
    }

    /// The corners of a triangle of the mesh in the frame of the part.
    #[inline(always)]
    pub(super) fn corners(&self, triangle: &Triangle) -> [DVec3; 3] {
        self.place([triangle.a, triangle.b, triangle.c])
    }

    /// Points of the mesh in the frame of the part.
    #[inline(always)]
    pub(super) fn place(&self, [a, b, c]: [Vec3; 3]) -> [DVec3; 3] {
        if let Some(centre) = self.centre {
            return [a, b, c].map(|point| point.as_dvec3() - centre);
        }
        let at = |point: Vec3| self.placement.to_frame1(point, Vec3::ZERO);
        [at(a), at(b), at(c)]
    }

    /// Whether a triangle is surely farther than `reach` from the part without its radius: the boxes
    /// of both are, along the axes of the part.
    #[inline(always)]
    pub(super) fn is_beyond(&self, [a, b, c]: &[DVec3; 3], reach: f64) -> bool {
        let (min, max, reach) = self.extent.widest(reach);
        let gap = (a.min(*b).min(*c) - max).max(min - a.max(*b).max(*c)).max(DVec3::ZERO);
        gap.length_squared() > reach * reach
    }

    /// A point of the part in the frame of the mesh.
    #[inline(always)]
    pub(super) fn at_mesh(&self, point: DVec3) -> Vec3 {
        if let Some(centre) = self.centre {
            return (centre + point).as_vec3();
        }
        (self.placement.inverse * (point - self.placement.translation)).as_vec3()
    }

    /// A unit vector of its frame in that of the mesh and in that of the part.
    #[inline(always)]
    fn directions(&self, normal: DVec3) -> [DVec3; 2] {
        if self.centre.is_some() {
            [normal, (self.placement.rotation * normal).normalize()]
        } else {
            [(self.placement.inverse * normal).normalize(), normal]
        }
    }

    /// How far a triangle and the part are apart along `axis`, which points from the part to the
    /// triangle in the frame of the part: at most their distance.
    pub(super) fn gap(&self, shape: ConvexShape<'_>, triangle: &Triangle, axis: Vec3) -> f64 {
        let axis = axis.as_dvec3();
        (self.lowest(triangle, axis) - self.extent.reach(shape, axis)) / axis.length()
    }

    /// The same of a ball in the frame of the part.
    pub(super) fn gap_of_ball(&self, ball: &Sphere, triangle: &Triangle, axis: Vec3) -> f64 {
        let axis = axis.as_dvec3();
        let centre = axis.dot(ball.centre.as_dvec3());
        (self.lowest(triangle, axis) - centre) / axis.length() - f64::from(ball.radius)
    }

    /// The least coordinate of a triangle along `axis`, in the frame of the part.
    fn lowest(&self, triangle: &Triangle, axis: DVec3) -> f64 {
        let at_mesh: DVec3 = self.placement.rotation.transpose() * axis;
        let lowest = triangle.vertices().iter().map(|x| at_mesh.dot(x.as_dvec3()));
        lowest.fold(f64::INFINITY, f64::min) + axis.dot(self.placement.translation)
    }
}

/// A placement as a pose, but for a turn by a quaternion that is not of unit length.
fn rounded(placement: &Placement) -> Pose {
    let turn = DQuat::from_mat3(&placement.rotation).normalize();
    Pose::from_parts(placement.translation.as_vec3(), turn.as_quat())
}

/// Which contacts do a triangle and a part have?
pub(super) struct Question<'a> {
    pub(super) placed: &'a PlacedPart,
    pub(super) part: &'a Part<'a>,
    pub(super) triangle: &'a Triangle,
    /// The cone that contact normals of the triangle must be in.
    pub(super) cone: Option<&'a dyn NormalConstraints>,
    pub(super) mesh_place: MeshPlace,
    pub(super) prediction: Real,
}

impl Question<'_> {
    /// Brings the manifold of the triangle up to date with its contact. Points with the feature ids of
    /// points of the query before keep their data.
    pub(super) fn refresh<M, C>(
        &self,
        touch: &Touch,
        previous_points: &mut Vec<TrackedContact<C>>,
        manifold: &mut ContactManifold<M, C>,
    ) where
        M: Default,
        C: Default + Copy,
    {
        if let ConvexShape::Ball(ball) = self.part.shape {
            // The nearest triangle has the nearest point, and its data stays in place.
            return match touch.along {
                Along::Other => manifold.points.clear(),
                Along::Own | Along::WayOut => {
                    self.touch_ball(ball.radius, &touch.contact, manifold)
                }
            };
        }
        std::mem::swap(&mut manifold.points, previous_points);
        manifold.points.clear();
        manifold.local_n1 = Vec3::ZERO;
        if let ConvexShape::HalfSpace(half_space) = self.part.shape {
            let Self { triangle, mesh_place, prediction, .. } = *self;
            let (corners, flipped) = (self.placed.corners(triangle), !mesh_place.is_second());
            half_space_points(half_space, triangle, &corners, prediction, flipped, manifold);
            [manifold.local_n1, manifold.local_n2] = self.normals(&touch.contact);
        } else {
            self.touch(touch, manifold);
        }
        manifold.match_contacts(previous_points);
    }

    /// Whether the triangle goes on beyond the contact of another one, along its normal.
    pub(super) fn is_beyond(&self, other: &ConvexContact) -> bool {
        /// The greatest sine of a corner that does not, as normals go that count as alike.
        const LEVEL: f64 = 2.0e-3;
        let ConvexContact { on_triangle, normal, .. } = *other;
        let corners = self.placed.corners(self.triangle).map(|corner| corner - on_triangle);
        corners.iter().any(|corner| normal.dot(*corner) > LEVEL * corner.length())
    }

    /// The contact along the normal of the triangle, on the side of the middle of the part: as if the
    /// triangle went on without end.
    pub(super) fn of_face(&self) -> Option<ConvexContact> {
        let Self { placed: PlacedPart { extent, .. }, part, .. } = *self;
        let [a, b, c] = self.placed.corners(self.triangle);
        let normal = (b - a).cross(c - a).try_normalize()?;
        let middle = extent.ball().centre.as_dvec3();
        let normal = if normal.dot(middle - a) < 0.0 { -normal } else { normal };
        let reach = extent.reach(part.shape, -normal) - f64::from(part.shape.radius());
        let distance = -normal.dot(a) - reach;
        let on_shape = match part.shape {
            ConvexShape::Features { map, .. } => {
                map.local_support_point(-normal.as_vec3()).as_dvec3()
            }
            _ => normal * -reach,
        };
        let on_triangle = on_shape - normal * distance;
        Some(ConvexContact { distance, normal, on_triangle, on_shape })
    }

    /// Whether a contact along another normal than its own has points at which the bodies cross.
    pub(super) fn is_crossing(&self, contact: &ConvexContact) -> bool {
        let (corners, shape) = (&self.placed.corners(self.triangle), self.part.shape);
        let mut is_crossing = false;
        Touching { corners, shape, contact, along: Along::Other }
            .points(None, |point| is_crossing |= point.distance < 0.0);
        is_crossing
    }

    /// In the frame of the part; `None` where the cones reject the contact.
    pub(super) fn outline(&self, touch: &Touch) -> Option<Outline> {
        let Touch { contact, along, .. } = touch;
        let (pos12, cones) = self.pair();
        let Normals { normals, .. } = Normals::new(pos12, self.normals(contact), cones)?;
        let [of_mesh, of_part] = self.mesh_place.swap(normals);
        let normal = if self.placed.centre.is_some() { -of_mesh } else { of_part };
        Some(Outline {
            part: if self.part.pose.is_some() { self.placed.index } else { 0 },
            normal,
            point: contact.on_triangle.as_vec3(),
            distance: (contact.distance - f64::from(self.part.shape.radius())) as Real,
            has_cones: *along == Along::Other || cones.iter().any(Option::is_some),
        })
    }

    /// Unit vectors from each body to the other, in its frame and in the order of the pair.
    #[inline(always)]
    fn normals(&self, contact: &ConvexContact) -> [Vec3; 2] {
        let [at_mesh, at_part] = self.placed.directions(contact.normal);
        self.mesh_place.swap([at_mesh, -at_part]).map(|normal| normal.as_vec3())
    }

    /// The pose of body 2 in the frame of body 1, and the cones of both.
    fn pair(&self) -> (&Pose, [Option<&dyn NormalConstraints>; 2]) {
        let PlacedPart { to_mesh, to_part, .. } = self.placed;
        let [pos12, _] = self.mesh_place.swap([to_mesh, to_part]);
        (pos12, self.mesh_place.swap([self.cone, self.part.cone]))
    }

    /// Fills an empty manifold with the contact of the triangle and a shape with features; leaves it
    /// empty where the cones reject the contact.
    fn touch<M, C: Default + Copy>(
        &self,
        &Touch { ref contact, along, .. }: &Touch,
        manifold: &mut ContactManifold<M, C>,
    ) {
        let Self { placed, part, triangle, mesh_place, .. } = *self;
        let (shape, radius) = (part.shape, part.shape.radius());
        let (pos12, cones) = self.pair();
        let Some(Normals { normals, are_turned }) =
            Normals::new(pos12, self.normals(contact), cones)
        else {
            return;
        };
        let [_, to_triangle] = mesh_place.swap(normals);
        let turned = are_turned.then(|| -to_triangle.as_dvec3().normalize());
        let depth = contact.distance;
        let has_cones = cones.iter().any(Option::is_some);
        let is_limited = along == Along::Other || has_cones && depth < 0.0;
        let corners = &placed.corners(triangle);
        Touching { corners, shape, contact, along }.points(turned, |point| {
            let Point { on_triangle, on_shape, distance, features } = point;
            // As Parry: points that a turned normal puts much deeper than the bodies are.
            if is_limited && distance < 5.0 * depth.min(0.0) {
                return;
            }
            let points = [placed.at_mesh(on_triangle), on_shape.as_vec3() + to_triangle * radius];
            let ([point1, point2], [fid1, fid2]) =
                (mesh_place.swap(points), mesh_place.swap(features));
            let distance = (distance - f64::from(radius)) as Real;
            manifold.points.push(TrackedContact::new(point1, point2, fid1, fid2, distance));
        });
        [manifold.local_n1, manifold.local_n2] = normals;
    }

    /// Brings the one point of a ball up to date; `contact` is that of its centre.
    #[inline(always)]
    pub(super) fn touch_ball<M, C: Default + Copy>(
        &self,
        radius: Real,
        contact: &ConvexContact,
        manifold: &mut ContactManifold<M, C>,
    ) {
        let Self { placed, triangle, mesh_place, .. } = *self;
        let (pos12, cones) = self.pair();
        let Some(Normals { normals, are_turned }) =
            Normals::new(pos12, self.normals(contact), cones)
        else {
            return manifold.points.clear();
        };
        let [from_triangle, to_triangle] = mesh_place.swap(normals);
        let (mut on_triangle, mut distance) = (contact.on_triangle, contact.distance);
        if are_turned {
            let direction = -from_triangle.as_dvec3().normalize();
            let Some(length) = ray_length(&placed.corners(triangle), direction) else {
                return manifold.points.clear();
            };
            (on_triangle, distance) = (direction * length, length);
        }
        let points = mesh_place.swap([placed.at_mesh(on_triangle), to_triangle * radius]);
        keep_one(points, (distance - f64::from(radius)) as Real, manifold);
        [manifold.local_n1, manifold.local_n2] = normals;
    }
}
