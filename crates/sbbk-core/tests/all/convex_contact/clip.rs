//! The points where a triangle and a feature of a shape overlap, seen along a normal.

use crate::prelude::*;
use sbbk_core::contact::convex::{FeaturePoints, clip_feature};

/// Twice the area of a triangle seen along z.
fn beside(a: DVec3, b: DVec3, p: DVec3) -> f64 {
    (b - a).truncate().perp_dot((p - a).truncate())
}

/// Depth of a point inside a polygon of either orientation, seen along z.
fn inside(polygon: &[DVec3], p: DVec3) -> f64 {
    let n = polygon.len();
    let side = |i: usize| {
        let (a, b) = (polygon[i], polygon[(i + 1) % n]);
        beside(a, b, p) / (b - a).truncate().length()
    };
    let sides: Vec<f64> = (0..n).map(side).collect();
    let least = sides.iter().copied().fold(f64::INFINITY, f64::min);
    let most = sides.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    least.max(-most)
}

#[test]
fn clipped_points_are_the_corners_of_the_overlap() {
    let mut rng = Random(11);
    let mut total = 0;
    for i in 0..20_000 {
        let triangle = [0; 3].map(|_| rng.point());
        let turn = DQuat::from_rotation_z(rng.within(0.0, 6.0));
        let tilt = DVec3::new(rng.within(-0.5, 0.5), rng.within(-0.5, 0.5), 1.0);
        let [x, y] = [rng.scale(0.1, 1.0), rng.scale(0.1, 1.0)];
        let corners = [(x, y), (-x, y), (-x, -y), (x, -y)].map(|(x, y)| {
            let flat = turn * DVec3::new(x, y, 0.0);
            flat + DVec3::Z * (2.0 - flat.dot(tilt))
        });
        let feature = &corners[..2 + i % 3];
        let whole = DQuat::from_scaled_axis(rng.point() * 3.0);
        let shift = rng.point();
        let place = |p: DVec3| whole * p + shift;
        let mut points = FeaturePoints::new();
        let placed: Vec<DVec3> = feature.iter().map(|&p| place(p)).collect();
        clip_feature(&triangle.map(place), &placed, whole * DVec3::Z, &mut points);
        total += points.len();
        for point in &points {
            let [on_triangle, on_shape] =
                [point.on_triangle, point.on_shape].map(|p| whole.inverse() * (p - shift));
            let along = on_shape - on_triangle;
            assert!((along - DVec3::Z * point.distance).length() < 1.0e-9, "{point:?}");
            assert!(inside(&triangle, on_triangle) > -1.0e-9, "{point:?}");
            let is_on = if feature.len() == 2 {
                let [a, b] = [feature[0], feature[1]];
                (on_shape - a).cross(b - a).length() < 1.0e-9
            } else {
                inside(feature, on_shape) > -1.0e-9
            };
            assert!(is_on, "{point:?} {feature:?}");
            match point.features {
                [Feature::Vertex(v), Feature::Face] => {
                    assert!((triangle[usize::from(v)] - on_triangle).length() < 1.0e-12);
                }
                [Feature::Face, Feature::Vertex(v)] => {
                    assert!((feature[usize::from(v)] - on_shape).length() < 1.0e-12);
                }
                [Feature::Edge(_), Feature::Edge(_)] => {}
                other => panic!("{other:?}"),
            }
        }
        let has = |features: [Feature; 2]| points.iter().any(|point| point.features == features);
        for (v, &corner) in (0..).zip(feature) {
            let is_inside = inside(&triangle, corner) > 1.0e-9;
            assert!(!is_inside || has([Feature::Face, Feature::Vertex(v)]));
        }
        for (v, &corner) in (0..).zip(&triangle) {
            let is_inside = feature.len() > 2 && inside(feature, corner) > 1.0e-9;
            assert!(!is_inside || has([Feature::Vertex(v), Feature::Face]));
        }
        for (i, j) in (0..3).flat_map(|i| (0..feature.len()).map(move |j| (i, j))) {
            let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
            let (c, d) = (feature[j], feature[(j + 1) % feature.len()]);
            let [e, f] = [beside(a, b, c) * beside(a, b, d), beside(c, d, a) * beside(c, d, b)];
            let crosses = e < -1.0e-12 && f < -1.0e-12 && !(feature.len() == 2 && j == 1);
            assert!(!crosses || has([Feature::Edge(i as u8), Feature::Edge(j as u8)]));
        }
    }
    assert!(total > 40_000, "{total}");
}

#[test]
fn features_of_other_corner_counts_have_no_points() {
    let floor = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let mut points = FeaturePoints::new();
    for count in [0, 1, 5] {
        clip_feature(&floor, &vec![DVec3::splat(0.2); count], DVec3::Z, &mut points);
        assert!(points.is_empty());
    }
}

#[test]
fn an_edge_across_a_triangle_has_two_points() {
    let triangle = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]].map(|[x, z]| DVec3::new(x, 0.0, z));
    let edge = [DVec3::new(-1.0, 0.5, 1.0), DVec3::new(5.0, 0.5, 1.0)];
    let mut points = FeaturePoints::new();
    clip_feature(&triangle, &edge, DVec3::Y, &mut points);
    assert_eq!(points.len(), 2, "{points:?}");
    assert!(points.iter().all(|point| (point.distance - 0.5).abs() < 1e-15), "{points:?}");
}

#[test]
fn a_face_seen_edge_on_has_no_points() {
    let triangle = [[0.5, 5.0, 0.0], [0.4, 6.0, 3.0], [0.6, 6.0, 3.0]].map(DVec3::from_array);
    let count = |lean: f64| {
        let corners = [[0.0, -1.0, -1.0], [1.0, -1.0, -1.0], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0]];
        let face = corners.map(|[x, y, z]| DVec3::new(x, y, lean * z));
        let mut points = FeaturePoints::new();
        clip_feature(&triangle, &face, -DVec3::Y, &mut points);
        points.iter().filter(|point| point.features == [Feature::Vertex(0), Feature::Face]).count()
    };
    assert_eq!([0.1, 1e-9].map(count), [1, 0]);
}
