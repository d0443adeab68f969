//! `contacts` as whole sets of pairs.

use super::{pairs_within, tree, triangle};
use crate::prelude::*;
use sbbk_core::query::contacts;

type Distances = BTreeMap<[u32; 2], f64>;

fn found(meshes: [&Soup; 2], pose: &Pose3, margin: f64) -> Vec<FoundPair> {
    let [tree1, tree2] = meshes.map(tree);
    let mut pairs = Vec::new();
    let scratch = &mut SearchScratch::default();
    contacts((&tree1, &tree2), Placement::new(pose), margin, scratch, |pair| pairs.push(pair));
    pairs
}

fn truth(meshes: [&Soup; 2], pose: &Pose3, margin: f64) -> Distances {
    let pairs = pairs_within(meshes, (*pose).into(), margin);
    pairs.iter().map(|pair| (pair.triangles, pair.distance)).collect()
}

/// Compares the pairs with brute force and returns their number.
fn check(meshes: [&Soup; 2], pose: &Pose3, margin: f64, tolerance: f64) -> usize {
    let pairs = found(meshes, pose, margin);
    let distances = pairs.iter().map(|p| ([p.triangle1, p.triangle2], p.contact.distance));
    let found: Distances = distances.collect();
    assert_eq!(found.len(), pairs.len(), "a pair was found twice");
    let possible = truth(meshes, pose, margin + tolerance);
    for (triangles, distance) in &found {
        let expected = possible.get(triangles).expect("a pair beyond the margin");
        assert!((distance - expected).abs() <= tolerance, "{distance} {expected}");
    }
    for (triangles, distance) in possible {
        let is_certain = distance <= margin - tolerance;
        assert!(!is_certain || found.contains_key(&triangles), "lost {triangles:?} {distance}");
    }
    found.len()
}

#[test]
fn contacts_are_all_pairs_within_the_margin() {
    let mut random = Random(51);
    let mut total = 0;
    for round in 0..60 {
        let (one, two) = match round % 3 {
            0 => (bumpy_ball(5, 0.2), bumpy_ball(4, 0.1)),
            1 => (soup(&mut random, 40, 0.3), soup(&mut random, 30, 0.4)),
            _ => (lattice_soup(&mut random, 30, 2), lattice_soup(&mut random, 30, 2)),
        };
        let pose = random.pose(1.0);
        for margin in [0.0, 0.02, 0.5] {
            total += check([&one, &two], &pose, margin, 1e-11);
        }
    }
    assert!(total > 10_000, "{total}");
}

/// Triangles have corners near the origin and far from it.
#[test]
fn margins_are_exact_to_rounding_of_f64() {
    let mut random = Random(52);
    let mut count = 0;
    for _ in 0..40 {
        let mut meshes = [(); 2].map(|()| soup(&mut random, 12, 0.5));
        for vertex in meshes.iter_mut().flat_map(|soup| &mut soup.vertices) {
            *vertex *= 10f32.powf(random.range(-6.0, 0.0));
        }
        let [one, two] = &meshes;
        let pose = Pose3::translation(0.3, 0.2, 0.1);
        for (triangles, distance) in truth([one, two], &pose, 1.0) {
            if !(1e-3..0.9).contains(&distance) || count > 2000 {
                continue;
            }
            count += 1;
            let finds = |margin: f64| {
                let pairs = found([one, two], &pose, margin);
                pairs.iter().any(|pair| [pair.triangle1, pair.triangle2] == triangles)
            };
            assert!(finds(distance + 1e-12) && !finds(distance - 1e-12), "{triangles:?}");
        }
    }
    assert!(count > 1000, "{count}");
}

#[test]
fn huge_margins_find_all_pairs_and_invalid_margins_none() {
    let ball = bumpy_ball(3, 0.1);
    let pose = Pose3::from_translation(Vec3::new(1e3, 0.0, 0.0));
    let all = ball.triangles.len() * ball.triangles.len();
    for margin in [2e3, 1e9, 1e15, 1.1e15, 1e20, 1e38, 1e300, f64::INFINITY] {
        assert_eq!(check([&ball; 2], &pose, margin, 1e-9), all, "{margin}");
    }
    for margin in [f64::NAN, -1e-9, f64::NEG_INFINITY] {
        assert_eq!(found([&ball; 2], &pose, margin), []);
    }
    assert_eq!(found([&ball; 2], &Pose3::from_translation(Vec3::NAN), 1e20), []);
}

#[test]
fn triangles_with_a_common_corner_touch() {
    let one = triangle([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let pairs = found([&one; 2], &Pose3::translation(1.0, 0.0, 0.0), 0.0);
    assert_eq!(pairs.len(), 1);
    assert!(pairs[0].is_touching && pairs[0].contact.distance.abs() < 1e-12, "{pairs:?}");
    let apart = found([&one; 2], &Pose3::translation(1.0 + 1e-6, 0.0, 0.0), 1e-5);
    assert!(!apart[0].is_touching, "{apart:?}");
}
