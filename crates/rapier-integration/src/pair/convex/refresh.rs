//! One triangle: from its manifold of the step before to that of this one, by Parry's contact routine.

use glamx::{DVec3, Vec3};
use parry3d::math::Pose;
use parry3d::query::details::{
    NormalConstraints, contact_manifold_convex_ball, contact_manifold_cuboid_triangle,
    contact_manifold_pfm_pfm,
};
use parry3d::query::{ContactManifold, TrackedContact};
use parry3d::shape::Triangle;
use sbbk_core::traverse::Convex;

use super::contacts::{Generator, Limits, NearTriangle};
use super::half_space::half_space_manifold;
use super::shape::Kind;
use crate::pair::coherence::KnownCandidate;

impl Generator<'_> {
    /// Brings the manifold of a triangle up to date, as Parry does it but for two things.
    ///
    /// The points of the query before are in a buffer of ours meanwhile: Parry copies them into a new one. For that, what most of
    /// its routines do first is done here.
    ///
    /// Parry's GJK begins with the normal of the step before; here it begins as if nothing was known. For cylinders, cones and
    /// round shapes that normal was the cause of nearly all wrong depths and most contacts lost or added, and spares
    /// 2 % of the time. Where the cores just touch, GJK sees that or not, as it begins: a triangle that had a contact
    /// and has none, but is not seen to be apart either, is asked about again with the normal that it had, `hint`. (To ask again
    /// about those that had none invents contacts.)
    pub(super) fn refresh<M, C>(
        &self,
        corners: &Triangle,
        known: &mut KnownCandidate<NearTriangle>,
        limits: Limits,
        hint: Option<Vec3>,
        previous_points: &mut Vec<TrackedContact<C>>,
        manifold: &mut ContactManifold<M, C>,
    ) where
        M: Default,
        C: Default + Copy,
    {
        let triangle = known.candidate.triangle;
        let (keeps_points, is_search) = match self.shape.kind {
            // One point, whose data Parry keeps in place.
            Kind::Ball(_) => return self.ask_parry(corners, triangle, manifold),
            Kind::HalfSpace(_) => (false, false),
            Kind::Cuboid(_) => (true, false),
            Kind::Features(..) => (true, true),
        };
        if keeps_points && try_update(manifold, &self.parrys_poses[0]) {
            return;
        }
        std::mem::swap(&mut manifold.points, previous_points);
        manifold.points.clear();
        if is_search {
            manifold.local_n1 = Vec3::ZERO;
        }
        self.ask_parry(corners, triangle, manifold);
        if is_search && manifold.points.is_empty() {
            known.candidate.axis = self.axis_of(manifold);
            let is_apart = self.gap(corners, known, limits) > limits.sight;
            if let Some(hint) = hint.filter(|_| !is_apart) {
                manifold.local_n1 = hint;
                self.ask_parry(corners, triangle, manifold);
            }
        }
        manifold.match_contacts(previous_points);
    }

    /// Parry's routine for the kind of shape, with the arguments that stock's calls end up with. Called by its own name:
    /// through the dispatcher both shapes are taken apart and put together again for each triangle, and its GJK
    /// asks a triangle for support points through a table. A tenth to a quarter of a query. Where triangles are over a face of a
    /// cuboid, its contacts without it.
    fn ask_parry<M, C>(&self, triangle: &Triangle, index: u32, manifold: &mut ContactManifold<M, C>)
    where
        M: Default,
        C: Default + Copy,
    {
        let mut fresh = None;
        let cone = self.prepared.normal_constraints(self.mesh, index, &mut fresh);
        let cone = cone.map(|cone| cone as &dyn NormalConstraints);
        let cone_of_shape = self.cone.map(|cone| cone as &dyn NormalConstraints);
        let (prediction, [pose, inverse]) = (self.prediction, &self.parrys_poses);
        // The shape in the frame of the triangle, and the reverse.
        let [to_triangle, to_shape] = if self.flipped { [inverse, pose] } else { [pose, inverse] };
        match self.shape.kind {
            Kind::Ball(ball) => {
                let flipped = self.flipped;
                contact_manifold_convex_ball(
                    to_triangle,
                    triangle,
                    ball,
                    cone,
                    cone_of_shape,
                    prediction,
                    manifold,
                    flipped,
                );
            }
            Kind::Cuboid(cuboid) => {
                let flipped = !self.flipped;
                let is_free = cone.is_none() && cone_of_shape.is_none();
                let over_face = self.over_face.filter(|_| is_free);
                if over_face
                    .is_some_and(|face| face.contacts(triangle, prediction, flipped, manifold))
                {
                    return;
                }
                contact_manifold_cuboid_triangle(
                    to_shape,
                    to_triangle,
                    cuboid,
                    triangle,
                    cone_of_shape,
                    cone,
                    prediction,
                    manifold,
                    flipped,
                );
            }
            Kind::HalfSpace(half_space) => {
                let flipped = !self.flipped;
                half_space_manifold(to_shape, half_space, triangle, prediction, flipped, manifold);
            }
            Kind::Features(map, radius) if self.flipped => contact_manifold_pfm_pfm(
                pose,
                map,
                radius,
                cone_of_shape,
                triangle,
                0.0,
                cone,
                prediction,
                manifold,
            ),
            Kind::Features(map, radius) => contact_manifold_pfm_pfm(
                pose,
                triangle,
                0.0,
                cone,
                map,
                radius,
                cone_of_shape,
                prediction,
                manifold,
            ),
        }
    }

    /// Where GJK sees that two shapes do not touch, it leaves the direction as the manifold's normal: in the frame of the
    /// shape, from the shape to the triangle.
    fn axis_of<M, C>(&self, manifold: &ContactManifold<M, C>) -> Vec3 {
        let normal = manifold.local_n1;
        if self.flipped { normal } else { -(self.placement.rotation * normal.as_dvec3()).as_vec3() }
    }

    /// How far a triangle and the shape are apart along the axis of the candidate, at most their distance; minus infinity if it
    /// has none. If it is out of sight, what it can move until it is not is raised to what that tells.
    pub(super) fn gap(
        &self,
        corners: &Triangle,
        known: &mut KnownCandidate<NearTriangle>,
        limits: Limits,
    ) -> f64 {
        let axis = known.candidate.axis.as_dvec3();
        if axis == DVec3::ZERO {
            return f64::NEG_INFINITY;
        }
        let at_mesh = self.placement.rotation.transpose() * axis;
        let lowest = corners.vertices().iter().map(|x| at_mesh.dot(x.as_dvec3()));
        let lowest = lowest.fold(f64::INFINITY, f64::min) + axis.dot(self.placement.translation);
        let gap = (lowest - self.shape.reach(axis)) / axis.length();
        if gap > limits.sight {
            known.clear = known.clear.max(gap + limits.travel);
        }
        gap
    }
}

/// Parry's test whether the points may stay; their distances then are those of the new pose.
///
/// A 16-byte load takes `local_n2` and the number after it, `subshape1`. Few triangles make that subnormal as a float,
/// and though nobody wants it, each of the four products with it stalls the processor: 40 % of a query about a floor.
fn try_update<M, C: Default + Copy>(manifold: &mut ContactManifold<M, C>, pose: &Pose) -> bool {
    let subshape1 = std::mem::take(&mut manifold.subshape1);
    let is_updated = manifold.try_update_contacts(pose);
    manifold.subshape1 = subshape1;
    is_updated
}
