//! `nearest`, `deepest` and `meeting`.

use super::{all_pairs, distance_of, least, tree, triangle};
use crate::prelude::*;
use proptest::prelude::*;
use sbbk_core::query::{CastOptions, cast, deepest, meeting, nearest};
use sbbk_truth::TruthPair;

/// Share of the size of the meshes: a rounded rotation, `|q| = 1 ± 1e-7`, moves mesh 2 by as much.
const TOLERANCE: f64 = 1.0e-6;

/// [`nearest`] or [`deepest`].
type Query = fn((&Tree, &Tree), Placement, f64, &mut SearchScratch) -> Option<FoundPair>;

fn find(query: Query, [one, two]: [&Tree; 2], pose: &Pose3, limit: f64) -> Option<FoundPair> {
    query((one, two), Placement::new(pose), limit, &mut SearchScratch::default())
}

fn find_meeting([one, two]: [&Tree; 2], pose: &Pose3) -> Option<FoundPair> {
    meeting((one, two), Placement::new(pose), &mut SearchScratch::default())
}

/// Compares all queries at one pose, of trees of any plan, with brute force.
fn check(meshes: [&Soup; 2], pose: &Pose3, tolerance: f64) {
    let pairs = all_pairs(meshes, pose, DVec3::ZERO);
    let kdops = LayerPlan { sphere_root: false, kdop_from_depth: Some(1) };
    for plan in [None, Some(LayerPlan::AABB_ONLY), Some(LayerPlan::SBBK), Some(kdops)] {
        let trees = meshes.map(|soup| soup.tree(plan));
        check_trees(trees.each_ref(), pose, tolerance, &pairs);
    }
}

fn check_trees(trees: [&Tree; 2], pose: &Pose3, tolerance: f64, pairs: &[TruthPair]) {
    let truth = least(pairs);
    let own = |pair: &FoundPair| distance_of(pairs, [pair.triangle1, pair.triangle2]);

    let found = find(nearest, trees, pose, f64::INFINITY).expect("no limit");
    let distance = found.contact.distance.max(0.0);
    assert!((distance - truth.max(0.0)).abs() <= tolerance, "{distance}, truth {truth}");
    assert!((own(&found).max(0.0) - distance).abs() <= tolerance, "{found:?}");
    let [p1, p2] = [found.contact.point1, found.contact.point2];
    assert!(found.is_touching || ((p2 - p1).length() - distance).abs() <= tolerance);

    let found_deepest = find(deepest, trees, pose, f64::INFINITY).expect("no limit");
    let depth = found_deepest.contact.distance;
    assert!((depth - truth).abs() <= tolerance, "{found_deepest:?}, truth {truth}");

    let meets = found.is_touching;
    assert!(truth.abs() <= tolerance || meets == (truth < 0.0), "truth {truth}");
    for query in [nearest, deepest] {
        assert_eq!(find(query, trees, pose, 0.0).is_some(), meets);
    }
    let met = find_meeting(trees, pose);
    assert_eq!(met.is_some(), meets);
    assert!(met.is_none_or(|met| met.is_touching && own(&met) <= tolerance));
    for (factor, is_within) in [(0.99, false), (1.01, true)] {
        if distance > 1000.0 * tolerance {
            assert_eq!(find(nearest, trees, pose, factor * distance).is_some(), is_within);
        }
    }
}

/// [`check`] with a tolerance for rounded rotations.
fn check_turned(meshes: [&Soup; 2], pose: &Pose3) {
    let radius = |soup: &Soup| soup.vertices.iter().map(|v| v.length()).fold(0.0, f32::max);
    let reach = meshes.map(radius).into_iter().sum::<f32>() + pose.translation.length();
    check(meshes, pose, TOLERANCE * f64::from(reach));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn queries_of_soups_agree_with_brute_force(
        seed: u64,
        count1 in 1_u32..64,
        count2 in 1_u32..64,
        distance in 0.0_f32..4.0,
    ) {
        let mut random = Random(seed);
        let size = [0.05, 0.4, 2.0][(seed % 3) as usize];
        let [one, two] = [count1, count2].map(|count| soup(&mut random, count, size));
        check_turned([&one, &two], &random.pose(distance));
    }

    #[test]
    fn queries_far_from_the_origin_at_any_scale_agree_with_brute_force(
        seed: u64,
        exponent in -6_i32..=6,
        offset in 0.0_f32..100.0,
    ) {
        let mut random = Random(seed);
        let scale = 10.0_f32.powi(exponent);
        let moved = random.vector(offset);
        let [one, two] = [12, 9].map(|count| {
            let mut soup = soup(&mut random, count, 0.5);
            soup.vertices.iter_mut().for_each(|v| *v = scale * (*v + moved));
            soup
        });
        check_turned([&one, &two], &Pose3::from_translation(scale * random.vector(1.0)));
    }

    /// Whole numbers make the truth exact.
    #[test]
    fn queries_of_lattice_soups_are_exact(
        seed: u64,
        count in 1_u32..12,
        x in -4_i8..=4,
        y in -4_i8..=4,
        turn in 0_usize..4,
    ) {
        let mut random = Random(seed);
        let [one, two] = [0, 1].map(|_| lattice_soup(&mut random, count, 3));
        let mut quaternion = [0.0; 4];
        quaternion[turn] = 1.0;
        let place = Vec3::new(f32::from(x), f32::from(y), 0.0);
        let pose = Pose3::from_parts(place, Quat::from_array(quaternion));
        check([&one, &two], &pose, 1e-9);
        let truth = least(&all_pairs([&one, &two], &pose, DVec3::ZERO));
        let trees = [&one, &two].map(tree);
        prop_assert_eq!(find_meeting(trees.each_ref(), &pose).is_some(), truth <= 1e-12);
    }
}

/// The leaf is the root.
#[test]
fn meshes_of_one_triangle_have_their_distance() {
    let triangle = tree(&triangle([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]));
    for height in [0.0, 1e-20, 1e-3, 1.0, 1e6, 1e18] {
        let pose = Pose3::translation(0.0, 0.0, height);
        let found = find(nearest, [&triangle; 2], &pose, f64::INFINITY).unwrap();
        assert_eq!(found.contact.distance.max(0.0), f64::from(height));
        assert_eq!(found.is_touching, height < 1e-12);
    }
}

#[test]
fn non_finite_poses_and_invalid_limits_find_nothing() {
    let ball = tree(&bumpy_ball(8, 0.1));
    for bad in [f32::NAN, f32::INFINITY] {
        let turned = Pose3::from_parts(Vec3::ZERO, Quat::from_xyzw(bad, 0.0, 0.0, 1.0));
        for pose in [Pose3::translation(bad, 0.0, 0.0), turned] {
            assert_eq!(find(nearest, [&ball; 2], &pose, f64::INFINITY), None);
            assert_eq!(find_meeting([&ball; 2], &pose), None);
        }
    }
    for (x, limit) in [(0.5, f64::NAN), (0.5, -1e-3), (3.0, f64::NAN), (3.0, -1e-3)] {
        assert_eq!(find(deepest, [&ball; 2], &Pose3::translation(x, 0.0, 0.0), limit), None);
    }
}

#[test]
fn meshes_touch_up_to_rounding() {
    let random = &mut Random(11);
    for _ in 0..500 {
        // The middle of two such places is exact in f32, but is between them only up to rounding.
        let [a, b, c, aside] = [(); 4].map(|()| {
            let place = [(); 3].map(|()| random.range(0.5, 1.0).to_bits() & !1);
            Vec3::from_array(place.map(f32::from_bits))
        });
        let middle = (a + b) / 2.0;
        let away = middle + (middle - c);
        let soup = |corners: [Vec3; 3]| triangle(corners.map(|corner| corner.to_array()));
        let meshes = [&soup([a, b, c]), &soup([middle, away + 0.1 * aside, away - 0.1 * aside])];
        let [tree1, tree2] = &meshes.map(tree);
        assert!(find(nearest, [tree1, tree2], &Pose3::IDENTITY, 0.0).is_some());
        assert!(find_meeting([tree1, tree2], &Pose3::IDENTITY).is_some());
        let options =
            CastOptions { max_time: 1.0, target_distance: 0.0, stop_at_penetration: true };
        let placement = Placement::new(&Pose3::IDENTITY);
        let scratch = &mut SearchScratch::default();
        let first = cast((tree1, tree2), placement, middle - c, options, scratch, |_| true);
        assert!(first.is_some());
    }
}

/// Squares of distances overflow.
#[test]
fn huge_meshes_have_a_nearest_pair() {
    let ball = bumpy_ball(4, 0.0);
    let huge = Soup { vertices: ball.vertices.iter().map(|v| v * 1e25).collect(), ..ball };
    let huge = tree(&huge);
    let pose = Pose3::translation(0.0, 0.0, 3e25);
    let pair = find(nearest, [&huge; 2], &pose, f64::INFINITY).expect("all are finite");
    assert!((pair.contact.distance / 1e25 - 1.0).abs() < 1e-6, "{pair:?}");
}

#[test]
fn a_single_pair_touches_up_to_rounding_and_has_unit_normals() {
    let corners = [Vec3::ZERO, 1e6 * Vec3::X, 1e6 * Vec3::Y];
    let hardly = Placement::new(&Pose3::translation(0.0, 0.0, 2.0_f32.powi(-24)));
    let pair = FoundPair::of(&hardly, (3, corners), (5, corners), 0.0).expect("they touch");
    assert!(pair.is_touching && pair.contact.distance > 0.0, "{pair:?}");
    let scaling = Placement::new(&Pose3::from_parts(Vec3::Z, Quat::from_xyzw(0.0, 0.0, 0.0, 1.5)));
    let pair = FoundPair::of(&scaling, (3, corners), (5, corners), 2.0).expect("they are near");
    assert!((pair.normal2(&scaling) + Vec3::Z).length() < 1e-6, "{pair:?}");
}
