//! Cases where generators of contacts go wrong, each with its reason.

use super::check::{Triangle, check, size};
use super::strategies::{decades, flat_triangle, point, rotation, triangle};
use glamx::{DQuat, DVec2, DVec3};
use proptest::prelude::*;
use sbbk_core::contact::{contact, contact_from};
use sbbk_core::truth;

fn moved(t: Triangle, rotation: DQuat, offset: DVec3) -> Triangle {
    t.map(|v| rotation * v + offset)
}

/// Degrees between two lines.
fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b).abs()).to_degrees()
}

/// How far two triangles in the plane z = 0 reach into each other, negative when apart.
fn in_plane_overlap(t1: &Triangle, t2: &Triangle) -> f64 {
    let axes = [t1, t2].into_iter().flat_map(|t| (0..3).map(|i| t[(i + 1) % 3] - t[i]));
    let gaps = axes
        .map(|e| e.cross(DVec3::Z).normalize())
        .flat_map(|n| [truth::separation(t1, t2, n), truth::separation(t1, t2, -n)]);
    -gaps.fold(f64::NEG_INFINITY, f64::max)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(5000))]

    /// In one plane all products of two edges are parallel to the normal, so that the eleven axes
    /// say "touching" although the triangles may be far apart. Overlapping ones have depth 0
    /// along the normal.
    #[test]
    fn one_plane(t1 in flat_triangle(), t2 in flat_triangle(), apart in 0.0..2.0, r in rotation(), offset in point()) {
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

    /// Parallel sheets: vertices, edges and faces all tie at the distance of the planes, and the
    /// closest points may be a crossing of edges only.
    #[test]
    fn parallel_sheets(t1 in flat_triangle(), t2 in flat_triangle(), gap in decades(-9.0, 0.0), r in rotation()) {
        let t2 = t2.map(|v| v + DVec3::Z * gap);
        check(&t1, &t2);
        check(&moved(t1, r, DVec3::ZERO), &moved(t2, r, DVec3::ZERO));
    }

    /// Between nearly parallel planes or edges the products of edges lose digits: at 1e-7 rad they
    /// keep nine.
    #[test]
    fn small_angles(t1 in flat_triangle(), t2 in flat_triangle(), tilt in decades(-7.0, -2.0), about in point(), gap in decades(-9.0, 0.0)) {
        let tilted = DQuat::from_axis_angle(about.normalize_or(DVec3::X), tilt);
        check(&t1, &moved(t2, tilted, DVec3::Z * gap));
        // The same triangle twice, slightly turned: three pairs of nearly parallel edges.
        check(&t1, &moved(t1, tilted, DVec3::Z * gap));
        check(&t1, &moved(t1, tilted, about * gap));
    }

    /// Needles and caps, a million times longer than wide: their normals hang on the last digits.
    #[test]
    fn needles(t1 in triangle(), t2 in triangle(), at in prop::array::uniform2(-0.1..1.1), r in rotation(), offset in point(), width in decades(-6.0, -3.0)) {
        let thin = |long: f64, at: f64| [DVec3::ZERO, DVec3::X * long, DVec3::new(long * at, width, 0.0)];
        let (n1, n2) = (thin(1.0, at[0]), thin(1.0, at[1]));
        check(&n1, &t2.map(|v| v + offset));
        check(&n1, &moved(n2, r, offset * 0.5));
        check(&n1, &moved(n2, DQuat::from_rotation_z(width), DVec3::Z * width));
        check(&moved(n1, r, offset), &t1);
    }

    /// Segments and points have no normal; a division by their area gives NaN.
    #[test]
    fn without_area(t1 in triangle(), t2 in triangle(), at in 0.0..1.0, offset in point()) {
        let t2 = t2.map(|v| v + offset);
        for flat1 in flattened(&t1, at) {
            check(&flat1, &t2);
            for flat2 in flattened(&t2, at) {
                check(&flat1, &flat2);
                check(&flat1, &flat2.map(|v| v - flat2[0] + flat1[0]));
            }
        }
    }

    /// Triangles of one mesh: they touch, at no depth, in a vertex or an edge.
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

    /// A vertex or edge exactly, or nearly, on the other triangle.
    #[test]
    fn touching(t in triangle(), u in triangle(), at in prop::array::uniform2(0.0..0.5), nearly in decades(-18.0, -10.0)) {
        let inside = t[0] + (t[1] - t[0]) * at[0] + (t[2] - t[0]) * at[1];
        let border = t[0] + (t[1] - t[0]) * at[0];
        for contact_point in [inside, border] {
            check(&t, &[contact_point, u[1], u[2]]);
            check(&t, &[contact_point, u[1], u[2]].map(|v| v + u[0] * nearly));
            // An edge through the point.
            check(&t, &[contact_point + u[0], contact_point - u[0], u[2]]);
        }
    }

    /// Pushed through each other at their centres, where the depth is large and several axes are
    /// nearly as good.
    #[test]
    fn deep(t in triangle(), u in triangle(), off in point()) {
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

/// One bad coordinate anywhere makes no contact, and no panic.
#[test]
fn not_finite() {
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

/// Coordinates up to the limits of f32 neither overflow nor underflow.
#[test]
fn limits_of_f32() {
    for scale in [1.0e-37, 1.0e37] {
        let t = [DVec3::ZERO, DVec3::X, DVec3::Y].map(|v| v * scale);
        let over = t.map(|v| v + DVec3::new(0.2, 0.1, 0.5) * scale);
        let found = contact(&t, &over, f64::INFINITY).expect("finite");
        assert!((found.distance / scale - 0.5).abs() < 1.0e-12);
        assert_eq!(found.normal, DVec3::Z);
        let through =
            [DVec3::new(0.2, 0.2, -0.1), DVec3::new(0.2, 0.3, 1.0), DVec3::new(0.3, 0.2, 1.0)];
        let found = contact(&t, &through.map(|v| v * scale), f64::INFINITY).expect("finite");
        assert!((found.distance / scale + 0.1).abs() < 1.0e-12, "{found:?}");
    }
}

/// "`distance <= margin` counts".
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

/// Poses at exact multiples of 90 degrees, and the same with the rounding of f32 rotations, make
/// edges parallel to edges and faces, or nearly so: every axis ties with others.
#[test]
fn right_angles() {
    let corner = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let turns = [0.0, 1.0, 2.0, 3.0].map(|q| q * std::f64::consts::FRAC_PI_2);
    let offsets = [DVec2::ZERO, DVec2::new(0.5, 0.0), DVec2::new(0.25, 0.25), DVec2::new(1.0, 0.0)];
    for (a, b) in turns.iter().flat_map(|&a| turns.map(|b| (a, b))) {
        let exact = DQuat::from_rotation_x(a) * DQuat::from_rotation_z(b);
        let rounded = exact.as_quat().as_dquat();
        for (at, height) in offsets.iter().flat_map(|&o| [0.0, 1.0e-3, -1.0e-3].map(|h| (o, h))) {
            for rotation in [exact, rounded, exact.normalize()] {
                let other = moved(corner, rotation, at.extend(height));
                check(&corner, &other);
                check(&other, &corner);
                assert!(size(&other) > 1.0);
            }
        }
    }
}

/// A segment with a corner in its midst that crosses the end of a needle. Would catch points that are not
/// opposite each other, as the two parts of the segment have one direction.
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
