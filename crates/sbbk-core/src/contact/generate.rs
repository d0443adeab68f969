//! From two triangles to their contact.

use super::TriangleContact;
use super::axes::{Axis, FaceAxes, best_axis};
use super::closest::{Closest, TIE, closest, closest_on_lines, is_over, proved, within_edge};
use super::edges::{closest_edges, proved_edges};
use super::feature::{Feature, FeaturePair};
use super::touching::{near_axis, touching_contact};
use super::triangle::Triangle;
use glamx::DVec3;

/// Gap or overlap, in triangle sizes, below which rounding may hide if triangles are apart or
/// cross. The choice of the best axis is exact to a tenth of it. Higher: more pairs take the slow
/// path of [`touching_contact`], with the same result. Lower: rounding decides.
pub(super) const TOUCHING: f64 = 1.0e-9;

/// The contact of two triangles at a distance of at most `margin`; crossing ones have a negative
/// distance.
///
/// All coordinates are in one frame. Only differences of coordinates count, so a nearby origin
/// gives the most digits. Triangles may be segments or points. Coordinates between 1e-38 and 1e38
/// are safe from overflow. Returns `None` if a coordinate is not finite.
///
/// About 70 ns when two vertices or edges are closest, 120 when a vertex and a face are, 150 when
/// the triangles cross.
pub fn contact(t1: &[DVec3; 3], t2: &[DVec3; 3], margin: f64) -> Option<TriangleContact> {
    find(&Triangle::new(t1), &Triangle::new(t2), margin, None)
}

/// Returns the same contact as [`contact`](fn@contact), bit for bit, given the features of the
/// contact in the step before. `last` is a hint where to start. If it still holds, a contact of
/// triangles apart takes 20 to 45 ns, a crossing one 120.
pub fn contact_from(
    t1: &[DVec3; 3],
    t2: &[DVec3; 3],
    margin: f64,
    last: FeaturePair,
) -> Option<TriangleContact> {
    find(&Triangle::new(t1), &Triangle::new(t2), margin, Some(last))
}

/// Inlined, and with early returns, so that no contact is copied: that took as long as finding it.
#[inline(always)]
fn find(
    t1: &Triangle,
    t2: &Triangle,
    margin: f64,
    last: Option<FeaturePair>,
) -> Option<TriangleContact> {
    if !(t1.size + t2.size).is_finite() {
        return None;
    }
    // Triangles that crossed probably still do: the ways that find only triangles apart are not
    // tried.
    if last.is_some_and(FeaturePair::is_crossing) {
        let contact = search(t1, t2, margin);
        if contact.is_some_and(|contact| contact.features.is_crossing()) {
            return contact;
        }
    } else if let Some(last) = last
        && let Some(contact) = still(t1, t2, last)
    {
        return (contact.distance <= margin).then_some(contact);
    }
    if let Some((features, closest)) = proved_edges(t1, t2)
        && let Some(contact) = clearly_apart(t1, t2, features, closest)
    {
        return (contact.distance <= margin).then_some(contact);
    }
    search(t1, t2, margin)
}

/// The contact of the given features if it can be proved that no others are as close.
#[inline(always)]
fn still(t1: &Triangle, t2: &Triangle, last: FeaturePair) -> Option<TriangleContact> {
    clearly_apart(t1, t2, last, proved(t1, t2, last)?)
}

#[inline(always)]
fn clearly_apart(
    t1: &Triangle,
    t2: &Triangle,
    features: FeaturePair,
    closest: Closest,
) -> Option<TriangleContact> {
    let is_clear = closest.distance > TOUCHING * (t1.size + t2.size);
    is_clear.then(|| TriangleContact::new(features, closest))
}

/// The contact of any triangles, by their faces and axes.
fn search(t1: &Triangle, t2: &Triangle, margin: f64) -> Option<TriangleContact> {
    let size = t1.size + t2.size;
    let faces = FaceAxes::new(t1, t2);
    let contact = if faces.best.gap > margin {
        return None;
    } else if faces.best.gap > TOUCHING * size {
        beside_face(t1, t2, &faces)
    } else {
        let best = best_axis(t1, t2, &faces);
        if best.gap > TOUCHING * size {
            on_axis(t1, t2, &best).unwrap_or_else(|| on_edges(t1, t2))
        } else if best.gap < -TOUCHING * size && best.gap.is_finite() {
            overlap(t1, t2, &best)
        } else {
            touching_contact(t1, t2, best)
        }
    };
    let contact = from_features(t1, t2, contact);
    (contact.distance <= margin).then_some(contact)
}

/// A contact of triangles apart as [`closest`] gives it, so that the same features give the same
/// digits whichever way they were found.
#[inline(always)]
fn from_features(t1: &Triangle, t2: &Triangle, contact: TriangleContact) -> TriangleContact {
    if contact.features.is_crossing() || contact.distance <= TOUCHING * (t1.size + t2.size) {
        return contact;
    }
    let features = contact.features;
    closest(t1, t2, features).map_or(contact, |closest| TriangleContact::new(features, closest))
}

/// Triangles that a face separates: its nearest vertex is closest if it is over the face. If both
/// faces have the same gap, either may hold the closest point.
fn beside_face(t1: &Triangle, t2: &Triangle, faces: &FaceAxes) -> TriangleContact {
    let FaceAxes { best, other, .. } = faces;
    let is_tied = other.gap >= best.gap - TIE * (t1.size + t2.size);
    on_axis(t1, t2, best)
        .or_else(|| on_axis(t1, t2, Some(other).filter(|_| is_tied)?))
        .unwrap_or_else(|| on_edges(t1, t2))
}

/// The contact of the features of an axis, if they face each other along it: then it is the
/// closest or the least deep one.
fn on_axis(t1: &Triangle, t2: &Triangle, axis: &Axis) -> Option<TriangleContact> {
    let (contact, fits) = features_at(t1, t2, axis);
    fits.then_some(contact)
}

fn on_edges(t1: &Triangle, t2: &Triangle) -> TriangleContact {
    let (features, closest) = closest_edges(t1, t2);
    TriangleContact::new(features, closest)
}

/// Triangles that overlap on every axis, least on this one. Its features face each other: the foot
/// of the perpendicular from a point inside a convex body to the nearest of its planes lies on the
/// body. If axes tie, another vertex or edge may be the right one.
fn overlap(t1: &Triangle, t2: &Triangle, axis: &Axis) -> TriangleContact {
    let (contact, fits) = features_at(t1, t2, axis);
    let contact = if fits { contact } else { near_axis(t1, t2, axis) };
    TriangleContact { features: contact.features.crossing(), ..contact }
}

/// The points of an axis' features, and whether they lie within the features.
#[inline(always)]
fn features_at(t1: &Triangle, t2: &Triangle, axis: &Axis) -> (TriangleContact, bool) {
    let (&Axis { gap, normal, .. }, features) = (axis, axis.features());
    let (point1, point2, fits) = match (features.feature1(), features.feature2()) {
        (Feature::Vertex(i), _) => {
            let p = t1.vertices[i as usize];
            (p, p + normal * gap, is_over(p, t2, normal))
        }
        (_, Feature::Vertex(j)) => {
            let q = t2.vertices[j as usize];
            (q - normal * gap, q, is_over(q, t1, normal))
        }
        (feature1, feature2) => edges_at(t1, feature1.vertex(), t2, feature2.vertex(), axis),
    };
    (TriangleContact { normal, distance: gap, point1, point2, features }, fits)
}

#[inline(always)]
fn edges_at(t1: &Triangle, i: usize, t2: &Triangle, j: usize, axis: &Axis) -> (DVec3, DVec3, bool) {
    let (e1, e2) = (t1.edges[i], t2.edges[j]);
    let between = t2.vertices[j] - t1.vertices[i];
    let along = closest_on_lines(between, e1, e2);
    let [s1, s2] = [within_edge(along[0]), within_edge(along[1])];
    // The axis is not the direction of the contact if its gap belongs to an opposite vertex.
    let slack = (between.dot(axis.normal) - axis.gap).abs();
    let fits = along == [s1, s2] && slack <= TIE * (t1.size + t2.size);
    (t1.vertices[i] + e1 * s1, t2.vertices[j] + e2 * s2, fits)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glamx::{DQuat, DVec3};
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(-1.0..1.0).prop_map(DVec3::from_array)
    }

    fn triangle() -> impl Strategy<Value = [DVec3; 3]> {
        prop::array::uniform3(point())
    }

    #[test]
    fn contacts_of_drifting_triangles_are_equal_with_hints() {
        let (mut apart, mut kept, mut crossing) = (0, 0, 0);
        let mut runner = proptest::test_runner::TestRunner::deterministic();
        let walks = (triangle(), triangle(), point(), point());
        for _ in 0..500 {
            let tree = walks.new_tree(&mut runner).unwrap();
            let (t1, mut t2, drift, turn) = proptest::strategy::ValueTree::current(&tree);
            t2 = t2.map(|v| v - drift);
            let turn = DQuat::from_scaled_axis(0.02 * turn);
            let mut last = contact(&t1, &t2, f64::INFINITY).unwrap().features;
            for _ in 0..100 {
                t2 = t2.map(|v| turn * v + 0.02 * drift);
                let cold = contact(&t1, &t2, f64::INFINITY).unwrap();
                assert_eq!(Some(cold), contact_from(&t1, &t2, f64::INFINITY, last));
                assert_eq!(contact(&t1, &t2, 0.3), contact_from(&t1, &t2, 0.3, last));
                apart += u32::from(cold.distance > 0.0);
                crossing += u32::from(cold.distance < 0.0);
                kept += u32::from(still(&Triangle::new(&t1), &Triangle::new(&t2), last).is_some());
                last = cold.features;
            }
        }
        assert!(crossing > 1000 && apart > 10_000, "{crossing} {apart}");
        assert!(kept > apart * 9 / 10, "only {kept} of {apart} steps apart kept their features");
    }

    /// Compares contacts with any hint with those without.
    fn check_all_hints(t1: &[DVec3; 3], t2: &[DVec3; 3], margin: f64) {
        let cold = contact(t1, t2, margin);
        for bits in 0..=FeaturePair::MASK {
            assert_eq!(cold, contact_from(t1, t2, margin, FeaturePair::from_bits(bits)));
        }
    }

    #[test]
    fn contacts_of_points_and_segments_are_equal_with_any_hint() {
        let [a, b, c] =
            [DVec3::new(-1.5, 1.625, 0.5), DVec3::splat(0.5), DVec3::new(2.0, 0.5, 0.5)];
        let [point1, point2, segment] = [[a; 3], [b; 3], [b, c, b]];
        for (t1, t2) in [(point1, point2), (point1, segment), (segment, point1), (segment, segment)]
        {
            check_all_hints(&t1, &t2, 10.0);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        /// Corners near a lattice make features that nearly tie, or tie to the last digit.
        #[test]
        fn contacts_are_equal_with_any_hint(
            corners in prop::array::uniform6(prop::array::uniform3(-2_i8..=2)),
            offsets in prop::array::uniform6(prop::array::uniform3(-1.0..1.0)),
            is_round: bool,
            nudge in prop::sample::select(vec![0.0, 1e-15, 1e-12, 1e-10, 1e-9, 1e-8, 1e-6, 1e-3, 1.0]),
            margin in prop::sample::select(vec![0.5, 10.0]),
        ) {
            let corner = |i: usize| {
                let offset = DVec3::from_array(offsets[i]);
                let offset = if is_round { offset.round() } else { offset };
                DVec3::from_array(corners[i].map(f64::from)) + nudge * offset
            };
            check_all_hints(&[0, 1, 2].map(corner), &[3, 4, 5].map(corner), margin);
        }
    }
}
