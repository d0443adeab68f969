//! Conservative advancement of meshes that move and turn, from apart and from contact.

use super::{all_pairs, exact, least, pairs_within, tree, triangle};
use crate::prelude::*;
use sbbk_core::query::{Advance, AdvanceOptions, MeshBodies, advance, advance_from_contact};
use sbbk_truth::TruthPair;

/// MeshBodies this close touch.
const TOLERANCE: f64 = 1e-6;

/// Mesh 2 moves and turns in the frame of mesh 1.
struct Motion {
    start: Pose3,
    velocity: Vec3,
    spin: Vec3,
}

impl Motion {
    fn at(&self, time: f64) -> Pose3 {
        let turn = Quat::from_scaled_axis(self.spin * time as f32);
        let place = self.start.translation + self.velocity * time as f32;
        Pose3::from_parts(place, turn * self.start.rotation)
    }

    /// Speed of approach along a normal, without the turning.
    fn approach(&self, normal: DVec3) -> f64 {
        -normal.dot(self.velocity.as_dvec3())
    }

    fn options(&self, mesh2: &Soup, end: f64) -> AdvanceOptions {
        let reach = mesh2.vertices.iter().map(|v| f64::from(v.length())).fold(0.0, f64::max);
        let speed = f64::from(self.velocity.length()) + reach * f64::from(self.spin.length());
        AdvanceOptions {
            start: 0.0,
            end,
            speed_bound: speed * (1.0 + 1e-6),
            tolerance: TOLERANCE,
            step_limit: 100_000,
        }
    }

    fn advance(&self, meshes: [&Soup; 2], end: f64) -> Option<Advance<FoundPair>> {
        let [tree1, tree2] = meshes.map(tree);
        let scratch = &mut SearchScratch::default();
        let bodies = &mut MeshBodies { trees: (&tree1, &tree2), scratch };
        advance(bodies, &[], |time| Placement::new(&self.at(time)), self.options(meshes[1], end))
    }

    fn advance_from_contact(&self, meshes: [&Soup; 2], end: f64) -> Option<Advance<FoundPair>> {
        let [tree1, tree2] = meshes.map(tree);
        let scratch = &mut SearchScratch::default();
        let bodies = &mut MeshBodies { trees: (&tree1, &tree2), scratch };
        let placement_at = |time| Placement::new(&self.at(time));
        let approaches =
            |pair: &FoundPair, _: &Placement| self.approach(pair.contact.normal) > 1e-6;
        advance_from_contact(bodies, placement_at, self.options(meshes[1], end), approaches)
    }
}

#[test]
fn advancement_from_apart_stops_at_the_first_touch() {
    let ball = bumpy_ball(4, 0.2);
    let mut random = Random(11);
    let mut hits = 0;
    for _ in 0..40 {
        let side = 2.5 * random.vector(1.0).with_x(0.0);
        let motion = Motion {
            start: Pose3::from_translation(Vec3::new(5.0, 0.0, 0.0) + side),
            velocity: -2.0 * Vec3::X,
            spin: 2.0 * random.vector(1.0).normalize(),
        };
        let found = motion.advance([&ball; 2], 4.0);
        assert_eq!(motion.advance_from_contact([&ball; 2], 4.0), found);
        let end = found.map_or(4.0, |found| found.time);
        let distance_at = |time: f64| least(&all_pairs([&ball; 2], &motion.at(time), DVec3::ZERO));
        for step in 0..8 {
            assert!(distance_at(end * f64::from(step) / 8.0) > 0.0, "met before {end}");
        }
        if let Some(found) = found {
            hits += 1;
            assert!(found.has_converged && distance_at(end) < 2.0 * TOLERANCE, "{found:?}");
        }
    }
    assert!((5..36).contains(&hits), "{hits} hits");
}

#[test]
fn advancement_uses_the_last_moment_and_the_last_step() {
    let floor = tree(&triangle([[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]));
    let fall = |options| {
        let placement_at = |time| Placement::new(&Pose3::translation(0.5, 0.5, 1.0 - time as f32));
        let scratch = &mut SearchScratch::default();
        advance(&mut MeshBodies { trees: (&floor, &floor), scratch }, &[], placement_at, options)
    };
    let exact =
        AdvanceOptions { start: 0.0, end: 4.0, speed_bound: 1.0, tolerance: 0.0, step_limit: 10 };
    let hit = fall(exact).expect("they meet");
    assert!(hit.has_converged && hit.time == 1.0, "{hit:?}");
    let hit = fall(AdvanceOptions { step_limit: 0, ..exact }).expect("a bound of the time");
    assert!(!hit.has_converged && hit.time == 0.0, "{hit:?}");
    let near = AdvanceOptions { tolerance: 0.125, ..exact };
    let hit = fall(AdvanceOptions { start: 0.9375, end: 0.9375, ..near }).expect("they are near");
    assert!(hit.has_converged && hit.time == 0.9375, "{hit:?}");
    assert!(fall(AdvanceOptions { end: 0.9375, ..near }).is_none_or(|hit| hit.time <= 0.9375));
}

/// Pairs that touch at the start by brute force, and if one of them approaches; `None` if rounding
/// may decide that.
fn start_of(meshes: [&Soup; 2], motion: &Motion) -> Option<(Vec<TruthPair>, bool)> {
    let near = pairs_within(meshes, exact(&motion.start), 10.0 * TOLERANCE);
    let is_clear = |pair: &TruthPair| {
        let is_sure = pair.normal_is_unique && motion.approach(pair.normal).abs() > 1e-4;
        is_sure && pair.distance < 0.1 * TOLERANCE
    };
    let approaches = near.iter().any(|pair| motion.approach(pair.normal) > 0.0);
    near.iter().all(is_clear).then_some((near, approaches))
}

/// An impact at the start is the deepest pair that approaches. Otherwise the impact is the first
/// touch of a pair that did not touch at the start.
#[test]
fn advancement_from_contact_agrees_with_a_march() {
    let (mut at_start, mut later, mut never, mut skipped) = (0, 0, 0, 0);
    let ball = bumpy_ball(3, 0.1);
    for seed in 0..500 {
        let random = &mut Random(seed);
        let soups = [4, 3].map(|count| soup(random, count, 0.8));
        let meshes = if seed % 5 == 0 { [&ball, &soups[1]] } else { [&soups[0], &soups[1]] };
        let start = random.pose(0.7);
        let [velocity, spin] = [random.vector(2.0), random.vector(1.5)];
        let motion = Motion { start, velocity, spin };
        let Some((touching, approaches)) = start_of(meshes, &motion) else {
            skipped += 1;
            continue;
        };
        let hit = motion.advance_from_contact(meshes, 1.0);
        if approaches {
            let hit = hit.expect("a pair approaches");
            assert!(hit.time == 0.0 && hit.has_converged);
            let impacts = touching.iter().filter(|pair| motion.approach(pair.normal) > 0.0);
            let deepest = impacts.map(|pair| pair.distance).fold(f64::INFINITY, f64::min);
            assert!((hit.pair.contact.distance - deepest).abs() < 1e-6, "{deepest}: {hit:?}");
            at_start += 1;
            continue;
        }
        let left_out: Vec<_> = touching.iter().map(|pair| pair.triangles).collect();
        let others = |time: f64, margin: f64| -> Vec<[u32; 2]> {
            let all = pairs_within(meshes, exact(&motion.at(time)), margin);
            all.iter().map(|pair| pair.triangles).filter(|pair| !left_out.contains(pair)).collect()
        };
        let end = hit.map_or(1.0, |hit| hit.time);
        for time in (0..40).map(|step| end * f64::from(step) / 40.0) {
            assert!(others(time, 0.0).is_empty(), "case {seed}: met at {time}, before {hit:?}");
        }
        let Some(hit) = hit else {
            never += 1;
            continue;
        };
        assert!(hit.has_converged && hit.time > 0.0, "case {seed}");
        let found = [hit.pair.triangle1, hit.pair.triangle2];
        assert!(others(end, 3.0 * TOLERANCE).contains(&found), "case {seed}: {found:?}");
        later += usize::from(!left_out.is_empty());
    }
    assert!(at_start > 60 && later > 30 && never > 30, "{at_start} {later} {never}");
    assert!(skipped < 150, "{skipped} skipped");
}

#[test]
fn a_tile_on_a_floor_meets_the_floor_or_a_wall() {
    let corners = [
        [-9.0, -9.0, 0.0],
        [30.0, -9.0, 0.0],
        [-9.0, 30.0, 0.0],
        [3.0, -9.0, -1.0],
        [3.0, 9.0, -1.0],
        [3.0, 0.0, 9.0],
    ];
    let vertices = corners.map(Vec3::from_array).to_vec();
    let floor = Soup { vertices, triangles: vec![[0, 1, 2], [3, 4, 5]] };
    let tile = triangle([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    // The tile lies on the floor, or hangs through it by a corner.
    for (height, lean) in [(0.0, 0.0_f32), (-0.125, -0.3)] {
        let start = Pose3::from_parts(Vec3::new(0.0, 0.0, height), Quat::from_rotation_y(lean));
        let moved = |velocity: Vec3| {
            let motion = Motion { start, velocity, spin: Vec3::ZERO };
            motion.advance_from_contact([&floor, &tile], 10.0)
        };
        let pressed = moved(Vec3::new(0.5, 0.0, -1.0)).expect("is stopped");
        assert_eq!((pressed.time, pressed.pair.triangle1), (0.0, 0));
        assert_eq!(moved(Vec3::new(-0.5, 0.0, 1.0)), None);
        let slid = moved(Vec3::new(0.5, 0.0, 0.0)).expect("meets the wall");
        let expected = (3.0 - f64::from(lean).cos()) / 0.5;
        assert!((slid.time - expected).abs() < 1e-5, "{} for {expected}", slid.time);
        assert_eq!(slid.pair.triangle1, 1);
    }
}

#[test]
fn non_finite_poses_and_times_have_no_impact() {
    let ball = bumpy_ball(3, 0.1);
    let still = Motion { start: Pose3::IDENTITY, velocity: Vec3::ZERO, spin: Vec3::ZERO };
    let end_of = |motion: Motion, end| motion.advance_from_contact([&ball; 2], end);
    let from = |start| Motion { start, ..still };
    for end in [1.0, f64::NAN, -1.0] {
        assert_eq!(end_of(from(Pose3::IDENTITY), end), None);
    }
    for bad in [f32::NAN, f32::INFINITY] {
        assert_eq!(end_of(from(Pose3::translation(bad, 0.0, 0.0)), 1.0), None);
        let start = Pose3::translation(0.5, 0.0, 0.0);
        let hit = end_of(Motion { start, velocity: Vec3::new(bad, 0.0, 0.0), ..still }, 1.0);
        assert!(hit.is_none_or(|hit| hit.time == 0.0), "{hit:?}");
    }
    // Pole against pole.
    let closer = |end| {
        let start = Pose3::translation(0.0, 0.0, 2.000_000_5);
        end_of(Motion { start, velocity: -Vec3::Z, ..still }, end)
    };
    assert!(closer(0.0).is_some_and(|hit| hit.time == 0.0));
    assert_eq!(closer(-1.0), None, "it ends before it starts");
}
