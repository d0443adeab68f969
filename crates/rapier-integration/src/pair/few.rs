//! A mesh and a ball that touches only a few triangles at a time.
//!
//! There a query takes less than a microsecond, and to keep candidates costs more than it saves. So
//! every query walks Parry's hierarchy and calls Parry's routine, which for balls is exact at every
//! scale. Nothing is kept but the manifolds; stock also keeps those without points, and asks about
//! all triangles of a box that is wider than the ball's.

use parry3d::bounding_volume::BoundingVolume;
use parry3d::math::{Pose, Real, Vector};
use parry3d::partitioning::BvhNode;
use parry3d::query::details::{NormalConstraints, contact_manifold_convex_ball};
use parry3d::query::{ContactManifold, ContactManifoldsWorkspace};
use parry3d::shape::{Ball, Shape, TriMesh, TriMeshFlags};
use sbbk_core::contact::Feature;
use sbbk_core::contact::convex::feature_at;
use sbbk_core::volumes::rounding::gamma;

use super::pose::MeshPlace;
use super::seams::Touched;
use super::state::state_in;

/// Whether a ball is within a prediction distance of about six triangles of a mesh or fewer, by their mean
/// size.
pub(crate) fn is_few(mesh: &TriMesh, ball: &Ball, prediction: Real) -> bool {
    /// So many triangles for half of a ball's box. More: balls on finer meshes take up to 1.2 times
    /// as long; fewer: those on coarser ones do.
    const FEW: Real = 6.0;
    let size = mesh.bvh().root_aabb().half_extents().length_squared();
    let reach = ball.radius + prediction.max(0.0);
    let count = mesh.indices().len() as Real * reach * reach;
    size.is_finite() && count < FEW * size
}

/// A mesh and such a ball.
#[derive(Copy, Clone)]
pub(crate) struct FewPair<'a> {
    pub(crate) mesh: &'a TriMesh,
    pub(crate) ball: &'a Ball,
    pub(crate) mesh_place: MeshPlace,
    /// Whether contacts are those of the surface of the mesh.
    pub(crate) has_surfaces: bool,
}

impl FewPair<'_> {
    /// Brings the manifolds of the pair up to date: those with a point, in stock order.
    pub(crate) fn answer<M, C>(
        &self,
        pos12: &Pose,
        prediction: Real,
        manifolds: &mut Vec<ContactManifold<M, C>>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) where
        M: Default + Clone + Send + Sync + 'static,
        C: Default + Copy + Send + Sync + 'static,
    {
        // Nothing is kept in a workspace, but where there are or were manifolds Rapier must find one.
        let is_new = workspace.is_none() && manifolds.is_empty();
        if !is_new {
            state_in::<M, C, (), ()>(workspace, manifolds);
        }
        self.touch(pos12, prediction, manifolds);
        if is_new && !manifolds.is_empty() {
            let found = std::mem::take(manifolds);
            state_in::<M, C, (), ()>(workspace, manifolds);
            *manifolds = found;
        }
    }

    fn touch<M, C>(
        &self,
        pos12: &Pose,
        prediction: Real,
        manifolds: &mut Vec<ContactManifold<M, C>>,
    ) where
        M: Default,
        C: Default + Copy,
    {
        let Self { mesh, ball, mesh_place, .. } = *self;
        let is_second = mesh_place.is_second();
        // Bit for bit as in stock, which inverts the pose two more times.
        let ball_in_mesh = if is_second { pos12.inverse().inverse().inverse() } else { *pos12 };
        let aabb = ball.compute_aabb(&ball_in_mesh);
        // Some ten operations on these coordinates.
        let size = aabb.mins.abs().max(aabb.maxs.abs()).max_element();
        let reach = prediction.max(0.0) + gamma(16) * (size + prediction.max(0.0));
        let is_somewhere = reach >= 0.0 && aabb.mins.is_finite() && aabb.maxs.is_finite();
        if !is_somewhere {
            return manifolds.clear();
        }
        let touch = |index: u32, manifold: &mut ContactManifold<M, C>| {
            let cone = mesh.triangle_normal_constraints(index);
            let cone = cone.as_ref().map(|cone| cone as &dyn NormalConstraints);
            contact_manifold_convex_ball(
                &ball_in_mesh,
                &mesh.triangle(index),
                ball,
                cone,
                None,
                prediction,
                manifold,
                is_second,
            );
            manifold.points.iter().any(|point| point.dist <= prediction)
        };
        let (mut blank, mut count) = (None, 0);
        let visit = |triangle: u32| {
            let subshapes = mesh_place.swap([triangle, 0]);
            let is_same = |m: &ContactManifold<M, C>| [m.subshape1, m.subshape2] == subshapes;
            if let Some(place) = manifolds[count..].iter().position(is_same) {
                manifolds.swap(count, count + place);
                // One that has gone stays behind.
                count += usize::from(touch(triangle, &mut manifolds[count]));
                return;
            }
            let mut manifold = blank.take().unwrap_or_else(ContactManifold::default);
            [manifold.subshape1, manifold.subshape2] = subshapes;
            if touch(triangle, &mut manifold) {
                manifolds.push(manifold);
                let last = manifolds.len() - 1;
                manifolds.swap(count, last);
                count += 1;
            } else {
                manifold.points.clear();
                blank = Some(manifold);
            }
        };
        let near = BvhNode::leaf(aabb.loosened(reach), 0);
        mesh.bvh().leaves(|node| node.intersects(&near)).for_each(visit);
        manifolds.truncate(count);
        // As `ConvexQuery::turn`.
        let others = TriMeshFlags::FIX_INTERNAL_EDGES | TriMeshFlags::DEFORMABLE;
        if count > 1 && self.has_surfaces && !mesh.flags().intersects(others) {
            self.leave_out_seams(manifolds);
        }
    }

    /// Leaves out contacts that are none of the surface, see [`seams`](super::seams).
    fn leave_out_seams<M, C>(&self, manifolds: &mut Vec<ContactManifold<M, C>>) {
        /// What Parry may round away, as a share of the coordinates.
        const ROUNDED: Real = 1.0e-6;
        let Self { mesh, ball, mesh_place, .. } = *self;
        let touched = |manifold: &ContactManifold<M, C>| {
            let [triangle, _] = mesh_place.swap([manifold.subshape1, manifold.subshape2]);
            let corners = mesh.indices()[triangle as usize];
            Touched { corners: corners.map(|vertex| mesh.vertices()[vertex as usize]) }
        };
        let is_at_seam = |all: &[ContactManifold<M, C>], manifold: &ContactManifold<M, C>| {
            let point = &manifold.points[0];
            let [on_triangle, _] = mesh_place.swap([point.local_p1, point.local_p2]);
            let slack = ROUNDED * (on_triangle.abs().max_element() + ball.radius);
            let is_nearer =
                |other: &&ContactManifold<M, C>| other.points[0].dist < point.dist - slack;
            let mut nearer = all.iter().filter(is_nearer).peekable();
            if nearer.peek().is_none() {
                return false;
            }
            let own = touched(manifold);
            let [normal, _] = mesh_place.swap([manifold.local_n1, manifold.local_n2]);
            let corners = own.corners.map(|corner| corner.as_dvec3());
            let feature = feature_at(&corners, on_triangle.as_dvec3(), normal.as_dvec3());
            feature != Feature::Face && nearer.any(|other| touched(other).has(&own, feature))
        };
        for i in 0..manifolds.len() {
            if is_at_seam(manifolds, &manifolds[i]) {
                // It stays until all are seen: others may be told by it.
                manifolds[i].local_n1 = Vector::ZERO;
            }
        }
        manifolds.retain(|manifold| manifold.local_n1 != Vector::ZERO);
    }
}
