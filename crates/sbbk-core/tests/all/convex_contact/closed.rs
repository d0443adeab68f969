//! Closed forms whose contacts are known exactly.

use crate::prelude::*;
use sbbk_core::contact::convex::{PointSupport, convex_contact, half_space_contact};
use sbbk_truth::ConvexBody;

#[test]
fn a_ball_with_its_centre_in_a_triangle_is_pushed_to_the_front() {
    let mut rng = Random(1);
    for _ in 0..1000 {
        let [a, b, c] = [0; 3].map(|_| DVec3::from_array([0; 3].map(|_| rng.below(9) as f64)));
        let front = (b - a).cross(c - a);
        if front == DVec3::ZERO {
            continue;
        }
        let centre = (a + b + 2.0 * c) * 0.25;
        let contact = convex_contact(&[a, b, c], &PointSupport(centre), 0.5).unwrap();
        assert!(contact.distance.abs() < 1.0e-14, "{contact:?}");
        assert!(contact.normal.dot(front.normalize()) > 1.0 - 1.0e-12, "{contact:?}");
    }
}

#[test]
fn half_spaces_touch_the_lowest_corner_within_the_margin() {
    let mut rng = Random(3);
    for _ in 0..5000 {
        let (normal, triangle) = (rng.direction(), [0; 3].map(|_| rng.point()));
        let truth = ConvexBody::half_space(normal).distance(&triangle);
        let contact = half_space_contact(&triangle, normal, 0.1);
        assert_eq!(contact.is_some(), truth <= 0.1);
        if let Some(contact) = contact {
            assert_eq!((contact.distance, contact.normal), (truth, -normal));
            assert!(triangle.contains(&contact.on_triangle));
            assert!(contact.on_shape.dot(normal).abs() < 1.0e-15);
        }
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut broken = triangle;
            broken[rng.below(3) as usize][rng.below(3) as usize] = bad;
            assert_eq!(half_space_contact(&broken, normal, 0.1), None);
            assert_eq!(half_space_contact(&triangle, DVec3::splat(bad), 0.1), None);
        }
    }
}
