//! The triangles of a mesh near a convex shape, by Parry's BVH of the mesh.

use std::cell::Cell;
use std::ops::ControlFlow;

use glamx::{DVec3, Vec3};
use parry3d::math::Real;
use parry3d::shape::HalfSpace;
use sbbk_core::traverse::{BoxTest, DescentCounts, Placement, TestedBox};
use sbbk_core::volumes::rounding::gamma;

use super::parts::PlacedPart;
use super::shape::{ConvexShape, Extent};
use crate::mesh::MeshView;

/// Calls `found` with all triangles within `margin` of a part, and a few others, in the order of
/// the BVH, until it returns `Break`.
pub(super) fn triangles_near(
    placed: &PlacedPart,
    shape: ConvexShape<'_>,
    mesh: &MeshView<'_>,
    margin: Real,
    counts: &mut DescentCounts,
    found: impl FnMut(u32) -> ControlFlow<()>,
) {
    let magnitude = mesh.magnitude();
    match shape {
        ConvexShape::HalfSpace(half_space) => {
            let (normal, height) = plane(&placed.placement, half_space, magnitude, margin);
            visit(mesh, |node| lowest(node, normal) <= height, counts, found);
        }
        ConvexShape::Ball(_) if !placed.origin_in_mesh.is_finite() => {}
        ConvexShape::Ball(ball) => {
            let centre = placed.origin_in_mesh.as_vec3();
            visit(mesh, near_ball(centre, ball.radius + margin, magnitude), counts, found);
        }
        _ => {
            let Extent { min, max, radius, .. } = placed.extent;
            let size = min.abs().max(max.abs()).max_element();
            let reach = ((f64::from(margin) + f64::from(radius)) as Real).next_up();
            let test = BoxTest::new([magnitude, size], &placed.inverse(), reach);
            let near = test.of(TestedBox::new(min, max));
            visit(mesh, |node| near.meets(node), counts, found);
        }
    }
}

/// Calls `found` with triangles until `found` breaks. Their boxes and the nodes around them pass a
/// test.
#[inline(always)]
fn visit(
    mesh: &MeshView<'_>,
    is_near: impl Fn(TestedBox) -> bool,
    counts: &mut DescentCounts,
    found: impl FnMut(u32) -> ControlFlow<()>,
) {
    let tested = Cell::new(0);
    let counted = |node: TestedBox| {
        tested.set(tested.get() + 1);
        is_near(node)
    };
    let _ = mesh.near(counted).try_for_each(found);
    counts.aabb_tests += tested.get();
}

/// Returns a test for boxes within reach of a point.
fn near_ball(centre: Vec3, reach: Real, magnitude: Real) -> impl Fn(TestedBox) -> bool {
    // Allows for the rounding of some ten operations with the centre and the boxes.
    let size = magnitude + centre.abs().max_element();
    let beyond = (reach + gamma(16) * (size + reach)).max(Real::MIN_POSITIVE.sqrt());
    move |node| {
        let (middle, extent) = node.centre_extent();
        let beside = ((middle - centre).abs() - extent).max(Vec3::ZERO);
        beside.length_squared() <= beyond * beyond
    }
}

/// Returns the least coordinate of a box along a direction.
pub(crate) fn lowest(node: TestedBox, normal: DVec3) -> f64 {
    let (centre, extent) = node.centre_extent();
    normal.dot(centre.as_dvec3()) - normal.abs().dot(extent.as_dvec3())
}

/// Returns the plane `normal·x = height` above all points within `margin` of a half-space, in the
/// frame of the mesh. `placement` is that frame in the frame of the half-space.
pub(super) fn plane(
    placement: &Placement,
    half_space: &HalfSpace,
    magnitude: Real,
    margin: Real,
) -> (DVec3, f64) {
    let own = half_space.normal.as_dvec3();
    let normal = placement.rotation.transpose() * own;
    // Boxes are rounded to f32; all else is f64.
    let lost = f64::from(gamma(8) * magnitude) * normal.abs().element_sum();
    let offset = own.dot(placement.translation);
    let reach = f64::from(margin) * own.length() + lost + 1e-14 * offset.abs();
    (normal, reach - offset)
}
