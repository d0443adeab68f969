//! The triangles of a mesh near a convex shape, by Parry's BVH of the mesh.

use std::cell::Cell;
use std::ops::ControlFlow;

use glamx::{DVec3, Vec3};
use parry3d::bounding_volume::Aabb;
use parry3d::math::Real;
use parry3d::shape::HalfSpace;
use sbbk_core::traverse::{BoxTest, Counters, Placement, TestedBox};
use sbbk_core::volumes::rounding::gamma;

use super::parts::PlacedPart;
use super::shape::ConvexShape;
use crate::mesh::MeshView;

/// Calls `found` with all triangles within `margin` of a part, and a few others, in the order of the
/// BVH, until it returns `Break`.
pub(super) fn triangles_near(
    placed: &PlacedPart,
    shape: ConvexShape<'_>,
    mesh: &MeshView<'_>,
    margin: Real,
    counters: impl Counters,
    found: impl FnMut(u32) -> ControlFlow<()>,
) {
    let magnitude = mesh.magnitude();
    match shape {
        ConvexShape::HalfSpace(half_space) => {
            let (normal, height) = plane(&placed.placement, half_space, magnitude, margin);
            visit(mesh, |node| lowest(node, normal) <= height, counters, found);
        }
        ConvexShape::Ball(_) if !placed.origin_in_mesh.is_finite() => {}
        ConvexShape::Ball(ball) => {
            let centre = placed.origin_in_mesh.as_vec3();
            visit(mesh, near_ball(centre, ball.radius + margin, magnitude), counters, found);
        }
        _ => {
            let (min, max, radius) = placed.extent.bounds();
            let size = min.abs().max(max.abs()).max_element();
            let reach = ((f64::from(margin) + f64::from(radius)) as Real).next_up();
            let test = BoxTest::new([magnitude, size], &placed.inverse(), reach);
            let near = test.of(TestedBox::new(min, max));
            visit(mesh, |node| near.meets(node), counters, found);
        }
    }
}

/// Calls `found` with triangles until `found` breaks. Their boxes and the nodes around them pass a test.
#[inline(always)]
fn visit(
    mesh: &MeshView<'_>,
    is_near: impl Fn(TestedBox) -> bool,
    mut counters: impl Counters,
    found: impl FnMut(u32) -> ControlFlow<()>,
) {
    let tested = Cell::new(0);
    let counted = |node: TestedBox| {
        tested.set(tested.get() + 1);
        is_near(node)
    };
    let _ = mesh.near(counted).try_for_each(found);
    counters.aabb_tests(tested.get());
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

/// Returns a lower bound of the distance between a box of a mesh and a part. `around` is the box around
/// the part in the frame of the mesh.
pub(super) fn gap_of(
    placed: &PlacedPart,
    shape: ConvexShape<'_>,
    mesh: &MeshView<'_>,
    around: Aabb,
) -> impl Fn(TestedBox) -> Real {
    let magnitude = mesh.magnitude();
    let plane = match shape {
        ConvexShape::HalfSpace(half_space) => {
            Some(plane(&placed.placement, half_space, magnitude, 0.0))
        }
        _ => None,
    };
    let lost = rounding(mesh, &around);
    move |node| {
        if let Some((normal, height)) = plane {
            return ((lowest(node, normal) - height) as Real).next_down().max(0.0);
        }
        let (centre, extent) = node.centre_extent();
        let gap = (centre - around.center()).abs() - (extent + around.half_extents());
        (gap.max(Vec3::ZERO).length() * (1.0 - gamma(8)) - lost).max(0.0)
    }
}

/// Returns a bound of the rounding of boxes: some twenty operations.
fn rounding(mesh: &MeshView<'_>, around: &Aabb) -> Real {
    gamma(32) * mesh.magnitude().max(around.mins.abs().max(around.maxs.abs()).max_element())
}

/// Returns a lower bound of the time until a box of a mesh is within `target` of a moving part;
/// `Real::MAX` if the two pass each other. `velocity` and `around`, the box around the part, are in the
/// frame of the mesh.
pub(super) fn time_of(
    placed: &PlacedPart,
    shape: ConvexShape<'_>,
    mesh: &MeshView<'_>,
    around: Aabb,
    velocity: DVec3,
    target: Real,
) -> impl Fn(TestedBox) -> Real {
    let gap = gap_of(placed, shape, mesh, around);
    let slack = f64::from(target) + f64::from(rounding(mesh, &around));
    let is_infinite = matches!(shape, ConvexShape::HalfSpace(_));
    // Allows for the rounding of poses and boxes, and so of the velocity's direction.
    let speed = velocity.length() * f64::from(1.0 + gamma(8));
    let lost = f64::from(gamma(8)) * speed;
    let (speeds, signs) = (velocity.abs(), velocity.signum());
    let (per_fast, per_slow) = ((speeds + lost).recip(), (speeds - lost).recip());
    let is_slow = speeds.cmple(DVec3::splat(lost));
    let per_speed = speed.recip();
    // Earliest and latest time at which the boxes overlap, grown by the target.
    let overlap = move |node: TestedBox| {
        let (centre, extent) = node.centre_extent();
        let offset = (centre - around.center()).as_dvec3();
        let reach = (extent + around.half_extents()).as_dvec3() + slack;
        let ahead = DVec3::select(is_slow, offset.abs(), offset * signs);
        let last = DVec3::select(is_slow, DVec3::INFINITY, (ahead + reach) * per_slow);
        (((ahead - reach) * per_fast).max_element().max(0.0), last.min_element())
    };
    move |node| {
        let (start, end) = if is_infinite { (0.0, f64::INFINITY) } else { overlap(node) };
        let time = || start.max((f64::from(gap(node)) - f64::from(target)) * per_speed);
        // False for NaN, as of a velocity of zero.
        let is_time = |time: f64| time <= end && time < f64::from(Real::MAX);
        let time = if is_time(start) { time() } else { f64::INFINITY };
        if is_time(time) { (time as Real).next_down().max(0.0) } else { Real::MAX }
    }
}

/// Returns the least coordinate of a box along a direction.
pub(crate) fn lowest(node: TestedBox, normal: DVec3) -> f64 {
    let (centre, extent) = node.centre_extent();
    normal.dot(centre.as_dvec3()) - normal.abs().dot(extent.as_dvec3())
}

/// Returns the plane `normal·x = height` above all points within `margin` of a half-space, in the frame
/// of the mesh. `placement` is that frame in the frame of the half-space.
fn plane(
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
