//! The descent against the brute-force reference: never a pair lost, none visited without need.

use crate::prelude::*;
use crate::query::pairs_within;
use crate::tree::check as check_tree;

/// The pairs of triangles that descent and leaf test leave.
pub fn survivors(
    trees: (&Tree, &Tree),
    pos12: &Pose3,
    margin: f32,
) -> (BTreeSet<(u32, u32)>, DescentCounts) {
    let mut frame = PairFrame::new(trees, Placement::new(pos12), margin);
    let test = LeafTest::new(&frame);
    let mut pairs = BTreeSet::new();
    let mut scratch = DescentScratch::default();
    descend(trees, &mut frame, &mut scratch, |batch1, batch2| {
        test.survivors(batch1, batch2, |i, j| {
            let is_new = pairs.insert((batch1.triangles()[i], batch2.triangles()[j]));
            assert!(is_new, "a pair of triangles was visited twice");
        });
    });
    (pairs, frame.counts)
}

fn tree(soup: &Soup, layers: impl Into<Option<LayerPlan>>) -> Tree {
    check_tree(soup, layers.into())
}

fn truth(soup1: &Soup, soup2: &Soup, pos12: &Pose3, margin: f32) -> BTreeSet<(u32, u32)> {
    let pairs = pairs_within([soup1, soup2], (*pos12).into(), margin.into()).into_iter();
    pairs.map(|pair| pair.triangles.into()).collect()
}

/// All plans find a superset of the truth. Returns the number of true pairs.
fn check(soup1: &Soup, soup2: &Soup, pos12: &Pose3, margin: f32) -> usize {
    let truth = truth(soup1, soup2, pos12, margin);
    let plans = [
        None,
        Some(LayerPlan::SBBK),
        Some(LayerPlan::AABB_ONLY),
        Some(LayerPlan { sphere_root: false, kdop_from_depth: Some(1) }),
    ];
    for plan in plans {
        let trees = (tree(soup1, plan), tree(soup2, plan));
        let (pairs, _) = survivors((&trees.0, &trees.1), pos12, margin);
        let lost: Vec<_> = truth.difference(&pairs).collect();
        assert!(lost.is_empty(), "{plan:?} lost {lost:?} at {pos12:?}");
    }
    truth.len()
}

/// Two meshes, a pose and a margin.
type Case = ([Soup; 2], Pose3, f32);

/// Would catch a test of k-DOPs where one side has none.
fn where_one_tree_chose_boxes(random: &mut Random, i: usize) -> Case {
    let meshes = [cube(6), bumpy_ball(10, 0.2)];
    let has_kdops = |soup: &Soup| tree(soup, None).stats().layers.kdop_from_depth.is_some();
    assert_eq!(meshes.each_ref().map(has_kdops), [false, true]);
    (meshes, random.pose(1.5), [0.0, 0.02][i % 2])
}

/// A hole in a volume, a wrong lane, a margin that is too small: each loses a pair here.
fn bumpy_balls(random: &mut Random, i: usize) -> Case {
    let ball = bumpy_ball(12, 0.15);
    let other = if i.is_multiple_of(2) { bumpy_ball(5, 0.3) } else { ball.clone() };
    ([ball, other], random.pose(1.2), [0.0, 0.001, 0.02, 0.2][i / 2 % 4])
}

/// Trees of very different depth: one side reaches its leaves while the other goes on.
fn one_triangle_with_many(random: &mut Random, _: usize) -> Case {
    ([soup(random, 1, 1.5), bumpy_ball(10, 0.1)], random.pose(0.7), 0.02)
}

/// Integer corners and turns by multiples of 90 degrees: touching is exact, ties are everywhere,
/// and degenerate triangles occur.
fn on_the_lattice(random: &mut Random, i: usize) -> Case {
    let soups = [0, 1].map(|_| lattice_soup(random, 40, 6));
    let turn = Quat::from_axis_angle(Vec3::AXES[i % 3], FRAC_PI_2 * (i % 4) as f32);
    let shift = Vec3::from_array([0; 3].map(|_| random.below(9) as f32 - 4.0));
    (soups, Pose3::from_parts(shift, turn), (i % 2) as f32)
}

/// Far from the origin f32 has few digits left: the margins must grow by as much as they lose.
fn far_from_the_origin(random: &mut Random, _: usize) -> Case {
    let mut ball = bumpy_ball(8, 0.2);
    let offset = Vec3::new(1e5, -3e4, 7e4);
    ball.vertices.iter_mut().for_each(|v| *v += offset);
    let rotation = random.rotation();
    let translation = offset - rotation * offset + random.vector(1.0);
    ([ball.clone(), ball], Pose3::from_parts(translation, rotation), 0.02)
}

/// A quaternion a little off unit length scales the second mesh; Parry's points do so too.
fn under_denormalised_rotations(random: &mut Random, i: usize) -> Case {
    let ball = bumpy_ball(8, 0.2);
    let mut pose = random.pose(1.2);
    pose.rotation *= [0.999, 1.0001, 1.01][i % 3];
    ([ball.clone(), ball], pose, 0.01)
}

#[test]
fn descents_find_every_pair_either_way_round() {
    type Cases = [(fn(&mut Random, usize) -> Case, usize, usize); 6];
    let cases: Cases = [
        (where_one_tree_chose_boxes, 40, 1000),
        (bumpy_balls, 90, 10_000),
        (one_triangle_with_many, 100, 500),
        (on_the_lattice, 60, 5000),
        (far_from_the_origin, 20, 2000),
        (under_denormalised_rotations, 30, 2000),
    ];
    for (seed, (case, count, least)) in (1..).zip(cases) {
        let mut random = Random(seed);
        let mut total = 0;
        for i in 0..count {
            let ([one, two], pose, margin) = case(&mut random, i);
            total += check(&one, &two, &pose, margin) + check(&two, &one, &pose, margin);
        }
        assert!(total > least, "the poses of case {seed} hardly touch: {total}");
    }
}

/// The paper's section 3.2: complete trees of n levels in which all nodes meet. Its formula for all
/// tests of the simultaneous descent, `(2^(2n-1) - 1)/3`, is not a whole number; its own parts,
/// inner `(2^(2(n-1)) - 1)/3` and leaf `2^(2(n-1))`, add up to `(2^(2n) - 1)/3`.
#[test]
fn counts_of_complete_trees_are_the_papers() {
    for levels in 1..=6u32 {
        let count = BATCH << (levels - 1);
        // Equal triangles are halved by number: the tree is complete.
        let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let triangles = vec![[0, 1, 2]; count];
        let tree = Tree::build(&vertices, &triangles, Some(LayerPlan::SBBK)).unwrap();
        assert_eq!(tree.stats().depth, levels - 1);
        let (pairs, counts) = survivors((&tree, &tree), &Pose3::IDENTITY, 0.0);
        assert_eq!(counts.aabb_tests, (4u64.pow(levels) - 1) / 3, "{levels} levels");
        assert_eq!(counts.leaf_pairs, 4u64.pow(levels - 1));
        assert_eq!(pairs.len(), count * count);
        let tests = tests_one_side_at_a_time([tree.root(), tree.root()]);
        assert_eq!(tests, 2u64.pow(2 * levels - 1) - 1);
    }
}

/// Tests of a descent that opens one node at a time, in turns, if all nodes meet.
fn tests_one_side_at_a_time([next, other]: [Node<'_>; 2]) -> u64 {
    let below = match (next.children(), other.children()) {
        (Some(children), _) => children.map(|child| tests_one_side_at_a_time([other, child])),
        (None, Some(children)) => children.map(|child| tests_one_side_at_a_time([child, next])),
        (None, None) => [0; 2],
    };
    1 + below.iter().sum::<u64>()
}

/// Would catch a panic or an endless descent.
#[test]
fn poses_that_are_not_finite_find_nothing() {
    let ball = bumpy_ball(5, 0.2);
    let tree = tree(&ball, LayerPlan::SBBK);
    let zero = Quat::from_xyzw(0.0, 0.0, 0.0, 0.0);
    let poses = [
        Pose3::from_translation(Vec3::new(f32::NAN, 0.0, 0.0)),
        Pose3::from_translation(Vec3::new(0.0, f32::INFINITY, 0.0)),
        Pose3::from_rotation(Quat::from_xyzw(f32::NAN, 0.0, 0.0, 1.0)),
        Pose3::from_rotation(zero),
    ];
    for pose in poses {
        let (pairs, _) = survivors((&tree, &tree), &pose, 0.02);
        assert!(pairs.is_empty(), "{pose:?}");
    }
}

/// k-DOPs below must prune more than boxes alone, or they are wired wrongly.
#[test]
fn kdops_visit_fewer_leaves() {
    let mut random = Random(6);
    let ball = bumpy_ball(24, 0.15);
    let trees = [LayerPlan::SBBK, LayerPlan::AABB_ONLY].map(|plan| tree(&ball, plan));
    let mut leaf_pairs = [0, 0];
    for _ in 0..20 {
        let pose = Pose3::from_parts(random.vector(1.0).normalize() * 1.9, random.rotation());
        for (tree, total) in trees.iter().zip(&mut leaf_pairs) {
            *total += survivors((tree, tree), &pose, 0.01).1.leaf_pairs;
        }
    }
    assert!(leaf_pairs[0] > 0 && leaf_pairs[0] * 10 < leaf_pairs[1] * 8, "{leaf_pairs:?}");
}

/// A ball of 480 triangles sinks into the top of cubes with cells of its size.
#[test]
fn a_small_mesh_takes_hardly_more_tests_on_a_larger_one() {
    let mut random = Random(9);
    let ball = tree(&bumpy_ball(12, 0.1), None);
    let poses: Vec<_> = (0..20).map(|_| (random.vector(1.0), random.rotation())).collect();
    let [coarse, fine] = [8, 64].map(|cells| {
        let mut ground = cube(cells);
        let half = 0.5 * cells as f32;
        ground.vertices.iter_mut().for_each(|vertex| *vertex *= half);
        let ground = tree(&ground, None);
        let tests = poses.iter().map(|&(beside, turn)| {
            let pose = Pose3::from_parts(Vec3::Y * half + beside, turn);
            survivors((&ground, &ball), &pose, 0.02).1.aabb_tests
        });
        tests.sum::<u64>()
    });
    // For 64 times as many triangles.
    assert!(2 * fine < 3 * coarse, "{coarse}, {fine}");
}
