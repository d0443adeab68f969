//! Triangles that no axis clearly separates and no axis clearly lets overlap: they touch, or lie
//! in one plane or on one line.
//!
//! This case is rare, so the search is complete. It takes all fifteen feature distances, and the
//! axes in the planes of the triangles besides the other eleven. If triangles cross by a depth `d`,
//! a move by `d` makes them touch, so two features were at most `d` apart. Triangles whose features
//! are farther apart than the depth do not cross.

use super::TriangleContact;
use super::axes::Axis;
use super::clip::{ManifoldPoint, ManifoldPoints, clip_triangles};
use super::closest::{Closest, closest};
use super::edges::closest_edges;
use super::feature::{Feature, FeaturePair};
use super::triangle::Triangle;
use glamx::DVec3;

/// Effect of rounding on a distance or gap, in triangle sizes. Higher: triangles this close count
/// as touching. Lower: the normal of triangles that touch is noise.
const ROUNDING: f64 = 1.0e-12;

/// The contact of two triangles whose best axis has a gap of nearly nothing, or does not exist.
#[cold]
pub(super) fn touching_contact(t1: &Triangle, t2: &Triangle, best: Axis) -> TriangleContact {
    let (features, nearest) = nearest_features(t1, t2);
    let axis = in_plane_axes(t1, t2).fold(best, |a, b| if b.gap > a.gap { b } else { a });
    let exists = axis.normal != DVec3::ZERO;
    let depth = if exists { (-axis.gap).max(0.0) } else { 0.0 };
    if nearest.distance > depth + ROUNDING * (t1.size + t2.size) {
        TriangleContact::new(features, nearest)
    } else if exists {
        at_axis(t1, t2, &axis).unwrap_or_else(|| in_line(&axis, features, &nearest))
    } else {
        on_one_line(t1, t2, features, &nearest)
    }
}

/// The contact on an axis from features that touch.
fn in_line(axis: &Axis, features: FeaturePair, nearest: &Closest) -> TriangleContact {
    let (Axis { normal, gap: distance, .. }, point1) = (*axis, nearest.point1);
    TriangleContact { normal, distance, point1, point2: point1 + normal * distance, features }
}

/// The contact on an axis of overlapping triangles if neither its features nor corners of the
/// overlap show the depth. A triangle may be a segment with a corner inside it.
#[cold]
pub(super) fn near_axis(t1: &Triangle, t2: &Triangle, axis: &Axis) -> TriangleContact {
    at_axis(t1, t2, axis).unwrap_or_else(|| {
        let (features, nearest) = nearest_features(t1, t2);
        in_line(axis, features, &nearest)
    })
}

/// The contact on an axis where many features tie: the deepest of the points seen along it. `None`
/// if no point is as deep as the gap.
fn at_axis(t1: &Triangle, t2: &Triangle, axis: &Axis) -> Option<TriangleContact> {
    let mut points = ManifoldPoints::new();
    clip_triangles(t1, t2, axis.normal, &mut points);
    let deepest = deepest(&points, axis.normal)?;
    let is_as_deep = (deepest.distance - axis.gap).abs() <= ROUNDING * (t1.size + t2.size);
    is_as_deep.then_some(TriangleContact { distance: axis.gap, ..deepest })
}

/// The contact of the deepest of the points seen along a normal.
pub(super) fn deepest(points: &ManifoldPoints, normal: DVec3) -> Option<TriangleContact> {
    let deepest = points.iter().min_by(|a, b| a.distance.total_cmp(&b.distance))?;
    let ManifoldPoint { point1, point2, distance, features } = *deepest;
    Some(TriangleContact { normal, distance, point1, point2, features })
}

/// The least of the distances of nine edge pairs and six vertices over the other's face.
fn nearest_features(t1: &Triangle, t2: &Triangle) -> (FeaturePair, Closest) {
    let mut nearest = closest_edges(t1, t2);
    for i in (0..3).map(Feature::Vertex) {
        for features in [FeaturePair::new(i, Feature::Face), FeaturePair::new(Feature::Face, i)] {
            if let Some(candidate) = closest(t1, t2, features)
                && candidate.distance < nearest.1.distance
            {
                nearest = (features, candidate);
            }
        }
    }
    nearest
}

/// The normals of the edges in the planes of their triangles. The features are arbitrary:
/// [`at_axis`] finds the right ones.
fn in_plane_axes(t1: &Triangle, t2: &Triangle) -> impl Iterator<Item = Axis> {
    let faces = FeaturePair::new(Feature::Face, Feature::Face);
    let across = |t: &Triangle| t.edges.map(|edge| edge.cross(t.normal()).try_normalize());
    let normals = [across(t1), across(t2)].into_iter().flatten().flatten();
    normals.map(move |normal| Axis::along(t1, t2, normal, faces))
}

/// Segments and points on one line, which touch: any direction across the line separates them.
fn on_one_line(
    t1: &Triangle,
    t2: &Triangle,
    features: FeaturePair,
    nearest: &Closest,
) -> TriangleContact {
    let along = t1.edges.into_iter().chain(t2.edges).find_map(DVec3::try_normalize);
    TriangleContact {
        normal: along.map_or(DVec3::Z, DVec3::any_orthonormal_vector),
        distance: 0.0,
        point1: nearest.point1,
        point2: nearest.point2,
        features,
    }
}
