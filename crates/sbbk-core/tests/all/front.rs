//! The front: whatever happened before, the pairs of triangles within the margin are those of a
//! fresh descent, and those of brute force.

use std::collections::BTreeSet;

use crate::support::{Random, Soup, bumpy_ball, lattice_soup, soup};
use glamx::{Pose3, Quat, Vec3};
use proptest::prelude::*;
use sbbk_core::contact::contact;
use sbbk_core::front::{Front, FrontOptions, FrontStats};
use sbbk_core::leaf::LeafTest;
use sbbk_core::query::TrianglePair;
use sbbk_core::traverse::{
    Descent, DescentCounts, DescentScratch, PairFrame, Placement, Verdict, Visitor, descend,
};
use sbbk_core::tree::{BuildOptions, LayerPlan, LeafBatch, Tree};
use sbbk_core::truth::pairs_within;

type Pairs = BTreeSet<(u32, u32)>;

/// Collects the pairs of triangles within the margin, by the exact contact.
struct Within {
    test: LeafTest,
    placement: Placement,
    margin: f64,
    leaves: BTreeSet<(u32, u32)>,
    pairs: Pairs,
}

impl Visitor for Within {
    fn leaves(
        &mut self,
        leaf1: u32,
        batch1: &LeafBatch,
        leaf2: u32,
        batch2: &LeafBatch,
    ) -> Verdict {
        assert!(self.leaves.insert((leaf1, leaf2)), "a pair of leaves was visited twice");
        self.test.survivors(batch1, batch2, |lane1, lane2| {
            let corners = (batch1.corners(lane1), batch2.corners(lane2));
            let pair = TrianglePair::new(&self.placement, corners.0, corners.1);
            let [t1, t2] = &pair.corners;
            if contact(t1, t2, self.margin).is_some() {
                self.pairs.insert((batch1.triangles()[lane1], batch2.triangles()[lane2]));
            }
        });
        Verdict::Descend
    }
}

type Trees<'a> = (&'a Tree, &'a Tree);

fn within(
    trees: Trees<'_>,
    pos12: &Pose3,
    margin: f32,
    visit: impl FnOnce(&mut PairFrame, &mut Within),
) -> Pairs {
    let mut frame = PairFrame::new(trees.0, trees.1, pos12, margin);
    let mut visitor = Within {
        test: LeafTest::new(&frame),
        placement: *frame.placement(),
        margin: f64::from(margin),
        leaves: BTreeSet::new(),
        pairs: Pairs::new(),
    };
    visit(&mut frame, &mut visitor);
    visitor.pairs
}

fn fresh(trees: Trees<'_>, pos12: &Pose3, margin: f32) -> Pairs {
    within(trees, pos12, margin, |frame, visitor| {
        let mut scratch = DescentScratch::default();
        descend(trees, frame, Descent::Simultaneous, &mut scratch, (), visitor);
    })
}

fn from_front(front: &mut Front, trees: Trees<'_>, pos12: &Pose3, margin: f32) -> Pairs {
    within(trees, pos12, margin, |frame, visitor| {
        front.visit(trees, frame, &mut DescentScratch::default(), (), visitor);
    })
}

fn tree(soup: &Soup) -> Tree {
    Tree::build(&soup.vertices, &soup.triangles, &BuildOptions::default()).unwrap()
}

const BOTH: [FrontOptions; 2] = [FrontOptions::Paper, FrontOptions::Adaptive];

/// Brute force agrees, up to the rounding of f64 at the margin itself.
fn check_truth(soups: [&Soup; 2], pos12: &Pose3, margin: f32, found: &Pairs) {
    let pose = glamx::DPose3 {
        rotation: pos12.rotation.as_dquat(),
        translation: pos12.translation.as_dvec3(),
    };
    let [one, two] = soups;
    let wide = |soup: &Soup| soup.vertices.iter().map(|v| v.as_dvec3()).collect::<Vec<_>>();
    let truth = |margin: f64| -> Pairs {
        pairs_within(&wide(one), &one.triangles, &wide(two), &two.triangles, pose, margin)
            .into_iter()
            .map(|pair| (pair.triangle1, pair.triangle2))
            .collect()
    };
    let margin = f64::from(margin);
    let lost: Vec<_> = truth(margin - 1e-9).difference(found).copied().collect();
    assert!(lost.is_empty(), "lost {lost:?} at {pos12:?}");
    let extra: Vec<_> = found.difference(&truth(margin + 1e-9)).copied().collect();
    assert!(extra.is_empty(), "too far apart: {extra:?} at {pos12:?}");
}

/// One step of a sequence: how the pose goes on from the last one.
#[derive(Clone, Copy, Debug)]
enum Step {
    /// By this much at most, shift and turn.
    Move(f32),
    /// Around a fixed place.
    Jitter(f32),
    /// About a fixed axis.
    Turn(f32),
    Stay,
    Teleport,
    FarAway,
    NotANumber,
}

fn step(random: &mut Random) -> Step {
    match random.bits() % 24 {
        0..8 => Step::Move([1e-4, 1e-3, 0.01, 0.1][(random.bits() % 4) as usize]),
        8..14 => Step::Jitter(1e-3),
        14..18 => Step::Turn([0.001, 0.1][(random.bits() % 2) as usize]),
        18..20 => Step::Stay,
        20..22 => Step::Teleport,
        22 => Step::FarAway,
        _ => Step::NotANumber,
    }
}

/// A pose that goes on step by step.
struct Walk {
    place: Pose3,
    axis: Vec3,
    spread: f32,
}

impl Walk {
    fn new(random: &mut Random, spread: f32) -> Self {
        Self { place: random.pose(spread), axis: random.rotation() * Vec3::X, spread }
    }

    fn moved(&self, random: &mut Random, size: f32) -> Pose3 {
        let turn = Quat::from_scaled_axis(random.vector(size));
        let rotation = (turn * self.place.rotation).normalize();
        Pose3::from_parts(self.place.translation + random.vector(size), rotation)
    }

    fn go(&mut self, random: &mut Random, step: Step) -> Pose3 {
        self.place = match step {
            Step::Move(size) => self.moved(random, size),
            Step::Turn(angle) => Pose3::from_parts(
                self.place.translation,
                (Quat::from_axis_angle(self.axis, angle) * self.place.rotation).normalize(),
            ),
            Step::Jitter(size) => return self.moved(random, size),
            Step::Teleport => random.pose(self.spread),
            Step::FarAway => return Pose3::from_translation(Vec3::splat(100.0)),
            Step::NotANumber => return Pose3::from_translation(Vec3::new(f32::NAN, 0.0, 0.0)),
            Step::Stay => self.place,
        };
        self.place
    }
}

/// Runs one sequence for both fronts at once. Returns the statistics of each, and the number of
/// pairs.
fn check_sequence(
    seed: u64,
    soups: [&Soup; 2],
    spread: f32,
    steps: usize,
) -> ([FrontStats; 2], usize) {
    let mut random = Random(seed);
    let trees = soups.map(tree);
    let trees = (&trees[0], &trees[1]);
    let mut fronts = BOTH.map(Front::new);
    let mut walk = Walk::new(&mut random, spread);
    let mut margin = 0.02;
    let mut total = 0;
    // Sequences settle for a while on what they do, as bodies do.
    let mut habit = step(&mut random);
    for _ in 0..steps {
        if random.bits().is_multiple_of(6) {
            habit = step(&mut random);
        }
        if random.bits().is_multiple_of(8) {
            margin = [0.0, 0.001, 0.02, 0.1][(random.bits() % 4) as usize];
        }
        let pos12 = walk.go(&mut random, habit);
        let expected = fresh(trees, &pos12, margin);
        if pos12.translation.is_finite() {
            check_truth(soups, &pos12, margin, &expected);
        }
        total += expected.len();
        for (front, options) in fronts.iter_mut().zip(BOTH) {
            let found = from_front(front, trees, &pos12, margin);
            assert_eq!(found, expected, "{options:?} after {habit:?} at {pos12:?} within {margin}");
        }
    }
    (fronts.map(|front| front.stats()), total)
}

/// Sequences on pairs of small meshes of all kinds.
fn check_sequences(count: u64, seed: u64, spread: f32, soups: impl Fn(&mut Random) -> [Soup; 2]) {
    let mut stats = [FrontStats::default(); 2];
    let mut total = 0;
    for i in 0..count {
        let mut random = Random(seed + i);
        let [one, two] = soups(&mut random);
        let (sequence, pairs) = check_sequence(random.bits(), [&one, &two], spread, 24);
        total += pairs;
        for (sum, one) in stats.iter_mut().zip(&sequence) {
            sum.reused += one.reused;
            sum.lowered += one.lowered;
            sum.raised += one.raised;
            sum.fresh += one.fresh;
        }
    }
    assert!(total as u64 > 20 * count, "the meshes hardly touch: {total}");
    let [paper, adaptive] = stats;
    let queries = 24 * count;
    assert!(paper.reused > queries / 2 && paper.lowered > count, "{paper:?}");
    assert_eq!((paper.fresh, paper.raised), (0, 0), "{paper:?}");
    assert!(adaptive.reused > queries / 20 && adaptive.lowered > count, "{adaptive:?}");
    assert!(adaptive.fresh > 0 && adaptive.raised > 0, "{adaptive:?}");
}

/// A gap that is too large, motion that is underestimated, a margin that is taken for the one
/// before, a lane or pair of leaves that is lost or kept when the front goes up or down: each loses
/// or doubles a pair here.
#[test]
fn bumpy_balls_in_any_motion() {
    check_sequences(100, 100, 1.2, |random| {
        let rings = 3 + random.bits() % 4;
        [bumpy_ball(rings as u32, 0.2), bumpy_ball(4, 0.3)]
    });
}

/// No order among the triangles: volumes overlap everywhere, and gaps are small.
#[test]
fn triangle_soups_in_any_motion() {
    check_sequences(100, 1000, 1.0, |random| [soup(random, 40, 0.3), soup(random, 30, 0.4)]);
}

/// Integer corners, and degenerate triangles.
#[test]
fn lattice_meshes_in_any_motion() {
    check_sequences(100, 2000, 2.0, |random| [0, 1].map(|_| lattice_soup(random, 30, 3)));
}

/// A tree that is one leaf: one side stays at each pair.
#[test]
fn one_triangle_and_many_in_any_motion() {
    check_sequences(100, 3000, 0.5, |random| {
        let many = bumpy_ball(6, 0.2);
        let one = soup(random, 1, 1.5);
        if random.bits().is_multiple_of(2) { [one, many] } else { [many, one] }
    });
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    /// The default, over longer sequences that proptest can shorten.
    #[test]
    fn the_default_after_any_steps(
        seed in any::<u64>(),
        steps in prop::collection::vec((0u8..6, -4.0f32..0.0, 0u8..4), 1..40),
    ) {
        let mut random = Random(seed);
        let soups = [bumpy_ball(5, 0.2), soup(&mut random, 30, 0.3)];
        let trees = soups.each_ref().map(tree);
        let trees = (&trees[0], &trees[1]);
        let mut front = Front::default();
        let mut walk = Walk::new(&mut random, 1.2);
        for (kind, exponent, margin) in steps {
            let size = 10f32.powf(exponent);
            let step = match kind {
                0..3 => Step::Move(size),
                3 => Step::Jitter(size),
                4 => Step::Turn(size),
                _ => Step::Stay,
            };
            let pos12 = walk.go(&mut random, step);
            let margin = [0.0, 0.001, 0.02, 0.2][usize::from(margin)];
            let found = from_front(&mut front, trees, &pos12, margin);
            prop_assert_eq!(found, fresh(trees, &pos12, margin));
        }
    }
}

/// 6000 slow steps through each other and apart: an adaptive front has at most twice the cells it
/// can be built with, plus 64. One that only goes down has far more in the end.
#[test]
fn a_raised_front_stays_bounded() {
    let ball = tree(&bumpy_ball(10, 0.2));
    let trees = (&ball, &ball);
    let mut raised = Front::default();
    let mut lowered = Front::new(FrontOptions::Paper);
    let (mut largest_built, mut memory) = (0, 0);
    for i in 0..6000 {
        let t = 0.05 * i as f32;
        let rotation = Quat::from_rotation_x(0.044 * t) * Quat::from_rotation_y(0.028 * t);
        let pos12 = Pose3::from_parts(Vec3::new(1.9 * (0.013 * t).cos(), 0.0, 0.0), rotation);
        // The second query builds, as nothing moved.
        let mut built = Front::default();
        from_front(&mut built, trees, &pos12, 0.02);
        for front in [&mut raised, &mut lowered, &mut built] {
            from_front(front, trees, &pos12, 0.02);
        }
        largest_built = built.stats().cells.max(largest_built);
        let stats = raised.stats();
        assert!(
            stats.cells <= 2 * largest_built + 64,
            "{stats:?}, {largest_built} at most when built"
        );
        if i == 3000 {
            memory = stats.memory;
        }
    }
    let stats = raised.stats();
    assert!(stats.reused > 5000 && stats.memory <= 2 * memory, "{stats:?}, {memory} bytes before");
    assert!(lowered.stats().cells > 3 * largest_built, "{:?}", lowered.stats());
}

/// At rest nothing is tested at all, and the pairs are there.
#[test]
fn a_pair_that_does_not_move_costs_no_test() {
    let ball = tree(&bumpy_ball(10, 0.2));
    let trees = (&ball, &ball);
    let pos12 = Pose3::from_translation(Vec3::new(1.8, 0.3, 0.1));
    let mut front = Front::default();
    let expected = fresh(trees, &pos12, 0.02);
    assert!(expected.len() > 20);
    let mut counts = DescentCounts::default();
    for query in 0..10 {
        counts = DescentCounts::default();
        let found = within(trees, &pos12, 0.02, |frame, visitor| {
            front.visit(trees, frame, &mut DescentScratch::default(), &mut counts, visitor);
        });
        assert_eq!(found, expected, "query {query}");
    }
    assert_eq!(counts.aabb_tests, 0);
    assert_eq!(front.stats().tested, 0);
    assert_eq!((front.stats().fresh, front.stats().built, front.stats().reused), (1, 1, 8));
}

/// Other trees without `clear`: no panic, whatever is found. With it, what a fresh descent finds.
#[test]
fn a_front_survives_other_trees() {
    let soups = [bumpy_ball(10, 0.2), bumpy_ball(4, 0.1)];
    let trees = soups.each_ref().map(tree);
    let pos12 = Pose3::from_translation(Vec3::new(1.7, 0.3, 0.1));
    for options in BOTH {
        let mut front = Front::new(options);
        for trees in [(&trees[0], &trees[0]), (&trees[1], &trees[0]), (&trees[1], &trees[1])] {
            for _ in 0..3 {
                let found = from_front(&mut front, trees, &pos12, 0.05);
                assert_eq!(found, fresh(trees, &pos12, 0.05));
            }
        }
        front.clear();
        assert_eq!(front.stats().cells, 0);
    }
}

/// Far from the origin, where f32 is coarse, and with the other layer plans.
#[test]
fn coarse_coordinates_and_other_layers() {
    let mut random = Random(7);
    let offset = Vec3::new(3e4, -1e4, 2e4);
    let mut ball = bumpy_ball(6, 0.2);
    ball.vertices.iter_mut().for_each(|v| *v += offset);
    let plans = [
        LayerPlan::SBBK,
        LayerPlan::AABB_ONLY,
        LayerPlan { sphere_root: false, kdop_from_depth: Some(1) },
    ];
    let mut total = 0;
    for layers in plans {
        let options = BuildOptions { layers: Some(layers), ..BuildOptions::default() };
        let tree: Tree = Tree::build(&ball.vertices, &ball.triangles, &options).unwrap();
        for options in BOTH {
            let mut front = Front::new(options);
            let mut rotation = random.rotation();
            for _ in 0..20 {
                rotation = (Quat::from_scaled_axis(random.vector(1e-6)) * rotation).normalize();
                let translation = offset - rotation * offset + Vec3::new(1.8, 0.1, 0.0);
                let pos12 = Pose3::from_parts(translation, rotation);
                let expected = fresh((&tree, &tree), &pos12, 0.05);
                total += expected.len();
                assert_eq!(from_front(&mut front, (&tree, &tree), &pos12, 0.05), expected);
            }
        }
    }
    assert!(total > 1000, "{total}");
}
