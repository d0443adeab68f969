use glamx::{DVec3, Pose3, Quat, Vec3};
use proptest::prelude::*;
use sbbk_core::query::{CastOptions, FoundPair, SearchScratch, cast, deepest, meeting, nearest};
use sbbk_core::traverse::Placement;
use sbbk_core::tree::{BuildOptions, LayerPlan, Tree};

use super::truth::{all_pairs, least, of, size};
use crate::support::{Random, Soup, bumpy_ball, lattice_soup, soup};

/// Of the size of the meshes: a rounded rotation, `|q| = 1 ± 1e-7`, moves mesh 2 by as much.
const TOLERANCE: f64 = 1.0e-6;

fn tree(soup: &Soup, layers: LayerPlan) -> Tree {
    let options = BuildOptions { layers: Some(layers), ..BuildOptions::default() };
    Tree::build(&soup.vertices, &soup.triangles, &options).expect("soups are valid")
}

/// [`nearest`] or [`deepest`].
type Question = fn((&Tree, &Tree), Placement, f64, &mut SearchScratch) -> Option<FoundPair>;

fn ask(meshes: [&Soup; 2], pose: &Pose3, limit: f64, question: Question) -> Option<FoundPair> {
    let [tree1, tree2] = meshes.map(|soup| tree(soup, LayerPlan::SBBK));
    let placement = Placement::new(pose);
    question((&tree1, &tree2), placement, limit, &mut SearchScratch::default())
}

fn ask_meeting(meshes: [&Soup; 2], pose: &Pose3) -> Option<FoundPair> {
    let [tree1, tree2] = meshes.map(|soup| tree(soup, LayerPlan::SBBK));
    meeting((&tree1, &tree2), Placement::new(pose), &mut SearchScratch::default())
}

/// Every kind of question about one pose, against all pairs of triangles.
fn check(meshes: [&Soup; 2], pose: &Pose3) {
    let pairs = all_pairs(meshes, pose, DVec3::ZERO);
    let (truth, slack) = (least(&pairs), TOLERANCE * size(meshes));
    let scale = slack + TOLERANCE * f64::from(pose.translation.length());

    let found = ask(meshes, pose, f64::INFINITY, nearest).expect("no limit");
    let distance = found.contact.distance.max(0.0);
    assert!((distance - truth.max(0.0)).abs() <= scale, "{distance}, truth {truth}");
    let own = of(&pairs, [found.triangle1, found.triangle2]).max(0.0);
    assert!((own - distance).abs() <= scale, "the triangles are {own} apart, not {distance}");
    let [p1, p2] = [found.contact.point1, found.contact.point2];
    assert!(found.is_touching || ((p2 - p1).length() - distance).abs() <= scale);

    let deepest = ask(meshes, pose, f64::INFINITY, deepest).expect("no limit");
    assert!((deepest.contact.distance - truth).abs() <= scale, "{deepest:?}, truth {truth}");

    let meets = ask(meshes, pose, 0.0, nearest).is_some();
    assert_eq!(meets, found.is_touching);
    let met = ask_meeting(meshes, pose);
    assert_eq!(met.is_some(), meets);
    if let Some(met) = met {
        let own = of(&pairs, [met.triangle1, met.triangle2]);
        assert!(met.is_touching && own <= scale, "the triangles are {own} apart");
    }
    if truth.abs() > scale {
        assert_eq!(meets, truth < 0.0, "truth {truth}");
    }
    // A limit on either side of the answer.
    for (factor, is_within) in [(0.99, false), (1.01, true)] {
        if distance > 1000.0 * scale {
            let within = ask(meshes, pose, factor * distance, nearest);
            assert_eq!(within.is_some(), is_within);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    /// Would catch a bound that is not one, a wrong pair, points of another pair, a limit not kept:
    /// triangles of all sizes, from deep inside each other to far apart.
    #[test]
    fn random_soups(seed: u64, count1 in 1_u32..40, count2 in 1_u32..40, distance in 0.0_f32..4.0) {
        let mut random = Random(seed);
        let sizes = [0.05, 0.4, 2.0][(seed % 3) as usize];
        let [one, two] = [count1, count2].map(|count| soup(&mut random, count, sizes));
        check([&one, &two], &random.pose(distance));
    }

    /// The same far from the origin, where coordinates have few digits left, and for meshes of a
    /// micrometre or a thousand kilometres: no tolerance may have a unit.
    #[test]
    fn other_scales(seed: u64, exponent in -6_i32..=6, offset in 0.0_f32..100.0) {
        let mut random = Random(seed);
        let scale = 10.0_f32.powi(exponent);
        let moved = random.vector(offset);
        let mut scaled = |count| {
            let mut soup = soup(&mut random, count, 0.5);
            soup.vertices.iter_mut().for_each(|v| *v = scale * (*v + moved));
            soup
        };
        let [one, two] = [scaled(12), scaled(9)];
        let nudge = scale * random.vector(1.0);
        check([&one, &two], &Pose3::from_parts(nudge, Quat::IDENTITY));
    }

    /// Lattice soups: degenerate triangles, triangles that touch in a point or lie in one plane.
    /// Whole numbers, so that the truth is exact and touching must count.
    #[test]
    fn lattice_soups(seed: u64, count in 1_u32..12, x in -4_i8..=4, y in -4_i8..=4, turn in 0_u8..4) {
        let mut random = Random(seed);
        let [one, two] = [0, 1].map(|_| lattice_soup(&mut random, count, 3));
        let rotation = [Quat::IDENTITY, Quat::from_xyzw(1.0, 0.0, 0.0, 0.0),
            Quat::from_xyzw(0.0, 1.0, 0.0, 0.0), Quat::from_xyzw(0.0, 0.0, 1.0, 0.0)][usize::from(turn)];
        let pose = Pose3::from_parts(Vec3::new(f32::from(x), f32::from(y), 0.0), rotation);
        let pairs = all_pairs([&one, &two], &pose, DVec3::ZERO);
        let found = ask([&one, &two], &pose, f64::INFINITY, nearest).unwrap();
        let truth = least(&pairs);
        prop_assert!((found.contact.distance.max(0.0) - truth.max(0.0)).abs() < 1e-9);
        prop_assert_eq!(found.is_touching, truth <= 1e-12);
        prop_assert_eq!(ask([&one, &two], &pose, 0.0, nearest).is_some(), truth <= 1e-12);
        let met = ask_meeting([&one, &two], &pose);
        prop_assert_eq!(met.is_some(), truth <= 1e-12);
        prop_assert!(met.is_none_or(|met| of(&pairs, [met.triangle1, met.triangle2]) <= 1e-12));
        let deepest = ask([&one, &two], &pose, 0.0, deepest);
        prop_assert_eq!(deepest.is_some(), truth <= 1e-12);
        if let Some(deepest) = deepest {
            prop_assert!((deepest.contact.distance - truth).abs() < 1e-9, "{deepest:?} {truth}");
        }
    }

    /// Every plan gives the same distance.
    #[test]
    fn any_layers(seed: u64) {
        let mut random = Random(seed);
        let [one, two] = [0, 1].map(|_| soup(&mut random, 60, 0.3));
        let pose = random.pose(3.0);
        let truth = least(&all_pairs([&one, &two], &pose, DVec3::ZERO));
        let plans = [LayerPlan::AABB_ONLY, LayerPlan::SBBK,
            LayerPlan { sphere_root: false, kdop_from_depth: Some(1) }];
        for plan in plans {
            let found = in_layers([&one, &two], &pose, plan);
            prop_assert!((found - truth).abs() < 1e-5, "{found}, truth {truth}");
        }
    }
}

fn in_layers(meshes: [&Soup; 2], pose: &Pose3, plan: LayerPlan) -> f64 {
    let [tree1, tree2] = meshes.map(|soup| tree(soup, plan));
    let (placement, mut scratch) = (Placement::new(pose), SearchScratch::default());
    let found = deepest((&tree1, &tree2), placement, f64::INFINITY, &mut scratch);
    found.expect("no limit").contact.distance
}

/// One triangle each, as the leaf is then the root.
#[test]
fn one_triangle_each() {
    let triangle =
        Soup { vertices: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]] };
    for height in [0.0, 1e-20, 1e-3, 1.0, 1e6, 1e18] {
        let pose = Pose3::translation(0.0, 0.0, height);
        let found = ask([&triangle; 2], &pose, f64::INFINITY, nearest).unwrap();
        assert_eq!(found.contact.distance.max(0.0), f64::from(height));
        assert_eq!(found.is_touching, height < 1e-12);
    }
}

/// "If the placement is not finite" there is no answer, and no search without end.
#[test]
fn numbers_that_are_none() {
    let ball = bumpy_ball(8, 0.1);
    for bad in [f32::NAN, f32::INFINITY] {
        let turned = Pose3::from_parts(Vec3::ZERO, Quat::from_xyzw(bad, 0.0, 0.0, 1.0));
        for pose in [Pose3::translation(bad, 0.0, 0.0), turned] {
            assert_eq!(ask([&ball; 2], &pose, f64::INFINITY, nearest), None);
            assert_eq!(ask_meeting([&ball; 2], &pose), None);
        }
    }
    for x in [0.5, 3.0] {
        for limit in [f64::NAN, -1.0e-3] {
            let pose = Pose3::translation(x, 0.0, 0.0);
            assert_eq!(ask([&ball; 2], &pose, limit, deepest), None);
        }
    }
}

/// Would catch meshes that touch, if it were not for the rounding of f64, and do not count as meeting.
#[test]
fn meshes_touch_up_to_rounding() {
    let random = &mut Random(11);
    for _ in 0..500 {
        // The middle of two such places is exact in f32, but whether it is between them not in f64.
        let mut place = || {
            Vec3::from_array(
                [(); 3].map(|()| random.range(0.5, 1.0).to_bits() & !1).map(f32::from_bits),
            )
        };
        let [a, b, c, aside] = [(); 4].map(|()| place());
        let middle = (a + b) / 2.0;
        let away = middle + (middle - c);
        let triangle =
            |vertices: [Vec3; 3]| Soup { vertices: vertices.into(), triangles: vec![[0, 1, 2]] };
        let meshes =
            [&triangle([a, b, c]), &triangle([middle, away + 0.1 * aside, away - 0.1 * aside])];
        assert!(ask(meshes, &Pose3::IDENTITY, 0.0, nearest).is_some());
        assert!(ask_meeting(meshes, &Pose3::IDENTITY).is_some());
        // So do those that part.
        let [tree1, tree2] = meshes.map(|soup| tree(soup, LayerPlan::SBBK));
        let options =
            CastOptions { max_time: 1.0, target_distance: 0.0, stop_at_penetration: true };
        let placement = Placement::new(&Pose3::IDENTITY);
        let scratch = &mut SearchScratch::default();
        assert!(cast((&tree1, &tree2), placement, middle - c, options, scratch).is_some());
    }
}

/// Would catch a search that finds no way down where squares of distances are infinite.
#[test]
fn huge_meshes_have_a_nearest_pair() {
    let ball = bumpy_ball(4, 0.0);
    let huge = Soup { vertices: ball.vertices.iter().map(|v| v * 1e25).collect(), ..ball };
    let pose = Pose3::translation(0.0, 0.0, 3e25);
    let pair = ask([&huge; 2], &pose, f64::INFINITY, nearest).expect("all are finite");
    assert!((pair.contact.distance / 1e25 - 1.0).abs() < 1e-6, "{pair:?}");
}

/// Would catch triangles that touch but for rounding and do not count, and a normal that is longer
/// where a rotation scales.
#[test]
fn a_pair_by_itself_is_as_in_a_search() {
    let corners = [Vec3::ZERO, 1e6 * Vec3::X, 1e6 * Vec3::Y];
    let hardly = Placement::new(&Pose3::translation(0.0, 0.0, 2.0_f32.powi(-24)));
    let pair = FoundPair::of(&hardly, (3, corners), (5, corners), 0.0).expect("they touch");
    assert!(pair.is_touching && pair.contact.distance > 0.0, "{pair:?}");
    let scaling = Placement::new(&Pose3::from_parts(Vec3::Z, Quat::from_xyzw(0.0, 0.0, 0.0, 1.5)));
    let pair = FoundPair::of(&scaling, (3, corners), (5, corners), 2.0).expect("they are near");
    assert!((pair.normal2(&scaling) + Vec3::Z).length() < 1e-6, "{pair:?}");
}
