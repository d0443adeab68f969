//! The points of a manifold against the polygon where the shadows overlap, found by clipping one
//! shadow at the edges of the other (I. Sutherland, G. Hodgman, 1974).

use super::check::{TOLERANCE, Triangle, part, point, size, triangle};
use crate::prelude::*;
use glamx::DVec2;
use proptest::prelude::*;
use sbbk_core::contact::{FeaturePair, ManifoldPoint, clip, contact, push_closest};
use sbbk_truth as truth;
use std::collections::HashSet;

/// Shadow of a triangle, counter-clockwise.
fn shadow(t: &Triangle, normal: DVec3) -> Vec<DVec2> {
    let across = normal.cross(DVec3::new(0.3, -0.7, 0.2)).normalize();
    let up = normal.cross(across);
    let mut shadow: Vec<_> = t.iter().map(|v| DVec2::new(v.dot(across), v.dot(up))).collect();
    if (shadow[1] - shadow[0]).perp_dot(shadow[2] - shadow[0]) < 0.0 {
        shadow.reverse();
    }
    shadow
}

fn overlap(subject: Vec<DVec2>, clipper: &[DVec2]) -> Vec<DVec2> {
    (0..3).fold(subject, |polygon, e| {
        let (a, b) = (clipper[e], clipper[(e + 1) % 3]);
        let side = |p: DVec2| (b - a).perp_dot(p - a);
        let mut kept = Vec::new();
        for (i, &p) in polygon.iter().enumerate() {
            let q = polygon[(i + 1) % polygon.len()];
            if side(p) >= 0.0 {
                kept.push(p);
            }
            if side(p) * side(q) < 0.0 {
                kept.push(p.lerp(q, side(p) / (side(p) - side(q))));
            }
        }
        kept
    })
}

/// True unless three corners lie so close that rounding could add or drop one.
fn is_generic(shadows: [&[DVec2]; 2], clear: f64) -> bool {
    let corner = |k: usize, i: usize| shadows[k][i % 3];
    (0..2).all(|k| {
        (0..3).all(|e| {
            let (a, b) = (corner(k, e), corner(k, e + 1));
            let far = |p: DVec2| (b - a).normalize().perp_dot(p - a).abs() > clear;
            a.distance(b) > clear && far(corner(k, e + 2)) && (0..3).all(|v| far(corner(1 - k, v)))
        })
    })
}

fn check_point(
    point: &ManifoldPoint,
    t1: &Triangle,
    t2: &Triangle,
    normal: DVec3,
) -> Result<(), TestCaseError> {
    let tolerance = TOLERANCE * size(t1).max(size(t2));
    let offset = point.point2 - point.point1 - normal * point.distance;
    prop_assert!(offset.length() <= tolerance, "not in line: {offset}");
    for (p, t, feature) in [
        (point.point1, t1, point.features.feature1()),
        (point.point2, t2, point.features.feature2()),
    ] {
        let off = truth::contact(&[p; 3], &part(t, feature)).distance.abs();
        prop_assert!(off <= 100.0 * tolerance, "{feature:?} is missed by {off:e}");
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn manifold_points_are_the_corners_of_the_overlap(t1 in triangle(), t2 in triangle(), offset in point(), closeness in 0.0..1.0) {
        // Both at a distance and into each other.
        let apart = t2.map(|v| v + 2.0 * offset);
        let before = truth::contact(&t1, &apart);
        let t2 = apart.map(|v| v + before.normal * (0.1 * closeness - before.distance));
        let found = contact(&t1, &t2, 1.0).expect("closer than 0.1");
        let normal = found.normal;
        let mut points = ManifoldPoints::new();
        clip(&t1, &t2, normal, &mut points);

        for point in &points {
            check_point(point, &t1, &t2, normal)?;
        }
        let names: HashSet<_> = points.iter().map(|p| p.features).collect();
        prop_assert_eq!(names.len(), points.len());
        let [shadow1, shadow2] = [&t1, &t2].map(|t| shadow(t, normal));
        if is_generic([&shadow1, &shadow2], 1.0e-4) {
            prop_assert_eq!(points.len(), overlap(shadow1, &shadow2).len());
        }

        push_closest(&t1, &t2, &found, &mut points);
        for point in &points {
            check_point(point, &t1, &t2, normal)?;
        }
        let least = points.iter().map(|p| p.distance).fold(f64::INFINITY, f64::min);
        prop_assert!((least - found.distance).abs() <= TOLERANCE * 10.0, "{least} {found:?}");
        let count = points.len();
        push_closest(&t1, &t2, &found, &mut points);
        prop_assert_eq!(points.len(), count, "the closest points were added twice");
        let names: HashSet<_> = points.iter().map(|p| p.features).collect();
        prop_assert_eq!(names.len(), points.len());
    }

    #[test]
    fn points_of_triangles_seen_edge_on_lie_on_both_triangles(t1 in triangle(), t2 in triangle(), tilt in -9.0..-1.0, around in point()) {
        for edge_on in [&t1, &t2] {
            let along = (edge_on[1] - edge_on[0]).normalize();
            let normal = (along + around * 10.0_f64.powf(tilt) * 0.1).normalize();
            let mut points = ManifoldPoints::new();
            clip(&t1, &t2, normal, &mut points);
            for point in &points {
                check_point(point, &t1, &t2, normal)?;
            }
        }
    }
}

#[test]
fn a_standing_triangle_has_the_points_of_its_lower_edge() {
    let floor = [DVec3::ZERO, DVec3::X * 4.0, DVec3::Y * 4.0];
    let wall = [DVec3::new(0.5, 0.5, 0.1), DVec3::new(1.5, 0.5, 0.1), DVec3::new(0.5, 0.5, 3.0)];
    let mut points = ManifoldPoints::new();
    clip(&floor, &wall, DVec3::Z, &mut points);
    let distances: Vec<_> = points.iter().map(|p| p.distance).collect();
    assert_eq!(points.len(), 3);
    assert!(points.iter().all(|p| p.features.feature1() == Feature::Face));
    assert!(
        distances.iter().zip([0.1, 0.1, 3.0]).all(|(d, e)| (d - e).abs() < 1.0e-12),
        "{distances:?}"
    );
}

#[test]
fn a_large_triangle_beside_a_small_one_has_no_points() {
    let large = [DVec3::ZERO, DVec3::X * 1.0e5, DVec3::Y * 1.0e5];
    for beside in [1.0e-4, 1.0e-3, 1.0, 10.0] {
        let small =
            [DVec3::ZERO, DVec3::X, DVec3::Y].map(|v| v * 1.0e-4 - DVec3::X * (1.0e-4 + beside));
        let mut points = ManifoldPoints::new();
        clip(&large, &small, DVec3::Z, &mut points);
        assert!(points.is_empty(), "{beside}: {points:?}");
    }
}

#[test]
fn closest_points_keep_the_features_of_their_triangles() {
    let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    let left = [at(-2.0, -1.0), at(-2.0, 1.0), at(0.0, 0.0)];
    let corner = [at(1.0, 0.0), at(3.0, 1.0), at(3.0, -1.0)];
    let side = [at(3.0, 0.0), at(1.0, -1.0), at(1.0, 1.0)];
    for (right, feature2) in [(corner, Feature::Vertex(0)), (side, Feature::Edge(1))] {
        let corner = Feature::Vertex(2);
        for (t1, t2, features) in [
            (left, right, FeaturePair::new(corner, feature2)),
            (right, left, FeaturePair::new(feature2, corner)),
        ] {
            let mut points = ManifoldPoints::new();
            let found = contact(&t1, &t2, 2.0).unwrap();
            assert_eq!(found.features, features);
            clip(&t1, &t2, found.normal, &mut points);
            push_closest(&t1, &t2, &found, &mut points);
            assert_eq!(points.len(), 1, "{points:?}");
            assert_eq!((points[0].features, points[0].distance), (features, 1.0));
        }
    }
}
