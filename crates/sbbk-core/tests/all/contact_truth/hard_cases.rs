//! Cases where generators of contacts go wrong, each with its reason.

use super::check::{Triangle, check, decades, flat_triangle, point, rotation, triangle};
use crate::prelude::*;
use proptest::prelude::*;
use sbbk_core::contact::{contact, contact_from};
use sbbk_truth as truth;

fn moved(t: Triangle, rotation: DQuat, offset: DVec3) -> Triangle {
    t.map(|v| rotation * v + offset)
}

/// Degrees between two lines.
fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b).abs()).to_degrees()
}

/// Depth of the overlap of two triangles in the plane z = 0, negative if apart.
fn in_plane_overlap(t1: &Triangle, t2: &Triangle) -> f64 {
    let axes = [t1, t2].into_iter().flat_map(|t| (0..3).map(|i| t[(i + 1) % 3] - t[i]));
    let gaps = axes
        .map(|e| e.cross(DVec3::Z).normalize())
        .flat_map(|n| [truth::separation(t1, t2, n), truth::separation(t1, t2, -n)]);
    -gaps.fold(f64::NEG_INFINITY, f64::max)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(5000))]

    #[test]
    fn triangles_in_one_plane(t1 in flat_triangle(), t2 in flat_triangle(), apart in 0.0..2.0, r in rotation(), offset in point()) {
        let t2 = t2.map(|v| v + DVec3::X * apart);
        let truth = check(&moved(t1, r, offset), &moved(t2, r, offset));
        check(&t1, &t2);
        if truth.distance < 1.0e-12 {
            let found = contact(&t1, &t2, 1.0e-9).unwrap();
            let axis = found.normal;
            // A pair that overlaps by nearly nothing may as well be parted in the plane.
            let overlap = in_plane_overlap(&t1, &t2);
            prop_assert!(overlap < 1.0e-8 || angle(axis, DVec3::Z) < 0.1, "{axis} {overlap:e}");
        }
    }

    #[test]
    fn parallel_sheets(t1 in flat_triangle(), t2 in flat_triangle(), gap in decades(-9.0, 0.0), r in rotation()) {
        let t2 = t2.map(|v| v + DVec3::Z * gap);
        check(&t1, &t2);
        check(&moved(t1, r, DVec3::ZERO), &moved(t2, r, DVec3::ZERO));
    }

    #[test]
    fn nearly_parallel_edges_and_faces(t1 in flat_triangle(), t2 in flat_triangle(), tilt in decades(-7.0, -2.0), about in point(), gap in decades(-9.0, 0.0)) {
        let tilted = DQuat::from_axis_angle(about.normalize_or(DVec3::X), tilt);
        check(&t1, &moved(t2, tilted, DVec3::Z * gap));
        // A slightly turned copy has three pairs of nearly parallel edges.
        check(&t1, &moved(t1, tilted, DVec3::Z * gap));
        check(&t1, &moved(t1, tilted, about * gap));
    }

    #[test]
    fn needles(t1 in triangle(), t2 in triangle(), at in prop::array::uniform2(-0.1..1.1), r in rotation(), offset in point(), width in decades(-6.0, -3.0)) {
        let thin = |long: f64, at: f64| [DVec3::ZERO, DVec3::X * long, DVec3::new(long * at, width, 0.0)];
        let (n1, n2) = (thin(1.0, at[0]), thin(1.0, at[1]));
        check(&n1, &t2.map(|v| v + offset));
        check(&n1, &moved(n2, r, offset * 0.5));
        check(&n1, &moved(n2, DQuat::from_rotation_z(width), DVec3::Z * width));
        check(&moved(n1, r, offset), &t1);
    }

    #[test]
    fn triangles_without_area(t1 in triangle(), t2 in triangle(), at in 0.0..1.0, offset in point()) {
        let t2 = t2.map(|v| v + offset);
        for flat1 in flattened(&t1, at) {
            check(&flat1, &t2);
            for flat2 in flattened(&t2, at) {
                check(&flat1, &flat2);
                check(&flat1, &flat2.map(|v| v - flat2[0] + flat1[0]));
            }
        }
    }

    #[test]
    fn shared_vertices_and_edges(t in triangle(), u in triangle()) {
        for i in 0..3 {
            check(&t, &[u[0], t[i], u[1]]);
            check(&t, &[t[i], t[(i + 1) % 3], u[2]]);
            check(&t, &[t[(i + 1) % 3], u[2], t[i]]);
        }
        check(&t, &t);
        check(&t, &[t[2], t[0], t[1]]);
    }

    #[test]
    fn vertices_and_edges_that_touch(t in triangle(), u in triangle(), at in prop::array::uniform2(0.0..0.5), nearly in decades(-18.0, -10.0)) {
        let inside = t[0] + (t[1] - t[0]) * at[0] + (t[2] - t[0]) * at[1];
        let border = t[0] + (t[1] - t[0]) * at[0];
        for contact_point in [inside, border] {
            check(&t, &[contact_point, u[1], u[2]]);
            check(&t, &[contact_point, u[1], u[2]].map(|v| v + u[0] * nearly));
            // An edge through the point.
            check(&t, &[contact_point + u[0], contact_point - u[0], u[2]]);
        }
    }

    #[test]
    fn deep_triangles(t in triangle(), u in triangle(), off in point()) {
        let centred = |t: Triangle| t.map(|v| v - (t[0] + t[1] + t[2]) / 3.0);
        check(&centred(t), &centred(u).map(|v| v + off * 1.0e-3));
        check(&centred(t), &centred(u));
    }
}

/// The segment and the point that a triangle shrinks to.
fn flattened(t: &Triangle, at: f64) -> [Triangle; 4] {
    let between = t[0] + (t[1] - t[0]) * at;
    [[t[0], t[1], between], [t[0], t[0], t[1]], [t[0], t[1], t[0]], [t[0]; 3]]
}

#[test]
fn non_finite_coordinates_have_no_contact() {
    let t = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let over = t.map(|v| v + DVec3::Z * 0.1);
    let found = contact(&t, &over, 0.2).expect("finite triangles meet");
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for (vertex, axis) in (0..3).flat_map(|v| (0..3).map(move |a| (v, a))) {
            let mut broken = t;
            broken[vertex][axis] = bad;
            for (t1, t2) in [(broken, over), (over, broken), (broken, broken)] {
                assert_eq!(contact(&t1, &t2, f64::INFINITY), None);
                assert_eq!(contact_from(&t1, &t2, f64::INFINITY, found.features), None);
            }
        }
        let all = [DVec3::splat(bad); 3];
        assert_eq!(contact(&all, &t, f64::INFINITY), None);
    }
    assert_eq!(contact(&t, &over, f64::NAN), None);
}

#[test]
fn the_margin_is_inclusive() {
    let t = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let over = t.map(|v| v + DVec3::Z * 0.25);
    assert!(contact(&t, &over, 0.25).is_some());
    assert!(contact(&t, &over, 0.25_f64.next_down()).is_none());
    let beside = t.map(|v| v + DVec3::X * 1.5);
    assert!(contact(&t, &beside, 0.5).is_some());
    assert!(contact(&t, &beside, 0.5_f64.next_down()).is_none());
}

#[test]
fn a_segment_with_a_corner_in_its_midst() {
    let needle = [
        DVec3::new(-1.75, 1.625, -1.5),
        DVec3::new(-1.5, -1.5, 1.5),
        DVec3::new(-1.750091563910246, 1.6249084621667862, -1.5000915378332138),
    ];
    let segment = [
        DVec3::new(-1.750091552734375, 1.624908447265625, -1.500091552734375),
        DVec3::new(-1.749114990234375, 1.626129150390625, -1.498504638671875),
        DVec3::new(-1.749359130859375, 1.625823974609375, -1.4989013671875),
    ];
    check(&needle, &segment);
    check(&segment, &needle);
}
