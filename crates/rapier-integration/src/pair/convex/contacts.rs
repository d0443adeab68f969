//! From candidates to manifolds, by Parry's contact routine.

use glamx::Vec3;
use parry3d::math::{Pose, Real};
use parry3d::query::ContactManifold;
use parry3d::shape::{CompoundPseudoNormals, TriMesh};
use sbbk_core::traverse::Placement;

use super::face::OverFace;
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
    pub(super) mesh: &'a TriMesh,
    pub(super) shape: ConvexShape<'a>,
    /// The cones that contact normals of the shape must be in.
    pub(super) cone: Option<&'a CompoundPseudoNormals>,
    pub(super) prepared: &'a PreparedMesh,
    /// Whether the mesh is shape 2.
    pub(super) flipped: bool,
    /// The pose that stock passes on, bit for bit, and its inverse.
    pub(super) parrys_poses: [Pose; 2],
    /// The mesh in the frame of the shape.
    pub(super) placement: Placement,
    pub(super) prediction: Real,
    /// If the shape is a cuboid, the face that the mesh is over.
    pub(super) over_face: Option<OverFace<'a>>,
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
    /// A triangle that has a manifold is not skipped, and need not be a candidate: what becomes of a manifold is for Parry
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
            if known.clear > reach
                || limits.travel > 0.0 && self.gap(&corners, known, limits) > limits.sight
            {
                continue;
            }
            let mut manifold = self.manifold(known.candidate.triangle, unused.take(), history);
            let previous_points = &mut history.previous_points;
            self.refresh(&corners, known, limits, None, previous_points, &mut manifold);
            if manifold.points.is_empty() {
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
        let (hint, previous_points) = (Some(manifold.local_n1), &mut history.previous_points);
        self.refresh(&corners, known, limits, hint, previous_points, manifold);
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
}
