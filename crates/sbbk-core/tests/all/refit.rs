//! Refits: volumes as tight as those of a build around vertices that moved, and descents that lose
//! nothing.

use std::collections::BTreeSet;

use crate::support::{Random, Soup, bumpy_ball, lattice_soup, soup};
use glamx::{DPose3, DVec3, Pose3, Vec3};
use sbbk_core::leaf::LeafTest;
use sbbk_core::traverse::{Descent, DescentScratch, PairFrame, Verdict, Visitor, descend};
use sbbk_core::tree::{BuildError, BuildOptions, LayerPlan, LeafBatch, RefitCost, Tree};
use sbbk_core::truth::pairs_within;
use sbbk_core::volumes::{DirectionSet, Directions, Sphere};

const PLANS: [LayerPlan; 4] = [
    LayerPlan::SBBK,
    LayerPlan::AABB_ONLY,
    LayerPlan { sphere_root: false, kdop_from_depth: Some(1) },
    LayerPlan { sphere_root: false, kdop_from_depth: Some(6) },
];

fn build<const AXES: usize>(soup: &Soup, layers: LayerPlan) -> Tree<AXES>
where
    Directions<AXES>: DirectionSet<AXES>,
{
    let options = BuildOptions { layers: Some(layers), ..BuildOptions::default() };
    Tree::build(&soup.vertices, &soup.triangles, &options)
        .expect("the soups of these tests are valid")
}

fn deformed(soup: &Soup, deform: impl FnMut(Vec3) -> Vec3) -> Soup {
    let vertices = soup.vertices.iter().copied().map(deform).collect();
    Soup { vertices, triangles: soup.triangles.clone() }
}

/// All that a tree holds except sphere and statistics, digit for digit.
fn content<const AXES: usize>(tree: &Tree<AXES>) -> String {
    let all = format!("{tree:?}");
    let from = all.find("aabb_pairs").expect("the boxes follow the sphere");
    let to = all.find("stats").expect("the statistics come last");
    all[from..to].to_owned()
}

/// A bend, a twist and a crumple whose size changes from frame to frame.
fn at_frame(soup: &Soup, frame: u32, random: &mut Random) -> Soup {
    let phase = 0.05 * frame as f32;
    let crumple = 0.02 * (frame % 7) as f32;
    deformed(soup, |v| {
        let bent = v + Vec3::new(
            0.3 * (3.0 * v.y + phase).sin(),
            0.2 * (2.0 * v.x).cos() * phase.sin(),
            0.0,
        );
        let (sin, cos) = (0.5 * v.z * phase.cos()).sin_cos();
        Vec3::new(cos * bent.x - sin * bent.y, sin * bent.x + cos * bent.y, bent.z)
            + random.vector(crumple)
    })
}

/// A mesh twice as large has the same hierarchy, with all numbers twice as large. Would catch a
/// volume that is not that of a build: looser, rounded twice, or of other corners; a stale leaf or
/// magnitude.
fn check_tightness<const AXES: usize>()
where
    Directions<AXES>: DirectionSet<AXES>,
{
    let mut random = Random(31);
    for (count, plan) in [1, 3, 8, 9, 40, 400].into_iter().flat_map(|n| PLANS.map(|plan| (n, plan)))
    {
        let small = soup(&mut random, count, 0.3);
        let large = deformed(&small, |v| v * 2.0);
        let mut tree = build::<AXES>(&small, plan);
        let before = content(&tree);
        assert_ne!(before, content(&build::<AXES>(&large, plan)));
        tree.refit(&large.vertices, &large.triangles).unwrap();
        assert_eq!(content(&tree), content(&build::<AXES>(&large, plan)));
        // Over shapes that have nothing to do with it and back: nothing is left of them.
        let other = at_frame(&small, 3, &mut random);
        tree.refit(&other.vertices, &other.triangles).unwrap();
        tree.refit(&small.vertices, &small.triangles).unwrap();
        assert_eq!(content(&tree), before);
    }
}

#[test]
fn volumes_are_those_of_a_build() {
    check_tightness::<7>();
    check_tightness::<9>();
    check_tightness::<13>();
}

/// Would catch a corner outside of its volumes, in any layer of any plan, and a sphere that is
/// wrong or needlessly large.
#[test]
fn refitted_trees_contain_their_triangles() {
    let mut random = Random(32);
    for round in 0..60 {
        let soup = match round % 3 {
            0 => soup(&mut random, 1 + round * 5, 0.3),
            1 => lattice_soup(&mut random, 1 + round * 5, 3),
            _ => bumpy_ball(3 + round / 6, 0.2),
        };
        let mut trees = PLANS.map(|plan| build::<9>(&soup, plan));
        for frame in 0..4 {
            let size = 10f32.powi(random.range(-12.0, 12.0) as i32);
            let distance = size * 10f32.powi(random.range(-1.0, 5.0) as i32);
            let offset = random.vector(distance);
            let moved = at_frame(&soup, frame, &mut random);
            let moved = deformed(&moved, |v| v * size + offset);
            for tree in &mut trees {
                tree.refit(&moved.vertices, &moved.triangles).unwrap();
                assert_eq!(tree.validate(), Ok(()));
                let largest = moved.vertices.iter().map(|v| v.abs().max_element());
                let largest = largest.fold(0.0, f32::max);
                assert!(tree.magnitude() <= largest && tree.magnitude() > 0.0);
                if let Some(sphere) = tree.sphere() {
                    let fit = Sphere::fit(&moved.vertices).radius;
                    assert!(sphere.radius <= 1.5 * fit + 1e-5 * largest, "{sphere:?}, fit {fit}");
                }
            }
        }
    }
}

struct Survivors {
    test: LeafTest,
    pairs: BTreeSet<(u32, u32)>,
}

impl Visitor for Survivors {
    fn leaves(&mut self, _: u32, batch1: &LeafBatch, _: u32, batch2: &LeafBatch) -> Verdict {
        self.test.survivors(batch1, batch2, |i, j| {
            self.pairs.insert((batch1.triangles()[i], batch2.triangles()[j]));
        });
        Verdict::Descend
    }
}

fn survivors(trees: (&Tree, &Tree), pos12: &Pose3, margin: f32) -> BTreeSet<(u32, u32)> {
    let mut frame = PairFrame::new(trees.0, trees.1, pos12, margin);
    let mut visitor = Survivors { test: LeafTest::new(&frame), pairs: BTreeSet::new() };
    let mut scratch = DescentScratch::default();
    descend(trees, &mut frame, Descent::Simultaneous, &mut scratch, (), &mut visitor);
    visitor.pairs
}

fn truth([one, two]: [&Soup; 2], pos12: &Pose3, margin: f32) -> BTreeSet<(u32, u32)> {
    let pose =
        DPose3 { rotation: pos12.rotation.as_dquat(), translation: pos12.translation.as_dvec3() };
    let wide = |soup: &Soup| soup.vertices.iter().map(|v| v.as_dvec3()).collect::<Vec<DVec3>>();
    let pairs = pairs_within(
        &wide(one),
        &one.triangles,
        &wide(two),
        &two.triangles,
        pose,
        f64::from(margin),
    );
    pairs.into_iter().map(|pair| (pair.triangle1, pair.triangle2)).collect()
}

/// 500 frames, one tree refitted through all of them. Would catch a pair of triangles that the
/// refitted tree does not find and a fresh one, or brute force, does. Leaf volumes of a refitted
/// tree are looser, so it may hand more pairs to the leaf test, but that test sees the triangles
/// alone and passes the same ones.
#[test]
fn descents_find_what_brute_force_and_a_rebuilt_tree_find() {
    let mut random = Random(33);
    let (soft, rigid) = (bumpy_ball(7, 0.15), bumpy_ball(6, 0.3));
    let mut tree = build::<9>(&soft, LayerPlan::SBBK);
    let other = build::<9>(&rigid, LayerPlan::SBBK);
    let mut touching = 0;
    for frame in 0..500 {
        let now = at_frame(&soft, frame, &mut random);
        tree.refit(&now.vertices, &now.triangles).unwrap();
        let rebuilt = build::<9>(&now, LayerPlan::SBBK);
        let pos12 = Pose3::from_parts(random.vector(1.0).normalize() * 1.9, random.rotation());
        let margin = random.range(0.0, 0.1);
        let truth = truth([&now, &rigid], &pos12, margin);
        touching += usize::from(!truth.is_empty());
        let found = survivors((&tree, &other), &pos12, margin);
        assert!(truth.is_subset(&found), "frame {frame} lost pairs");
        let swapped = survivors((&other, &tree), &pos12.inverse(), margin);
        assert!(truth.iter().all(|&(one, two)| swapped.contains(&(two, one))), "frame {frame}");
        let fresh = survivors((&rebuilt, &other), &pos12, margin);
        assert!(truth.is_subset(&fresh), "frame {frame}: the rebuilt tree lost pairs");
        let spare = found.len().abs_diff(fresh.len());
        assert!(spare <= 2 + fresh.len() / 10, "{} pairs, fresh {}", found.len(), fresh.len());
    }
    assert!(touching > 200, "only {touching} frames with contacts");
}

/// Would catch a tree that is half of the old mesh and half of the new one after an error, a fault
/// that goes unseen, and an unused vertex that does harm.
#[test]
fn faults_leave_the_tree_as_it_was() {
    let mut ball = bumpy_ball(6, 0.2);
    ball.vertices.push(Vec3::NAN);
    ball.vertices.push(Vec3::splat(1e30));
    let mut tree = build::<9>(&ball, LayerPlan::SBBK);
    let before = format!("{tree:?}");
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for (vertex, axis) in (0..ball.vertices.len() - 2).step_by(5).flat_map(|v| [(v, 0), (v, 2)])
        {
            let mut broken = ball.vertices.clone();
            if !ball.triangles.as_flattened().contains(&(vertex as u32)) {
                continue;
            }
            broken[vertex][axis] = value;
            let error = tree.refit(&broken, &ball.triangles).unwrap_err();
            assert!(
                matches!(error, BuildError::NotFinite { vertex: v, .. } if v as usize == vertex)
            );
            assert_eq!(format!("{tree:?}"), before);
        }
    }
    let few = &ball.vertices[..10];
    let error = tree.refit(few, &ball.triangles).unwrap_err();
    assert!(matches!(error, BuildError::IndexOutOfRange { vertex_count: 10, .. }));
    let error = tree.refit(&ball.vertices, &ball.triangles[1..]).unwrap_err();
    assert!(matches!(error, BuildError::OtherTriangleCount { .. }), "{error}");
    assert_eq!(format!("{tree:?}"), before);

    let moved = deformed(&ball, |v| v + Vec3::X);
    tree.refit(&moved.vertices, &moved.triangles).unwrap();
    assert_eq!(tree.validate(), Ok(()));
    let radius = tree.sphere().unwrap().radius;
    assert!(radius < 4.0, "unused vertices make the sphere {radius} large");
}

/// A mesh that collapses to a plane, a line, a point, and comes back.
#[test]
fn collapsed_meshes_have_valid_trees() {
    let ball = bumpy_ball(8, 0.2);
    let mut tree = build::<9>(&ball, LayerPlan::SBBK);
    let before = content(&tree);
    for scale in [Vec3::new(1.0, 0.0, 1.0), Vec3::X, Vec3::ZERO, Vec3::splat(1e-30)] {
        let flat = deformed(&ball, |v| v * scale + Vec3::Y);
        let cost = tree.refit(&flat.vertices, &flat.triangles).unwrap();
        assert_eq!(tree.validate(), Ok(()));
        assert!(cost.now.is_finite() && cost.now >= 0.0, "{cost:?}");
    }
    tree.refit(&ball.vertices, &ball.triangles).unwrap();
    assert_eq!(content(&tree), before);
}

/// The measure is that of the build, stays where nothing but place and size change, and grows where
/// what was together is torn apart.
#[test]
fn the_cost_tells_when_to_rebuild() {
    let ball = bumpy_ball(20, 0.1);
    let mut tree = build::<9>(&ball, LayerPlan::SBBK);
    let mut refit =
        |soup: &Soup| -> RefitCost { tree.refit(&soup.vertices, &soup.triangles).unwrap() };
    let same = refit(&ball);
    assert!((same.now / same.built - 1.0).abs() < 1e-4, "{same:?}");
    let moved = refit(&deformed(&ball, |v| 3.0 * v + Vec3::splat(20.0)));
    assert!((moved.now / moved.built - 1.0).abs() < 1e-2 && !moved.needs_rebuild(), "{moved:?}");
    let mut random = Random(34);
    let shuffled = deformed(&ball, |_| random.vector(1.0));
    let cost = refit(&shuffled);
    assert!(cost.needs_rebuild(), "{cost:?}");
    let rebuilt = build::<9>(&shuffled, LayerPlan::SBBK).stats().sah_cost;
    assert!(rebuilt < cost.now, "a rebuild pays: {rebuilt} against {cost:?}");
}
