//! A triangle and a convex shape at a pose: Parry's contact routine, asked by its own name.

use glamx::{DVec3, Vec3};
use parry3d::math::{Pose, Real};
use parry3d::query::details::{
    NormalConstraints, contact_manifold_convex_ball, contact_manifold_cuboid_triangle,
    contact_manifold_pfm_pfm,
};
use parry3d::query::{ContactManifold, TrackedContact};
use parry3d::shape::{PolygonalFeatureMap, Triangle};
use sbbk_core::contact::convex::ConvexContact;
use sbbk_core::traverse::Placement;

use super::face::OverFace;
use super::features::Touching;
use super::half_space::half_space_manifold;
use super::pair::ConvexPair;
use super::parts::{Part, Parts};
use super::shape::{ConvexShape, Extent};
use crate::pair::pose::MeshPlace;

/// A part at the pose of a query: what is computed once for all triangles near it.
pub(crate) struct PlacedPart {
    /// Its number.
    pub(super) index: u32,
    pub(super) extent: Extent,
    /// The mesh in the frame of the part.
    pub(super) placement: Placement,
    /// The mesh in the frame of the part and the reverse, with the roundings of stock.
    to_part: Pose,
    to_mesh: Pose,
    /// If the part is a cuboid, the face that the mesh is over.
    over_face: Option<OverFace>,
}

impl PlacedPart {
    /// `mesh_centre` is that of the mesh, in its own frame.
    pub(super) fn new(
        index: u32,
        part: &Part<'_>,
        pair: &ConvexPair<'_>,
        extent: Extent,
        mesh_centre: Vec3,
    ) -> Self {
        let pose = pair.part_pose(part.pose);
        let [to_mesh, to_part] = pair.mesh_place.swap([pose, pose.inverse()]);
        let placement12 = match pair.parts {
            Parts::One(_) => pair.pose.placement12,
            Parts::Many(_) => Placement::new(&pose),
        };
        let over_face = match part.shape {
            ConvexShape::Cuboid(cuboid) => {
                let centre = to_part * mesh_centre;
                Some(OverFace::below(centre, cuboid, [&to_part, &to_mesh]))
            }
            _ => None,
        };
        Self {
            index,
            extent,
            placement: pair.mesh_place.mesh_in_other(&placement12),
            to_part,
            to_mesh,
            over_face,
        }
    }

    /// The corners of a triangle of the mesh in the frame of the part.
    #[inline(always)]
    pub(super) fn corners(&self, triangle: &Triangle) -> [DVec3; 3] {
        let at = |corner: Vec3| self.placement.to_frame1(corner, Vec3::ZERO);
        [at(triangle.a), at(triangle.b), at(triangle.c)]
    }

    /// How far a triangle and the part are apart along `axis`, which points from the part to the
    /// triangle in the frame of the part: at most their distance.
    pub(super) fn gap(&self, shape: ConvexShape<'_>, triangle: &Triangle, axis: Vec3) -> f64 {
        let axis = axis.as_dvec3();
        let at_mesh: DVec3 = self.placement.rotation.transpose() * axis;
        let lowest = triangle.vertices().iter().map(|x| at_mesh.dot(x.as_dvec3()));
        let lowest = lowest.fold(f64::INFINITY, f64::min) + axis.dot(self.placement.translation);
        (lowest - self.extent.reach(shape, axis)) / axis.length()
    }
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
    /// Brings the manifold of the triangle up to date: with `contact` if it is known, else as
    /// Parry's routine does.
    ///
    /// Nothing of the step before has a part in the answer: Parry's `try_update_contacts` keeps
    /// points while they drift, and its GJK begins with the last normal, which for cylinders, cones
    /// and round shapes was the cause of nearly all wrong depths. Only the data of points with the
    /// same feature ids is handed on.
    ///
    /// The points of the query before are in a buffer of ours meanwhile: Parry copies them into a
    /// new one.
    pub(super) fn refresh<M, C>(
        &self,
        contact: Option<&ConvexContact>,
        previous_points: &mut Vec<TrackedContact<C>>,
        manifold: &mut ContactManifold<M, C>,
    ) where
        M: Default,
        C: Default + Copy,
    {
        if let ConvexShape::Ball(_) = self.part.shape {
            // One point, whose data Parry keeps in place.
            return self.ask_parry(manifold);
        }
        std::mem::swap(&mut manifold.points, previous_points);
        manifold.points.clear();
        manifold.local_n1 = Vec3::ZERO;
        match (contact, self.part.shape) {
            (Some(contact), ConvexShape::Features { map, radius, .. }) => {
                let (mesh_place, PlacedPart { placement, to_mesh, to_part, .. }) =
                    (self.mesh_place, self.placed);
                let [pos12, _] = mesh_place.swap([to_mesh, to_part]);
                let bodies: [&dyn PolygonalFeatureMap; 2] = [self.triangle, map];
                let cones = [self.cone, self.part.cone];
                Touching::new(mesh_place, contact, placement, pos12, bodies, cones, radius)
                    .fill(manifold);
            }
            _ => self.ask_parry(manifold),
        }
        manifold.match_contacts(previous_points);
    }

    /// Parry's routine for the kind of shape, with the arguments that stock's calls end up with.
    /// Called by its own name: through the dispatcher both shapes are taken apart and put together
    /// again for each triangle, and its GJK asks a triangle for support points through a table. A
    /// tenth to a quarter of a query. Where triangles are over a face of a cuboid, its contacts
    /// without it.
    fn ask_parry<M, C>(&self, manifold: &mut ContactManifold<M, C>)
    where
        M: Default,
        C: Default + Copy,
    {
        let Self { placed, part, triangle, cone, mesh_place, prediction } = *self;
        let PlacedPart { to_part, to_mesh, over_face, .. } = placed;
        let is_mesh_second = mesh_place.is_second();
        match part.shape {
            ConvexShape::Ball(ball) => {
                contact_manifold_convex_ball(
                    to_mesh,
                    triangle,
                    ball,
                    cone,
                    part.cone,
                    prediction,
                    manifold,
                    is_mesh_second,
                );
            }
            ConvexShape::Cuboid(cuboid) => {
                let is_free = cone.is_none() && part.cone.is_none();
                let over_face = over_face.as_ref().filter(|_| is_free);
                let is_second = !is_mesh_second;
                if over_face
                    .is_some_and(|face| face.contacts(triangle, prediction, is_second, manifold))
                {
                    return;
                }
                contact_manifold_cuboid_triangle(
                    to_part, to_mesh, cuboid, triangle, part.cone, cone, prediction, manifold,
                    is_second,
                );
            }
            ConvexShape::HalfSpace(half_space) => {
                let is_second = !is_mesh_second;
                half_space_manifold(to_part, half_space, triangle, prediction, is_second, manifold);
            }
            ConvexShape::Features { map, radius, .. } if is_mesh_second => {
                contact_manifold_pfm_pfm(
                    to_part, map, radius, part.cone, triangle, 0.0, cone, prediction, manifold,
                );
            }
            ConvexShape::Features { map, radius, .. } => contact_manifold_pfm_pfm(
                to_mesh, triangle, 0.0, cone, map, radius, part.cone, prediction, manifold,
            ),
        }
    }

    /// Where GJK sees that two shapes do not touch, it leaves the direction as the manifold's
    /// normal. The same in the frame of the part, from the part to the triangle.
    pub(super) fn axis_of<M, C>(&self, manifold: &ContactManifold<M, C>) -> Option<Vec3> {
        let normal = manifold.local_n1;
        let is_gjks = matches!(self.part.shape, ConvexShape::Features { .. });
        (is_gjks && normal != Vec3::ZERO).then(|| match self.mesh_place {
            MeshPlace::Second => normal,
            MeshPlace::First => -(self.placed.placement.rotation * normal.as_dvec3()).as_vec3(),
        })
    }
}
