//! The broad phase against brute force, and its test in f32 against real arithmetic.

use std::f32::consts::TAU;

use crate::support::Random;
use glamx::{DVec3, Vec3};
use proptest::prelude::*;
use sbbk_core::broad_phase::{Bounds, BroadPhase};

/// A cube with a sphere that may be smaller or larger than it.
fn cube(centre: Vec3, half_extent: f32, radius: f32) -> Bounds {
    Bounds { centre, radius, min: centre - half_extent, max: centre + half_extent }
}

fn brute_force(objects: &[Bounds], margin: f32) -> Vec<[u32; 2]> {
    let mut pairs = Vec::new();
    for (i, one) in objects.iter().enumerate() {
        let partners = (i + 1..objects.len()).filter(|&j| one.is_pair_with(&objects[j], margin));
        pairs.extend(partners.map(|j| [i as u32, j as u32]));
    }
    pairs
}

fn sorted(pairs: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let mut pairs = pairs.to_vec();
    pairs.sort_unstable();
    pairs
}

/// Would catch strict comparisons, a margin on one of the two volumes only, and a skipped stage.
#[test]
fn lattices_that_touch_have_the_pairs_of_faces() {
    let lattice = |spacing: f32, radius: f32| -> Vec<Bounds> {
        let place = |i: usize| Vec3::from_array([i % 8, i / 8 % 8, i / 64].map(|x| x as f32));
        (0..512).map(|i| cube(spacing * place(i), 0.5, radius)).collect()
    };
    for (spacing, margin) in [(1.0, 0.0), (1.5, 0.5), (1.25, 0.25)] {
        let mut phase = BroadPhase::new(margin);
        assert_eq!(phase.pairs(&lattice(spacing, 0.5)).len(), 3 * 8 * 8 * 7);
        assert_eq!(phase.pairs(&lattice(spacing, 2.0)).len(), (22_usize.pow(3) - 512) / 2);
    }
    assert!(BroadPhase::new(0.499).pairs(&lattice(1.5, 0.5)).is_empty());
}

/// Would catch children numbered wrongly, boxes not refitted, a pair dropped or found twice, and
/// places far from the origin or all in one.
#[test]
fn worlds_in_motion_have_the_pairs_of_brute_force() {
    let mut random = Random(1);
    // Number of objects, moving one in this many, place, extent of the world, range of sizes.
    let worlds = [
        (2500, 1, 0.0, 9.0, 1.0),
        (1500, 20, 0.0, 8.0, 1.0),
        (700, 3, 1e6, 30.0, 1e3),
        (100, 2, 7.5, 0.0, 1.0),
        (1, 1, 0.0, 1.0, 1.0),
    ];
    for (count, moving_every, far, extent, sizes) in worlds {
        let mut phase = BroadPhase::new(0.02);
        let mut objects = Vec::new();
        let mut total = 0;
        for step in 0..12 {
            let count = if step < 10 { count } else { count / 2 };
            objects.truncate(count);
            for i in 0..count {
                if objects.len() == i {
                    let size = 0.5 * f32::powf(sizes, random.range(0.0, 1.0));
                    objects.push(cube(Vec3::splat(far) + random.vector(extent), size, size));
                } else if (i + step).is_multiple_of(moving_every) {
                    let Bounds { centre, radius, max, .. } = objects[i];
                    let moved = random.vector(if step == 5 { extent } else { 0.1 });
                    objects[i] = cube(centre + moved, (max - centre).x, radius);
                }
            }
            let expected = brute_force(&objects, 0.02);
            total += expected.len();
            assert_eq!(sorted(phase.pairs(&objects)), expected, "step {step} of {count}");
        }
        assert!(total > 3 * count || count == 1, "{total} pairs");
        assert!(phase.pairs(&[]).is_empty());
    }
}

#[test]
fn objects_that_are_not_finite_have_no_pairs() {
    let good = cube(Vec3::ZERO, 1.0, 1.0);
    let bad = cube(Vec3::new(f32::NAN, 0.0, 0.0), 1.0, 1.0);
    let objects = [good, bad, good, Bounds { radius: f32::NAN, ..good }];
    assert_eq!(BroadPhase::new(0.0).pairs(&objects), [[0, 2]]);
}

#[test]
fn steady_steps_allocate_nothing() {
    let mut random = Random(3);
    let circles: Vec<Vec3> = (0..1500).map(|_| random.vector(8.0)).collect();
    let mut phase = BroadPhase::new(0.02);
    let mut objects = Vec::with_capacity(circles.len());
    let mut play = || {
        let mut pairs = 0;
        for frame in 0..40 {
            objects.clear();
            objects.extend(circles.iter().enumerate().map(|(i, centre)| {
                let (sin, cos) = (TAU * (frame as f32 / 40.0 + 0.1 * i as f32)).sin_cos();
                cube(centre + 3.0 * Vec3::new(cos, sin, 0.0), 0.4, 0.5)
            }));
            pairs += phase.pairs(&objects).len();
        }
        pairs
    };
    assert!(allocation_counter::measure(|| assert!(play() > 10_000)).count_total > 0);
    play();
    let steady = allocation_counter::measure(|| {
        play();
    });
    assert_eq!(steady.count_total, 0);
}

/// A sphere in a box that overlaps every other one.
fn sphere(centre: Vec3, radius: f32) -> Bounds {
    Bounds { centre, radius, min: Vec3::MIN, max: Vec3::MAX }
}

/// A box in a sphere that overlaps every other one.
fn aabb(min: Vec3, max: Vec3) -> Bounds {
    Bounds { centre: Vec3::ZERO, radius: f32::MAX, min, max }
}

fn distance_and_reach(bounds: &[Bounds; 2], margin: f32) -> [f64; 2] {
    let [centre1, centre2]: [DVec3; 2] = bounds.map(|b| b.centre.as_dvec3());
    let reach = f64::from(bounds[0].radius) + f64::from(bounds[1].radius) + f64::from(margin);
    [centre1.distance(centre2), reach]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    /// Spheres a few units in the last place from touching. Would catch a slack that is too small
    /// for the rounding, or so large that more pairs come through than documented.
    #[test]
    fn spheres_within_the_margin_are_pairs(
        seed: u64, ulps in -40..40, exponent in -30..30, far in 0..3_usize,
    ) {
        let mut random = Random(seed);
        let direction = random.rotation() * Vec3::X;
        let radii = [random.range(0.0, 1.0), random.range(0.0, 1.0)];
        let margin = random.range(0.0, 0.3);
        let centre1 = Vec3::splat([0.0, random.range(-1.0, 1.0), 1e6][far]);
        let reach = f64::from(radii[0]) + f64::from(radii[1]) + f64::from(margin);
        let distance = reach * (1.0 + f64::from(ulps) * 2_f64.powi(-24));
        let centre2 = (centre1.as_dvec3() + distance * direction.as_dvec3()).as_vec3();
        let scale = 2_f32.powi(exponent);
        let spheres = [sphere(scale * centre1, scale * radii[0]),
            sphere(scale * centre2, scale * radii[1])];
        let margin = scale * margin;
        let [distance, reach] = distance_and_reach(&spheres, margin);
        let is_pair = spheres[0].is_pair_with(&spheres[1], margin);
        prop_assert_eq!(is_pair, spheres[1].is_pair_with(&spheres[0], margin));
        prop_assert_eq!(BroadPhase::new(margin).pairs(&spheres).len(), usize::from(is_pair));
        if distance <= reach * (1.0 - 1e-14) {
            prop_assert!(is_pair, "missed: distance {distance:e}, reach {reach:e}");
        }
        if distance > reach * (1.0 + 2_f64.powi(-20)) + 2_f64.powi(-62) {
            prop_assert!(!is_pair, "too far: distance {distance:e}, reach {reach:e}");
        }
    }

    /// Would catch a box test that misses pairs by rounding, or lets wider gaps through.
    #[test]
    fn boxes_within_the_margin_are_pairs(
        seed: u64, ulps in -3..=3, axis in 0..3_usize,
    ) {
        let mut random = Random(seed);
        let (lower_end, margin) = (random.range(-1e5, 1e5), random.range(0.01, 10.0));
        // A few floats up or down from the sum.
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

/// Would catch underflow of the squares that loses pairs, and overflow that pairs everything.
#[test]
fn tiny_and_huge_spheres_and_boxes_that_touch_are_pairs() {
    let tiny = f32::from_bits(1);
    for units in [1.0, 2.0, 1000.0] {
        let centre2 = Vec3::new(0.0, 3.0 * units * tiny, 0.0);
        let spheres = [sphere(Vec3::ZERO, units * tiny), sphere(centre2, units * tiny)];
        assert!(spheres[0].is_pair_with(&spheres[1], units * tiny));
    }
    // The squares round up to the smallest float, that of the reach from 1.5 to 2 of them.
    let spheres = [sphere(Vec3::splat(2.68e-23), 4.65e-23), sphere(Vec3::ZERO, 0.0)];
    let [distance, reach] = distance_and_reach(&spheres, 0.0);
    assert!(distance < reach && spheres[0].is_pair_with(&spheres[1], 0.0));
    let visible = sphere(Vec3::new(2e-19, 0.0, 0.0), 0.0);
    assert!(!visible.is_pair_with(&sphere(Vec3::ZERO, 0.0), 0.0));

    let far = Vec3::new(3e38, 0.0, 0.0);
    let spheres = |radius| [-far, far].map(|centre| sphere(centre, radius));
    let [left, right] = spheres(f32::MAX);
    assert!(left.is_pair_with(&right, f32::MAX) && left.is_pair_with(&right, 0.0));
    let [left, right] = spheres(1.0);
    assert!(!left.is_pair_with(&right, 1.0));
    let [left, right] = [-far, far].map(|corner| aabb(corner, corner));
    assert!(!left.is_pair_with(&right, 1e38));
    assert!(aabb(far * 0.9, far * 0.9).is_pair_with(&right, f32::MAX));
}
