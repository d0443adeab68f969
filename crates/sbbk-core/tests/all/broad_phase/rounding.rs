//! The pair decision in `f32` against real arithmetic, for which `f64` stands in.

use super::model::between;
use glamx::{DVec3, Vec3};
use proptest::prelude::*;
use sbbk_core::broad_phase::Bounds;

/// Relative error of the `f64` computations below; far under that of `f32`.
const REFERENCE_ERROR: f64 = 1e-14;

/// A box that overlaps every other one.
fn sphere(centre: Vec3, radius: f32) -> Bounds {
    Bounds { centre, radius, min: Vec3::MIN, max: Vec3::MAX }
}

/// A sphere that overlaps every other one.
fn aabb(min: Vec3, max: Vec3) -> Bounds {
    Bounds { centre: Vec3::ZERO, radius: f32::MAX, min, max }
}

fn distance_and_reach(bounds: &[Bounds; 2], margin: f32) -> [f64; 2] {
    let [centre1, centre2]: [DVec3; 2] = bounds.map(|b| b.centre.as_dvec3());
    let reach = f64::from(bounds[0].radius) + f64::from(bounds[1].radius) + f64::from(margin);
    [centre1.distance(centre2), reach]
}

/// Two spheres at a distance of `ulps` times 2⁻²⁴ of their reach from touching, before the
/// centres are rounded.
fn nearly_touching() -> impl Strategy<Value = ([Bounds; 2], f32)> {
    let direction = prop::array::uniform3(between(-1.0, 1.0))
        .prop_map(Vec3::from_array)
        .prop_filter_map("direction too short", |v| (v.length() > 0.1).then(|| v.normalize()));
    let radii = (prop::array::uniform2(between(0.0, 1.0)), between(0.0, 0.3));
    let offset = prop_oneof![Just(0.0), between(-1.0, 1.0), Just(1e6)];
    (direction, radii, offset, -40..40, -30..30).prop_map(
        |(direction, ([radius1, radius2], margin), offset, ulps, exponent)| {
            let scale = 2_f32.powi(exponent);
            let reach = f64::from(radius1) + f64::from(radius2) + f64::from(margin);
            let distance = reach * (1.0 + f64::from(ulps) * 2_f64.powi(-24));
            let centre1 = Vec3::splat(offset);
            let centre2 = centre1.as_dvec3() + distance * direction.as_dvec3();
            let spheres = [(centre1, radius1), (centre2.as_vec3(), radius2)];
            (spheres.map(|(c, r)| sphere(scale * c, scale * r)), scale * margin)
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    /// Catches a slack that is too small for the rounding of the sphere test, or so large that
    /// more pairs come through than the documentation of `is_pair_with` says.
    #[test]
    fn spheres_within_the_margin_are_pairs_and_others_hardly(
        (spheres, margin) in nearly_touching()
    ) {
        let [distance, reach] = distance_and_reach(&spheres, margin);
        let is_pair = spheres[0].is_pair_with(&spheres[1], margin);
        prop_assert_eq!(is_pair, spheres[1].is_pair_with(&spheres[0], margin));
        if distance <= reach * (1.0 - REFERENCE_ERROR) {
            prop_assert!(is_pair, "missed: distance {distance:e}, reach {reach:e}");
        }
        if distance > reach * (1.0 + 2_f64.powi(-20) + REFERENCE_ERROR) {
            prop_assert!(!is_pair, "too far: distance {distance:e}, reach {reach:e}");
        }
    }

    /// Catches a box test that misses pairs by rounding, or lets gaps through that are more than
    /// the rounding of one sum beyond the margin.
    #[test]
    fn boxes_within_the_margin_are_pairs_and_others_hardly(
        lower_end in between(-1e5, 1e5),
        margin in between(0.01, 10.0),
        ulps in -3..=3,
        axis in 0..3_usize,
    ) {
        // Integer arithmetic on the bits: a few floats up or down from the sum.
        let upper_start = f32::from_bits((lower_end + margin).to_bits().wrapping_add_signed(ulps));
        let mut boxes = [aabb(-Vec3::MAX, Vec3::MAX); 2];
        boxes[0].max[axis] = lower_end;
        boxes[1].min[axis] = upper_start;
        let excess = f64::from(upper_start) - f64::from(lower_end) - f64::from(margin);
        let is_pair = boxes[0].is_pair_with(&boxes[1], margin);
        prop_assert_eq!(is_pair, boxes[1].is_pair_with(&boxes[0], margin));
        if excess <= 0.0 {
            prop_assert!(is_pair);
        }
        if excess > f64::from(upper_start.abs().max(0.01)) * 2_f64.powi(-24) {
            prop_assert!(!is_pair);
        }
    }
}

/// Guards the two tests above against vacuity: without its slack the sphere test would miss pairs
/// of this kind, and some spheres come through only because of it.
#[test]
fn the_slack_is_needed_and_used() {
    let mut missed_without_slack = 0;
    let mut let_through = 0;
    for step in 0..2000 {
        let angle = 0.001 * f64::from(step);
        let direction = DVec3::new(angle.cos(), 0.6 * angle.sin(), 0.8 * angle.sin());
        for ulps in -4..=4 {
            let [radius1, radius2] = [0.3 + 0.0001 * step as f32, 0.7];
            let reach = f64::from(radius1) + f64::from(radius2);
            let distance = reach * (1.0 + f64::from(ulps) * 2_f64.powi(-24));
            let centre2 = (distance * direction).as_vec3();
            let spheres = [sphere(Vec3::ZERO, radius1), sphere(centre2, radius2)];
            let [distance, reach] = distance_and_reach(&spheres, 0.0);
            let passes_bare = centre2.length_squared() <= (radius1 + radius2) * (radius1 + radius2);
            missed_without_slack += usize::from(distance <= reach && !passes_bare);
            let is_pair = spheres[0].is_pair_with(&spheres[1], 0.0);
            let_through += usize::from(distance > reach && is_pair);
        }
    }
    assert!(missed_without_slack > 100, "{missed_without_slack}");
    assert!(let_through > 100, "{let_through}");
}

/// Catches pairs missed by underflow of the squares, and a slack for it that is visible.
#[test]
fn tiny_spheres_that_touch_are_pairs() {
    let tiny = f32::from_bits(1);
    for units in [1.0, 2.0, 1000.0] {
        let centre2 = Vec3::new(0.0, 3.0 * units * tiny, 0.0);
        let spheres = [sphere(Vec3::ZERO, units * tiny), sphere(centre2, units * tiny)];
        assert!(spheres[0].is_pair_with(&spheres[1], units * tiny));
    }
    // The three squares round up to the smallest float, that of the reach from 1.5 to 2 of them.
    let corner = sphere(Vec3::splat(2.68e-23), 4.65e-23);
    let spheres = [corner, sphere(Vec3::ZERO, 0.0)];
    let [distance, reach] = distance_and_reach(&spheres, 0.0);
    assert!(distance < reach && spheres[0].is_pair_with(&spheres[1], 0.0));

    let visible = sphere(Vec3::new(2e-19, 0.0, 0.0), 0.0);
    assert!(!visible.is_pair_with(&sphere(Vec3::ZERO, 0.0), 0.0));
}

/// Catches overflow that turns into NaN, and with it a pair that is missed, or into a pair of
/// everything with everything.
#[test]
fn largest_spheres_and_boxes_do_not_overflow_into_wrong_answers() {
    let far = Vec3::new(3e38, 0.0, 0.0);
    let [left, right] = [-far, far].map(|centre| sphere(centre, f32::MAX));
    assert!(left.is_pair_with(&right, f32::MAX));
    assert!(left.is_pair_with(&right, 0.0));
    let [left, right] = [-far, far].map(|centre| sphere(centre, 1.0));
    assert!(!left.is_pair_with(&right, 1.0));

    let [left, right] = [-far, far].map(|corner| aabb(corner, corner));
    assert!(!left.is_pair_with(&right, 1e38));
    let near_right = aabb(far * 0.9, far * 0.9);
    assert!(near_right.is_pair_with(&right, f32::MAX));
}
