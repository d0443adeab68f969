//! The front: after any motion it finds the pairs of triangles within the margin, like a fresh
//! descent.

use std::collections::BTreeSet;

use crate::support::{Random, Soup, bumpy_ball, lattice_soup, soup};
use glamx::{Pose3, Quat, Vec3};
use sbbk_core::contact::contact;
use sbbk_core::front::Front;
use sbbk_core::query::TrianglePair;
use sbbk_core::traverse::{DescentScratch, PairFrame, Placement, descend};
use sbbk_core::tree::{LayerPlan, LeafBatch, Tree};

/// Pairs of triangles, and the number of pairs of nodes that were compared.
type Pairs = (BTreeSet<(u32, u32)>, u64);
type Trees<'a> = (&'a Tree, &'a Tree);

/// The pairs of triangles within the margin, by the exact contact, of the leaves that `visit`
/// visits.
fn pairs_of(
    trees: Trees<'_>,
    pos12: &Pose3,
    margin: f32,
    visit: impl FnOnce(&mut PairFrame, &mut dyn FnMut(&LeafBatch, &LeafBatch)),
) -> Pairs {
    let placement = Placement::new(pos12);
    let (mut pairs, mut frame) = (BTreeSet::new(), PairFrame::new(trees, placement, margin));
    visit(&mut frame, &mut |one, two| {
        for (lane1, &triangle1) in one.triangles().iter().enumerate() {
            for (lane2, &triangle2) in two.triangles().iter().enumerate() {
                let (corners1, corners2) = (one.corners(lane1), two.corners(lane2));
                let [t1, t2] = &TrianglePair::new(&placement, corners1, corners2).corners;
                if contact(t1, t2, margin.into()).is_some() {
                    assert!(pairs.insert((triangle1, triangle2)), "visited twice");
                }
            }
        }
    });
    (pairs, frame.counts.aabb_tests)
}

fn fresh(trees: Trees<'_>, pos12: &Pose3, margin: f32) -> Pairs {
    let scratch = &mut DescentScratch::default();
    pairs_of(trees, pos12, margin, |frame, found| descend(trees, frame, scratch, found))
}

fn from_front(front: &mut Front, trees: Trees<'_>, pos12: &Pose3, margin: f32) -> Pairs {
    pairs_of(trees, pos12, margin, |frame, found| front.visit(trees, frame, found))
}

/// A pose that goes on step by step: slow, jittering, fast, far away, not finite, at rest.
fn next_pose(random: &mut Random, pose: &mut Pose3, spread: f32) -> Pose3 {
    let [slow, fast, jitter] = [1e-3, 0.1, 1e-3].map(|size| random.near(pose, size));
    match random.bits() % 16 {
        0..6 => *pose = slow,
        6..9 => return jitter,
        9..12 => *pose = fast,
        12 => *pose = random.pose(spread),
        13 => return Pose3::from_translation(Vec3::splat(100.0)),
        14 => return Pose3::from_translation(Vec3::new(f32::NAN, 0.0, 0.0)),
        _ => {}
    }
    *pose
}

/// A lost or doubled lane, a margin taken from the query before, a cell that is freed twice: each
/// loses or doubles a pair here.
fn check_sequences(seed: u64, spread: f32, soups: impl Fn(&mut Random) -> [Soup; 2]) {
    let mut random = Random(seed);
    let mut total = 0;
    for round in 0..60 {
        let plan = [None, Some(LayerPlan::SBBK), Some(LayerPlan::AABB_ONLY)][round % 3];
        let trees = soups(&mut random).map(|soup| soup.tree(plan));
        let trees = (&trees[0], &trees[1]);
        let (mut front, mut pose) = (Front::default(), random.pose(spread));
        for _ in 0..30 {
            let pos12 = next_pose(&mut random, &mut pose, spread);
            let margin = [0.0, 0.001, 0.02, 0.1][(random.bits() % 4) as usize];
            let (expected, _) = fresh(trees, &pos12, margin);
            total += expected.len();
            let (found, _) = from_front(&mut front, trees, &pos12, margin);
            assert_eq!(found, expected, "at {pos12:?} within {margin}");
        }
    }
    assert!(total > 1000, "the meshes hardly touch: {total}");
}

#[test]
fn meshes_in_any_motion_have_the_pairs_of_a_fresh_descent() {
    check_sequences(100, 1.2, |random| {
        let rings = 3 + random.bits() % 4;
        [bumpy_ball(rings as u32, 0.2), bumpy_ball(4, 0.3)]
    });
    // Volumes overlap everywhere, as triangles have no order.
    check_sequences(1000, 1.0, |random| [soup(random, 40, 0.3), soup(random, 30, 0.4)]);
    check_sequences(2000, 2.0, |random| [0, 1].map(|_| lattice_soup(random, 30, 3)));
    // A tree that is one leaf stays at each pair.
    check_sequences(3000, 0.5, |random| {
        let (many, one) = (bumpy_ball(6, 0.2), soup(random, 1, 1.5));
        if random.bits().is_multiple_of(2) { [one, many] } else { [many, one] }
    });
}

/// Far from the origin f32 is coarse.
#[test]
fn coarse_coordinates_have_the_pairs_of_a_fresh_descent() {
    let mut random = Random(7);
    let offset = Vec3::new(3e4, -1e4, 2e4);
    let mut ball = bumpy_ball(6, 0.2);
    ball.vertices.iter_mut().for_each(|v| *v += offset);
    let tree = ball.tree(None);
    let (mut front, mut rotation) = (Front::default(), random.rotation());
    for _ in 0..20 {
        rotation = (Quat::from_scaled_axis(random.vector(1e-6)) * rotation).normalize();
        let translation = offset - rotation * offset + Vec3::new(1.8, 0.1, 0.0);
        let pos12 = Pose3::from_parts(translation, rotation);
        let (expected, _) = fresh((&tree, &tree), &pos12, 0.05);
        assert!(expected.len() > 20);
        assert_eq!(from_front(&mut front, (&tree, &tree), &pos12, 0.05).0, expected);
    }
}

/// Would catch a front that is never raised, and one that saves no test.
#[test]
fn a_front_stays_bounded_and_tests_fewer_nodes_than_a_fresh_descent() {
    let ball = bumpy_ball(10, 0.2).tree(None);
    let trees = (&ball, &ball);
    let mut front = Front::default();
    let mut largest_fresh = 0;
    let (mut tests, mut fresh_tests) = (0, 0);
    for i in 0..1000 {
        let t = 0.05 * i as f32;
        let rotation = Quat::from_rotation_x(0.044 * t) * Quat::from_rotation_y(0.028 * t);
        let pos12 = Pose3::from_parts(Vec3::new(1.9 * (0.013 * t).cos(), 0.0, 0.0), rotation);
        let mut new = Front::default();
        from_front(&mut new, trees, &pos12, 0.02);
        largest_fresh = new.len().max(largest_fresh);
        let (found, count) = from_front(&mut front, trees, &pos12, 0.02);
        let (expected, fresh_count) = fresh(trees, &pos12, 0.02);
        assert_eq!(found, expected);
        (tests, fresh_tests) = (tests + count, fresh_tests + fresh_count);
        assert!(front.len() <= 2 * largest_fresh, "{} of {largest_fresh}", front.len());
    }
    let share = tests as f64 / fresh_tests as f64;
    assert!(share < 0.9, "{share} of the tests of fresh descents");
}
