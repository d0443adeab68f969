//! The triangles of a mesh near a convex shape, from Parry's hierarchy of the mesh.

use std::cell::Cell;
use std::ops::ControlFlow;

use glamx::DVec3;
use parry3d::math::Real;
use parry3d::shape::HalfSpace;
use sbbk_core::traverse::{BoxTest, Counters, Placement, TestedBox};
use sbbk_core::volumes::rounding::gamma;

use super::placed::PlacedPart;
use super::shape::ConvexShape;
use crate::mesh::Hierarchy;

/// Calls `found` with the triangles whose boxes, and those above them, may be within `margin` of a
/// part, in stock order.
pub(super) fn triangles_near(
    placed: &PlacedPart,
    shape: ConvexShape<'_>,
    mesh: &Hierarchy<'_>,
    margin: Real,
    mut counters: impl Counters,
    mut found: impl FnMut(u32),
) {
    let (tested, magnitude) = (Cell::new(0), mesh.magnitude());
    let count = || tested.set(tested.get() + 1);
    let found = |triangle| {
        found(triangle);
        ControlFlow::Continue(())
    };
    let _ = if let ConvexShape::HalfSpace(half_space) = shape {
        let (normal, height) = plane(&placed.placement, half_space, magnitude, margin);
        let is_below = |node: TestedBox| {
            count();
            let (centre, extent) = node.centre_extent();
            normal.dot(centre.as_dvec3()) - normal.abs().dot(extent.as_dvec3()) <= height
        };
        mesh.near(is_below, found)
    } else {
        let (min, max, radius) = placed.extent.bounds();
        let size = min.abs().max(max.abs()).max_element();
        let reach = ((f64::from(margin) + f64::from(radius)) as Real).next_up();
        let test = BoxTest::new([magnitude, size], &placed.inverse, reach);
        let near = test.of(TestedBox::new(min, max));
        let meets = |node: TestedBox| {
            count();
            near.meets(node)
        };
        mesh.near(meets, found)
    };
    counters.aabb_tests(tested.get());
}

/// All within `margin` of a half-space, in the frame of a mesh that is at `placement` in its frame:
/// `normal·x <= height`.
fn plane(
    placement: &Placement,
    half_space: &HalfSpace,
    magnitude: Real,
    margin: Real,
) -> (DVec3, f64) {
    let own = half_space.normal.as_dvec3();
    let normal = placement.rotation.transpose() * own;
    // What boxes lose to rounding in f32 is a few parts of their size; all else is f64.
    let lost = f64::from(gamma(8) * magnitude) * normal.abs().element_sum();
    let offset = own.dot(placement.translation);
    let reach = f64::from(margin) * own.length() + lost + 1e-14 * offset.abs();
    (normal, reach - offset)
}
