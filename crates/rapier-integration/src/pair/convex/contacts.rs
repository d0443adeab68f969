//! From candidates to manifolds, by Parry's contact routine.

use glamx::{DVec3, Vec3};
use parry3d::math::{Pose, Real};
use parry3d::query::details::{
    NormalConstraints, contact_manifold_convex_ball, contact_manifold_cuboid_triangle,
    contact_manifold_pfm_pfm,
};
use parry3d::query::{ContactManifold, TrackedContact};
use parry3d::shape::{CompoundPseudoNormals, TriMesh, Triangle};
use sbbk_core::traverse::{Convex, Placement};

use super::face::OverFace;
use super::half_space::half_space_manifold;
use super::query::ConvexPair;
use super::shape::{ConvexShape, Kind};
use crate::mesh::PreparedMesh;
use crate::pair::candidates::OrderKey;
use crate::pair::coherence::KnownCandidate;
use crate::pair::previous::Previous;
use crate::pair::state::History;

/// Points that were kept go beyond so many times the sight. Less than twice: some that Parry's routines for
/// cuboids make anew, a little out of sight, would come and go. More: points that mean nothing live longer.
const FAR: f64 = 2.0;

/// A triangle of the mesh.
#[derive(Copy, Clone, Debug)]
pub(in crate::pair) struct NearTriangle {
    pub(super) key: OrderKey,
    pub(super) triangle: u32,
    /// Of the shape's frame, from the shape to the triangle: along it they were last seen apart. Zero if they were not.
    pub(super) axis: Vec3,
}

/// How far a query looks.
#[derive(Copy, Clone, Debug)]
pub(super) struct Limits {
    /// The distance up to which Parry's routine may make contacts.
    pub(super) sight: f64,
    /// What the pair has moved since the descent.
    pub(super) travel: f64,
}

/// One query, after its descent.
pub(super) struct Generator<'a> {
    mesh: &'a TriMesh,
    shape: ConvexShape<'a>,
    /// The cones that contact normals of the shape must be in.
    cone: Option<&'a CompoundPseudoNormals>,
    prepared: &'a PreparedMesh,
    /// Whether the mesh is shape 2.
    flipped: bool,
    /// The pose that stock passes on, bit for bit, and its inverse.
    parrys_poses: [Pose; 2],
    /// The mesh in the frame of the shape.
    placement: Placement,
    prediction: Real,
    /// If the shape is a cuboid, the face that the mesh is over.
    over_face: Option<OverFace<'a>>,
}

impl<'a> Generator<'a> {
    pub(super) fn new(
        pair: &ConvexPair<'a>,
        prepared: &'a PreparedMesh,
        placement: Placement,
    ) -> Self {
        let &ConvexPair { mesh, shape, cone, flipped, prediction, parrys_pose, .. } = pair;
        let parrys_poses = [parrys_pose, parrys_pose.inverse()];
        let over_face = match shape.kind {
            Kind::Cuboid(cuboid) => {
                let [pose, inverse] = &parrys_poses;
                let poses = if flipped { [pose, inverse] } else { [inverse, pose] };
                let ball = prepared.tree.bounding_ball();
                Some(OverFace::below(poses[0] * ball.centre, cuboid, poses))
            }
            _ => None,
        };
        Self {
            mesh,
            shape,
            cone,
            prepared,
            flipped,
            parrys_poses,
            placement,
            prediction,
            over_face,
        }
    }

    /// Replaces `manifolds` by those of the triangles that touch, in stock order. Manifolds of triangles that still do
    /// keep their data; none is left empty.
    ///
    /// Candidates out of sight are skipped, and so are those that still are apart along the axis along which they last were. Of
    /// a triangle that does not touch, Parry's routine often knows such an axis.
    ///
    /// A triangle that has a manifold is not skipped, and needs not be a candidate: what becomes of a manifold is for Parry
    /// to say, from the manifold and the pose. So nothing depends on what else is remembered.
    pub(super) fn update<M, C>(
        &self,
        candidates: &mut [KnownCandidate<NearTriangle>],
        limits: Limits,
        places: &mut Vec<(OrderKey, u32)>,
        history: &mut History<M, C, ()>,
        manifolds: &mut Vec<ContactManifold<M, C>>,
    ) where
        M: Default + Clone + Send + Sync + 'static,
        C: Default + Copy + Send + Sync + 'static,
    {
        history.begin(manifolds);
        let key = |triangles: [u32; 2]| {
            OrderKey::of_triangle(self.prepared, triangles[usize::from(self.flipped)])
        };
        let mut previous = Previous::new(manifolds, key, places);
        let mut unused = None;
        let reach = limits.sight + limits.travel;
        for known in candidates {
            self.update_before(known.candidate.key, limits, &mut previous, history, manifolds);
            let corners = self.mesh.triangle(known.candidate.triangle);
            if let Some(place) = previous.next_of(known.candidate.key) {
                self.update_kept(known, limits, history, &mut manifolds[place]);
                history.keep_at(place, (), manifolds);
                continue;
            }
            if known.clear > reach || limits.travel > 0.0 && self.is_apart(&corners, known, limits)
            {
                continue;
            }
            let mut manifold = self.manifold(known.candidate.triangle, unused.take(), history);
            let previous_points = &mut history.previous_points;
            self.refresh(&corners, known.candidate, previous_points, &mut manifold);
            if manifold.points.is_empty() {
                self.is_explained(&corners, known, &manifold, limits);
                history.retire_unless_first(&mut unused, manifold);
            } else {
                history.keep(manifold, (), manifolds);
            }
        }
        self.update_before(OrderKey::LAST, limits, &mut previous, history, manifolds);
        if let Some(unused) = unused {
            history.retire(unused);
        }
        previous.retire_rest(manifolds, history);
        history.end(manifolds);
    }

    /// Updates the manifolds that come before a candidate, which are of triangles that are none.
    fn update_before<M, C>(
        &self,
        wanted: OrderKey,
        limits: Limits,
        previous: &mut Previous<'_>,
        history: &mut History<M, C, ()>,
        manifolds: &mut [ContactManifold<M, C>],
    ) where
        M: Default + Clone + Send + Sync + 'static,
        C: Default + Copy + Send + Sync + 'static,
    {
        while let Some((key, place)) = previous.next_before(wanted) {
            let manifold = &mut manifolds[place];
            let triangle = [manifold.subshape1, manifold.subshape2][usize::from(self.flipped)];
            let is_triangle = (triangle as usize) < self.mesh.indices().len();
            if !is_triangle {
                history.retire(std::mem::take(manifold));
                continue;
            }
            let candidate = NearTriangle { key, triangle, axis: Vec3::ZERO };
            let mut known = KnownCandidate { candidate, clear: 0.0 };
            self.update_kept(&mut known, limits, history, manifold);
            history.keep_at(place, (), manifolds);
        }
    }

    /// Updates the manifold of a triangle. Parry keeps points however far they have moved away along the normal; here
    /// they go when all are far out of sight.
    fn update_kept<M, C>(
        &self,
        known: &mut KnownCandidate<NearTriangle>,
        limits: Limits,
        history: &mut History<M, C, ()>,
        manifold: &mut ContactManifold<M, C>,
    ) where
        M: Default + Clone + Send + Sync + 'static,
        C: Default + Copy + Send + Sync + 'static,
    {
        let corners = self.mesh.triangle(known.candidate.triangle);
        let previous_points = &mut history.previous_points;
        self.refresh(&corners, known.candidate, previous_points, manifold);
        if manifold.points.is_empty() && !self.is_explained(&corners, known, manifold, limits) {
            self.ask_afresh(&corners, known.candidate, previous_points, manifold);
        }
        if manifold.points.iter().all(|point| f64::from(point.dist) > FAR * limits.sight) {
            manifold.points.clear();
        }
    }

    /// A manifold with nothing in it, for a triangle that had none.
    fn manifold<M: Default, C: Default + Copy>(
        &self,
        triangle: u32,
        unused: Option<ContactManifold<M, C>>,
        history: &mut History<M, C, ()>,
    ) -> ContactManifold<M, C> {
        let mut manifold = unused.unwrap_or_else(|| history.manifold(0, 0));
        let subshapes = if self.flipped { [0, triangle] } else { [triangle, 0] };
        [manifold.subshape1, manifold.subshape2] = subshapes;
        manifold
    }

    /// Brings the manifold of a triangle up to date.
    ///
    /// As Parry does it, but the points of the query before are in a buffer of ours meanwhile: Parry copies them into a new
    /// one. For that, what most of its routines do first is done here.
    fn refresh<M, C>(
        &self,
        triangle: &Triangle,
        candidate: NearTriangle,
        previous_points: &mut Vec<TrackedContact<C>>,
        manifold: &mut ContactManifold<M, C>,
    ) where
        M: Default,
        C: Default + Copy,
    {
        match self.shape.kind {
            // One point, whose data Parry keeps in place.
            Kind::Ball(_) => return self.ask_parry(triangle, candidate, manifold),
            Kind::HalfSpace(_) => {}
            Kind::Cuboid(_) | Kind::Features(..) => {
                if try_update(manifold, &self.parrys_poses[0]) {
                    return;
                }
            }
        }
        std::mem::swap(&mut manifold.points, previous_points);
        manifold.points.clear();
        self.ask_parry(triangle, candidate, manifold);
        manifold.match_contacts(previous_points);
    }

    /// Whether a triangle without contact is apart along the axis that Parry's routine leaves, which is then kept.
    fn is_explained<M, C>(
        &self,
        corners: &Triangle,
        known: &mut KnownCandidate<NearTriangle>,
        manifold: &ContactManifold<M, C>,
        limits: Limits,
    ) -> bool {
        self.axis_of(manifold).is_some_and(|axis| {
            known.candidate.axis = axis;
            self.is_apart(corners, known, limits)
        })
    }

    /// Asks for the contact of a triangle as if nothing was known of it. Parry's GJK begins with the normal of the step
    /// before, and where the cores of two shapes just touch it depends on that whether it sees a contact.
    fn ask_afresh<M, C>(
        &self,
        triangle: &Triangle,
        candidate: NearTriangle,
        previous_points: &[TrackedContact<C>],
        manifold: &mut ContactManifold<M, C>,
    ) where
        M: Default,
        C: Default + Copy,
    {
        if matches!(self.shape.kind, Kind::Features(..)) {
            manifold.local_n1 = Vec3::ZERO;
            self.ask_parry(triangle, candidate, manifold);
            manifold.match_contacts(previous_points);
        }
    }

    /// Parry's routine for the kind of shape, with the arguments that stock's calls end up with. Called by its own name:
    /// through the dispatcher both shapes are taken apart and put together again for each triangle, and its GJK
    /// asks a triangle for support points through a table. A tenth to a quarter of a query.
    fn ask_parry<M, C>(
        &self,
        triangle: &Triangle,
        candidate: NearTriangle,
        manifold: &mut ContactManifold<M, C>,
    ) where
        M: Default,
        C: Default + Copy,
    {
        let mut fresh = None;
        let cone = self.prepared.normal_constraints(self.mesh, candidate.triangle, &mut fresh);
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

    /// Where GJK sees that two shapes do not touch, it leaves the direction as the manifold's normal.
    fn axis_of<M, C>(&self, manifold: &ContactManifold<M, C>) -> Option<Vec3> {
        let left = manifold.local_n1;
        if !matches!(self.shape.kind, Kind::Features(..)) || left == Vec3::ZERO {
            return None;
        }
        let axis = if self.flipped {
            left
        } else {
            -(self.placement.rotation * left.as_dvec3()).as_vec3()
        };
        Some(axis)
    }

    /// Whether a triangle is out of sight along its axis; what it can move until it is not is then raised to what that
    /// tells. Whatever the axis is, this holds.
    fn is_apart(
        &self,
        corners: &Triangle,
        known: &mut KnownCandidate<NearTriangle>,
        limits: Limits,
    ) -> bool {
        let axis = known.candidate.axis.as_dvec3();
        if axis == DVec3::ZERO {
            return false;
        }
        let at_mesh = self.placement.rotation.transpose() * axis;
        let lowest = corners.vertices().iter().map(|x| at_mesh.dot(x.as_dvec3()));
        let lowest = lowest.fold(f64::INFINITY, f64::min) + axis.dot(self.placement.translation);
        let gap = (lowest - self.shape.reach(axis)) / axis.length();
        if gap > limits.sight {
            known.clear = known.clear.max(gap + limits.travel);
        }
        gap > limits.sight
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
