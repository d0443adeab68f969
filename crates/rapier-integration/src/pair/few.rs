//! A mesh and a ball that touches only a few triangles at a time.
//!
//! There a query takes less than a microsecond, and to keep candidates costs more than it saves. So
//! every query walks Parry's hierarchy and calls Parry's routine, which for balls is exact at every
//! scale. Nothing is kept but the manifolds; stock also keeps those without points, and asks about
//! all triangles of a box that is wider than the ball's.

use std::ops::ControlFlow;

use parry3d::bounding_volume::BoundingVolume;
use parry3d::math::{Pose, Real};
use parry3d::partitioning::BvhNode;
use parry3d::query::details::{NormalConstraints, contact_manifold_convex_ball};
use parry3d::query::{ContactManifold, ContactManifoldsWorkspace};
use parry3d::shape::{Ball, Shape, TriMesh};
use sbbk_core::volumes::rounding::gamma;

use super::pose::MeshPlace;
use super::state::state_in;
use crate::mesh::Hierarchy;

/// Whether a ball touches about six triangles of a mesh at a time or fewer, by their mean size.
pub(crate) fn is_few(mesh: &TriMesh, ball: &Ball) -> bool {
    /// So many triangles for half of a ball's box. More: balls on finer meshes take up to 1.2 times
    /// as long; fewer: those on coarser ones do.
    const FEW: Real = 6.0;
    let size = mesh.bvh().root_aabb().half_extents().length_squared();
    let count = mesh.indices().len() as Real * ball.radius * ball.radius;
    size.is_finite() && count < FEW * size
}

/// Brings the manifolds of the pair up to date: those with a point, in stock order.
pub(crate) fn touch_few<M, C>(
    mesh: &Hierarchy<'_>,
    ball: &Ball,
    mesh_place: MeshPlace,
    pos12: &Pose,
    prediction: Real,
    manifolds: &mut Vec<ContactManifold<M, C>>,
    workspace: &mut Option<ContactManifoldsWorkspace>,
) where
    M: Default + Clone + Send + Sync + 'static,
    C: Default + Copy + Send + Sync + 'static,
{
    // Nothing is kept there, but Rapier must find a workspace.
    state_in::<M, C, (), ()>(workspace, manifolds);
    let is_second = mesh_place.is_second();
    // With stock's roundings: it turns the pose about on its way to the mesh and back.
    let ball_in_mesh = if is_second { pos12.inverse().inverse().inverse() } else { *pos12 };
    let aabb = ball.compute_aabb(&ball_in_mesh);
    // Some ten operations on these coordinates.
    let size = aabb.mins.abs().max(aabb.maxs.abs()).max_element();
    let reach = prediction.max(0.0) + gamma(16) * (size + prediction.max(0.0));
    let is_somewhere = reach >= 0.0 && aabb.mins.is_finite() && aabb.maxs.is_finite();
    if !is_somewhere {
        return manifolds.clear();
    }
    let near = BvhNode::leaf(aabb.loosened(reach), 0);
    let (mut blank, mut count) = (None, 0);
    let touch = |triangle: u32, manifold: &mut ContactManifold<M, C>| {
        let cone = mesh.mesh.triangle_normal_constraints(triangle);
        let cone = cone.as_ref().map(|cone| cone as &dyn NormalConstraints);
        let triangle = mesh.mesh.triangle(triangle);
        contact_manifold_convex_ball(
            &ball_in_mesh,
            &triangle,
            ball,
            cone,
            None,
            prediction,
            manifold,
            is_second,
        );
        manifold.points.iter().any(|point| point.dist <= prediction)
    };
    let _ = mesh.near_box(&near, |triangle| {
        let subshapes = mesh_place.swap([triangle, 0]);
        let is_same = |m: &ContactManifold<M, C>| [m.subshape1, m.subshape2] == subshapes;
        if let Some(place) = manifolds[count..].iter().position(is_same) {
            manifolds.swap(count, count + place);
            // A blank one, or one that has gone, stays behind.
            count += usize::from(touch(triangle, &mut manifolds[count]));
        } else {
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
        }
        ControlFlow::Continue(())
    });
    manifolds.truncate(count);
}
