//! Closed forms beside the search by support points, which knows nothing of the shape.

use super::shape::{Core, Kind, Rng, Shape};
use super::truth::{check, size};
use glamx::DVec3;
use sbbk_core::contact::convex::{
    CuboidSupport, PointSupport, SegmentSupport, convex_contact, half_space_contact, round_contact,
};
use sbbk_core::truth::ConvexBody;

/// Would catch a part of a surface that a closed form leaves out: its depth is then greater than
/// that of the search, which is never less than the true one.
#[test]
fn closed_forms_are_those_of_the_search() {
    let (mut apart, mut deep) = (0, 0);
    for kind in Kind::POLYTOPES.into_iter().chain(Kind::CURVED) {
        let mut rng = Rng(700 + kind as u64);
        for i in 0..30_000 {
            let shape = rng.shape(kind);
            let gap = [rng.within(0.0, 0.1), 0.0, rng.within(-1.0, 0.0)][i % 3];
            let triangle = rng.triangle_beside(&shape, gap);
            let size = size(&triangle, &shape);
            let own = shape.contact(&triangle, 100.0).unwrap();
            let core = |direction: DVec3| shape.support(direction);
            let searched = round_contact(&triangle, &core, shape.radius, 100.0).unwrap();
            let says = || format!("{own:?} {searched:?}\n{shape:?}\n{triangle:?}");
            let excess = (own.distance - searched.distance) / size;
            if own.distance > -shape.radius {
                apart += 1;
                assert!(excess.abs() <= 1.0e-8, "{}", says());
            } else {
                deep += 1;
                // A search on a curved surface may end before it finds the least depth.
                let is_curved = matches!(shape.core, Core::Cylinder(_) | Core::Cone(_));
                assert!(excess >= -1.0e-9, "{}", says());
                assert!(is_curved || excess <= 1.0e-9, "{}", says());
            }
        }
    }
    assert!(apart > 100_000 && deep > 40_000, "{apart} {deep}");
}

/// "A point on the triangle is parted from it along the triangle's normal": a ball whose centre is
/// in a face comes out on the front.
#[test]
fn a_centre_on_the_triangle_comes_out_in_front() {
    let mut rng = Rng(1);
    for _ in 0..1000 {
        let [a, b, c] = [0; 3].map(|_| DVec3::from_array([0; 3].map(|_| rng.below(9) as f64)));
        let front = (b - a).cross(c - a);
        if front == DVec3::ZERO {
            continue;
        }
        let centre = (a + b + 2.0 * c) * 0.25;
        let contact = round_contact(&[a, b, c], &PointSupport(centre), 0.5, 0.0).unwrap();
        assert!((contact.distance + 0.5).abs() < 1.0e-14, "{contact:?}");
        assert!(contact.normal.dot(front.normalize()) > 1.0 - 1.0e-12, "{contact:?}");
    }
}

/// Whole coordinates and shapes along the axes: boxes and half-spaces have contacts without any
/// rounding, segments to the last digits.
#[test]
fn whole_coordinates_are_exact() {
    let mut rng = Rng(2);
    let (mut apart, mut deep) = (0, 0);
    for _ in 0..20_000 {
        // A triangle across an axis over or in a box, large enough to cover it.
        let half = DVec3::from_array([0; 3].map(|_| 1.0 + rng.below(4) as f64));
        let (axis, sign) = (rng.below(3) as usize, 1.0 - 2.0 * rng.below(2) as f64);
        let height = half[axis] + rng.below(5) as f64 - 1.0;
        if height == 0.0 {
            // As deep on either side.
            continue;
        }
        let mut corner = |u: f64, v: f64| {
            let mut corner = DVec3::ZERO;
            corner[axis] = sign * height;
            corner[(axis + 1) % 3] = u - rng.below(3) as f64;
            corner[(axis + 2) % 3] = v - rng.below(3) as f64;
            corner
        };
        let triangle = [corner(-20.0, -20.0), corner(30.0, -20.0), corner(-20.0, 30.0)];
        let distance = height - half[axis];
        let mut inward = DVec3::ZERO;
        inward[axis] = -sign;
        let box_contact = convex_contact(&triangle, &CuboidSupport(half), 20.0).unwrap();
        assert_eq!(box_contact.distance, distance, "{triangle:?} {half:?}");
        assert!((box_contact.normal - inward).length() == 0.0, "{box_contact:?}");
        let up = DVec3::AXES[axis] * half[axis];
        let segment = SegmentSupport([up, -up]);
        let contact = round_contact(&triangle, &segment, 0.5, 20.0).unwrap();
        assert!((contact.distance - (distance - 0.5)).abs() < 1.0e-14, "{contact:?}");
        let below = half_space_contact(&triangle, -inward, 20.0).unwrap();
        assert_eq!((below.distance, below.normal), (height, inward));
        apart += u32::from(distance > 0.0);
        deep += u32::from(distance < 0.0);
    }
    assert!(apart > 5000 && deep > 2000, "{apart} {deep}");
}

/// The lowest corner, and none beyond the margin or where a number is none.
#[test]
fn half_spaces() {
    let mut rng = Rng(3);
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

/// Boxes without extent along one, two or all axes are rectangles, segments and a point.
#[test]
fn flat_boxes() {
    let mut rng = Rng(4);
    for i in 0..20_000 {
        let mut half = DVec3::from_array([0; 3].map(|_| rng.scale(0.05, 1.0)));
        for axis in 0..=(i % 3) {
            half[(i / 3 + axis) % 3] = 0.0;
        }
        let shape = Shape { core: Core::Cuboid(half), radius: 0.0 };
        let gap = rng.within(-0.3, 0.1);
        let triangle = rng.triangle_beside(&shape, gap);
        let truth = shape.truth().distance(&triangle);
        let contact = shape.contact(&triangle, 100.0).unwrap();
        let size = size(&triangle, &shape);
        assert!((contact.distance - truth).abs() <= 1.0e-9 * size, "{truth} {contact:?}");
        check(&triangle, &shape, &contact, 1.0e-9 * size);
    }
}
