//! Shapes and triangles without volume or area, and invalid numbers.

use super::shape::{Core, Kind, Shape, first_farthest};
use super::truth::{check, size};
use crate::prelude::*;
use sbbk_core::contact::convex::{
    ConeSupport, CuboidSupport, CylinderSupport, HullPoints, PointSupport, SegmentSupport,
    SupportMap, convex_contact,
};

#[test]
fn triangles_without_area_have_exact_distances() {
    for kind in Kind::POLYTOPES {
        let mut rng = Random(40 + kind as u64);
        for i in 0..2000 {
            let shape = rng.shape(kind);
            let [a, b, c] = {
                let gap = rng.within(-0.3, 0.1);
                rng.triangle_beside(&shape, gap)
            };
            let middle = a.lerp(b, rng.within(-0.2, 1.2));
            let triangle = match i % 5 {
                0 => [a; 3],
                1 => [a, b, a],
                2 => [a, b, b],
                3 => [a, b, middle],
                _ => [a, b, middle + (c - a) * rng.scale(1.0e-16, 1.0e-6)],
            };
            check_distance(&triangle, &shape);
        }
    }
}

#[test]
fn flat_round_shapes_on_a_lattice_agree_with_the_search() {
    let mut rng = Random(51);
    let mut far = 0;
    for i in 0..20_000 {
        let half_height = (i % 2) as f64 * 0.5;
        let radius = (i / 2 % 2) as f64;
        let core = if i / 4 % 2 == 0 {
            Core::Cylinder(CylinderSupport { half_height, radius })
        } else {
            Core::Cone(ConeSupport { half_height, radius })
        };
        let shape = Shape { core, radius: 0.0 };
        let mut corner = || DVec3::from_array([0; 3].map(|_| rng.below(5) as f64 - 2.0));
        let mut triangle = [corner(), corner(), corner()];
        if i % 5 == 0 {
            // On the axis, or along it.
            let aside = DVec3::new(0.1, 0.0, 0.2) * (i / 8 % 4) as f64;
            triangle = triangle.map(|corner| aside + DVec3::Y * 0.25 * corner.y);
        }
        let contact = shape.contact(&triangle, 100.0).unwrap();
        let searched = convex_contact(&triangle, &|d| shape.support(d), 100.0).unwrap();
        let says = || format!("{contact:?} {searched:?}\n{shape:?}\n{triangle:?}");
        // The search may serve ties, with depths to 1e-5 of themselves.
        assert!(contact.distance >= searched.distance - 1.0e-5, "{}", says());
        check(&triangle, &shape, &contact, 1.0e-5);
        far += u32::from(contact.distance > 0.5);
    }
    assert!(far > 2000, "{far}");
}

#[test]
fn degenerate_pairs_found_by_fuzzing_have_contacts() {
    let end = DVec3::new(1.7500000223517418, 1.749999975785613, 1.7499999832361937);
    let tip = DVec3::new(-2.0000038146972656, -1.9999980926513672, -1.9999980926513672);
    let needle = [DVec3::splat(-0.5), DVec3::ONE, tip];
    let corners =
        [[-0.125, 1.0, 1.0], [1.0; 3], [-2.0, 1.0, 1.0], [-0.25, -1.875, -2.0], [-2.0; 3]];
    let beside_tip = Core::Point(DVec3::splat(-2.0));
    let cases = [
        // A segment that runs through a needle.
        (
            [
                DVec3::new(-2.0, -2.0, -1.875),
                DVec3::new(-2.0000000027939677, -2.0000000074505806, -2.0000000069849193),
                DVec3::new(-1.8750000037252903, -1.8749999976716936, -1.875000003259629),
            ],
            Core::Triangle([end, DVec3::splat(-2.0), DVec3::splat(-2.0)]),
            1.625,
        ),
        // A point beside the tip of a needle, equally near to its long edges.
        (needle, beside_tip.clone(), 1.0),
        ([needle[1], needle[2], needle[0]], beside_tip.clone(), 1.0),
        ([needle[2], needle[0], needle[1]], beside_tip, 1.0),
        // A triangle on a face of a flat hull.
        (
            [
                DVec3::ONE,
                DVec3::new(1.0, -6.984919309616089e-9, -7.450580596923828e-9),
                DVec3::new(2.384185791015625e-7, 2.682209014892578e-7, 2.682209014892578e-7),
            ],
            Core::Hull(corners.map(DVec3::from).into()),
            0.625,
        ),
    ];
    for (triangle, core, radius) in cases {
        let shape = Shape { core, radius };
        let size = size(&triangle, &shape);
        let contact = shape.contact(&triangle, 100.0).unwrap();
        check(&triangle, &shape, &contact, 1.0e-9 * size);
        let is_hull = matches!(shape.core, Core::Hull(_));
        assert!(!is_hull || (contact.distance + radius).abs() < 1.0e-9 * size, "{contact:?}");
    }
}

#[test]
fn points_in_one_place_touch() {
    for p in [DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0)] {
        let contact = convex_contact(&[p; 3], &PointSupport(p), 0.0).unwrap();
        assert_eq!((contact.distance, contact.normal.length()), (0.0, 1.0));
        assert_eq!(contact.on_triangle, p);
    }
}

#[test]
fn non_finite_input_has_no_contact() {
    let floor = [DVec3::ZERO, DVec3::X, DVec3::Z];
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for i in 0..9 {
            let mut triangle = floor;
            triangle[i / 3][i % 3] = bad;
            for margin in [0.1, f64::INFINITY] {
                assert_eq!(convex_contact(&triangle, &CuboidSupport(DVec3::ONE), margin), None);
            }
        }
        for half in [DVec3::new(bad, 1.0, 1.0), DVec3::splat(bad)] {
            assert_eq!(convex_contact(&floor, &CuboidSupport(half), 0.1), None);
        }
        for radius in [bad, 1.0] {
            let cylinder = CylinderSupport { half_height: bad, radius };
            assert_eq!(convex_contact(&floor, &cylinder, 0.1), None);
            let cone = ConeSupport { half_height: 1.0, radius: bad };
            assert_eq!(convex_contact(&floor, &cone, 0.1), None);
        }
    }
    let cuboid = CuboidSupport(DVec3::ONE);
    assert_eq!(convex_contact(&floor, &cuboid, f64::NAN), None);
    assert_eq!(convex_contact(&floor, &|_| DVec3::NAN, 0.1), None);
}

#[test]
fn invalid_support_maps_neither_panic_nor_hang() {
    for seed in 0..5000 {
        let state = std::cell::RefCell::new(Random(seed));
        let liar = |_: DVec3| {
            let mut rng = state.borrow_mut();
            match rng.below(40) {
                0 => DVec3::NAN,
                1 => DVec3::INFINITY,
                2 => DVec3::ZERO,
                _ => rng.point(),
            }
        };
        convex_contact(&[DVec3::ZERO, DVec3::X * 0.1, DVec3::Z * 0.1], &liar, 1.0);
    }
}

#[test]
fn shapes_without_size_are_points_and_huge_triangles_have_finite_contacts() {
    let triangle = [[-1.0, 0.3, -1.0], [2.0, 0.4, -1.0], [0.0, 0.5, 2.0]].map(DVec3::from_array);
    let point = convex_contact(&triangle, &PointSupport(DVec3::ZERO), 1.0).expect("it is near");
    let (half_height, radius) = (0.0, 0.0);
    let cone = convex_contact(&triangle, &ConeSupport { half_height, radius }, 1.0);
    let cylinder = convex_contact(&triangle, &CylinderSupport { half_height, radius }, 1.0);
    for contact in [cone, cylinder] {
        let contact = contact.expect("it is near");
        assert!((contact.distance - point.distance).abs() < 1e-12, "{contact:?}");
    }
    for size in [1e80, 1e160, 1e300] {
        let huge = triangle.map(|corner| corner * size);
        let segment = SegmentSupport([-DVec3::ONE, DVec3::X]);
        for contact in [
            convex_contact(&huge, &segment, f64::INFINITY),
            convex_contact(&huge, &PointSupport(DVec3::ONE), f64::INFINITY),
            convex_contact(&huge, &CuboidSupport(DVec3::ONE), f64::INFINITY),
            convex_contact(&huge, &ConeSupport { half_height: 1.0, radius: 1.0 }, f64::INFINITY),
        ] {
            let is_somewhere = contact.is_none_or(|c| (c.on_shape + c.normal).is_finite());
            assert!(is_somewhere, "{contact:?}");
        }
    }
}

#[test]
fn support_points_of_hulls_are_the_first_of_the_farthest() {
    let mut random = Random(9);
    for i in 0..4000 {
        let lattice = Vec3::from_array([0; 3].map(|_| (random.bits() % 3) as f32 - 1.0));
        let (is_lattice, unit) = (i % 2 == 0, [1.0, 1e-42][i / 2 % 2]);
        let direction = if is_lattice { lattice } else { random.vector(1.0).with_y(1.0) };
        if direction == Vec3::ZERO {
            continue;
        }
        let mut point = || {
            if is_lattice {
                return unit * Vec3::from_array([0; 3].map(|_| (random.bits() % 3) as f32));
            }
            let at = random.vector(100.0);
            unit * at.with_y(1.0 - direction.x * at.x - direction.z * at.z)
        };
        let points: Vec<Vec3> = (0..30).map(|_| point()).collect();
        let wide: Vec<DVec3> = points.iter().map(|point| point.as_dvec3()).collect();
        let expected = first_farthest(&wide, direction.as_dvec3());
        let found = HullPoints::new(points).support(direction.as_dvec3());
        assert_eq!(found, expected, "along {direction}");
    }
}

#[test]
fn edges_in_the_plane_of_a_rim_agree_with_the_search() {
    let mut random = Random(12);
    let cone = ConeSupport { half_height: 0.5, radius: 1.0 };
    let mut crossing = 0;
    for _ in 0..1000 {
        let [a, b, c] = [(); 3].map(|()| random.vector(1.5).as_dvec3());
        let triangle = [a.with_y(-0.5), b.with_y(-0.5), c];
        let found = convex_contact(&triangle, &cone, 1.0);
        let expected = convex_contact(&triangle, &|way: DVec3| cone.support(way), 1.0);
        let [found, expected] = [found, expected].map(|c| c.map_or(1.0, |c| c.distance));
        assert!((found - expected).abs() < 1e-5, "{found} {expected} {triangle:?}");
        crossing += usize::from(found < -1e-3);
    }
    assert!(crossing > 100, "{crossing}");
}

/// Checks a contact and compares its distance with brute force.
fn check_distance(triangle: &[DVec3; 3], shape: &Shape) {
    let tolerance = 1.0e-9 * size(triangle, shape);
    let contact = shape.contact(triangle, 100.0).unwrap();
    let error = (contact.distance - shape.truth().distance(triangle)).abs();
    assert!(error <= tolerance, "{error:e} {contact:?}\n{shape:?}\n{triangle:?}");
    check(triangle, shape, &contact, tolerance);
}
