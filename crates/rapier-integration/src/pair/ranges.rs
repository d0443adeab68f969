//! Distances up to which contacts of surfaces are searched and filtered.

use parry3d::math::Real;
use sbbk_core::leaf::LateralCulling;
use sbbk_core::surface::Facets;

use super::pose::PairPose;
use super::reduce::FILTERED;
use super::triangle_shapes::TriangleShapes;

/// Greatest [`reach`] of fine meshes in [`TriangleShapes::filter_distance`]s: 0.04 radii. A body of one length unit has a
/// radius of half a unit, and Rapier predicts 0.02 units by default. Higher: fine meshes cost more;
/// lower: bodies come deeper into others before they meet.
const REACH: f64 = 0.4;

/// Distance in prediction distances beyond which a contact of edges or vertices needs a normal near
/// both triangle normals. Higher: gears are braked by edges that pass each other; lower: edges meet
/// with less warning.
pub(super) const DISTANT: f64 = 0.25;

/// Least cosine between the normal of a [`DISTANT`] contact and both triangle normals. Higher:
/// smooth bodies lose contacts; lower: gears are braked.
pub(super) const NEAR_NORMAL: f64 = 0.87;

/// Returns [`TriangleShapes::filter_distance`] from the radius of the smaller shape.
pub(super) fn filter_distance(has_surface: bool, radius: Real) -> f64 {
    if has_surface { f64::from(FILTERED * radius) } else { f64::INFINITY }
}

/// Returns the distance up to which all contacts of two meshes are found.
pub(super) fn reach(
    prediction: Real,
    filter_distance: f64,
    are_few: impl FnOnce() -> bool,
) -> Real {
    let most = (REACH * filter_distance) as Real;
    // A prediction distance that is NaN finds nothing.
    if most < prediction && !are_few() { most } else { prediction }
}

/// Returns the unit of the filter: the prediction distance, or less for small shapes.
pub(super) fn filter_unit(pose: &PairPose, filter_distance: f64) -> f64 {
    f64::from(pose.prediction).min(filter_distance)
}

/// Returns the [`filter_unit`] of two shapes.
pub(super) fn near(shapes: &impl TriangleShapes, pose: &PairPose) -> f64 {
    filter_unit(pose, shapes.filter_distance())
}

/// Returns a test for pairs of triangles that a descent within `margin` finds and that are no local minima while its candidates
/// serve, unless a triangle [bends much](bends_little).
pub(super) fn lateral_culling(
    shapes: &impl TriangleShapes,
    pose: &PairPose,
    margin: Real,
) -> Option<LateralCulling> {
    let reach = shapes.reach();
    let is_filtered = f64::from(reach) <= shapes.filter_distance();
    (shapes.has_surface() && is_filtered).then(|| {
        let (distance, travel) = ((DISTANT * near(shapes, pose)) as Real, margin - reach);
        LateralCulling::new(distance, NEAR_NORMAL as Real, reach, travel)
    })
}

/// Returns true if a contact that leans from the normal of a triangle as much as
/// [lateral culling](lateral_culling) asks for is no local minimum.
pub(super) fn bends_little(facets: &impl Facets, triangle: u32) -> bool {
    facets.cones(triangle).least_square(false) >= NEAR_NORMAL * NEAR_NORMAL
}
