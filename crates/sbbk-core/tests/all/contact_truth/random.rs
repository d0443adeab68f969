//! Random triangles of all shapes, sizes and distances.

use super::check::{check, decades, point, size, triangle};
use crate::prelude::*;
use proptest::prelude::*;
use sbbk_core::contact::contact;
use sbbk_truth as truth;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn triangles_of_any_two_sizes(
        t1 in triangle(),
        t2 in triangle(),
        offset in point(),
        s1 in decades(-4.0, 5.0),
        s2 in decades(-4.0, 5.0),
    ) {
        let reach = s1.abs().max(s2.abs());
        check(&t1.map(|v| v * s1), &t2.map(|v| v * s2 + offset * reach));
    }

    #[test]
    fn a_small_triangle_near_a_large_one(t1 in triangle(), t2 in triangle(), at in prop::array::uniform2(-0.2..1.2), s in decades(-6.0, 0.0)) {
        let foot = t1[0] + (t1[1] - t1[0]) * at[0] + (t1[2] - t1[0]) * at[1];
        check(&t1, &t2.map(|v| v * s + foot));
    }

    #[test]
    fn triangles_at_a_tiny_distance_or_depth(t1 in triangle(), t2 in triangle(), offset in point(), gap in decades(-17.0, -1.0)) {
        let t2 = t2.map(|v| v + 2.0 * offset);
        let before = truth::contact(&t1, &t2);
        let shift = before.normal * (gap * size(&t1) - before.distance);
        check(&t1, &t2.map(|v| v + shift));
    }

    #[test]
    fn triangles_far_from_the_origin(t1 in triangle(), t2 in triangle(), offset in point(), far in point()) {
        let far = far * 1.0e5;
        check(&t1.map(|v| v + far), &t2.map(|v| v + 2.0 * offset + far));
    }

    #[test]
    fn powers_of_two_scale_contacts_exactly(t1 in triangle(), t2 in triangle(), offset in point(), exponent in -110..110) {
        let scale = 2.0_f64.powi(exponent);
        let t2 = t2.map(|v| v + offset);
        let [scaled1, scaled2] = [t1, t2].map(|t| t.map(|v| v * scale));
        let plain = contact(&t1, &t2, f64::INFINITY).unwrap();
        let scaled = contact(&scaled1, &scaled2, f64::INFINITY).unwrap();
        prop_assert_eq!(plain.distance * scale, scaled.distance);
        prop_assert_eq!(plain.normal, scaled.normal);
        prop_assert_eq!(plain.features, scaled.features);
        prop_assert_eq!(plain.point1 * scale, scaled.point1);
    }
}

#[test]
fn random_pairs_have_contacts_of_all_kinds() {
    use proptest::{strategy::ValueTree, test_runner::TestRunner};
    let mut runner = TestRunner::deterministic();
    let mut kinds = std::collections::HashMap::new();
    for _ in 0..2000 {
        let strategy = (triangle(), triangle(), point());
        let (t1, t2, offset) = strategy.new_tree(&mut runner).unwrap().current();
        let found = contact(&t1, &t2.map(|v: DVec3| v + 2.0 * offset), f64::INFINITY).unwrap();
        let name = |f| format!("{f:?}").split('(').next().unwrap().to_string();
        let mut names = [name(found.features.feature1()), name(found.features.feature2())];
        names.sort();
        *kinds.entry((names, found.distance < 0.0)).or_insert(0) += 1;
    }
    // Vertex-vertex, vertex-edge, vertex-face and edge-edge apart, the last two crossing.
    assert_eq!(kinds.len(), 6, "{kinds:?}");
    assert!(kinds.values().all(|&count| count >= 10), "{kinds:?}");
}
