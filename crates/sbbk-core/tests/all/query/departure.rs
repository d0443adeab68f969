use glamx::{DPose3, DVec3, Pose3, Quat, Vec3};
use sbbk_core::query::{
    Advance, AdvanceOptions, FoundPair, Meshes, SearchScratch, advance, advance_from_contact,
};
use sbbk_core::traverse::Placement;
use sbbk_core::tree::{BuildOptions, Tree};
use sbbk_core::truth::{TruthPair, pairs_within};

use crate::support::{Random, Soup, bumpy_ball, soup};

/// Meshes this close touch.
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

    /// How fast the normal brings the meshes closer, but for the turning: the caller of the search
    /// decides what an approach is.
    fn approach(&self, normal: DVec3) -> f64 {
        -normal.dot(self.velocity.as_dvec3())
    }

    fn ask(&self, meshes: [&Soup; 2], end: f64) -> Option<Advance<FoundPair>> {
        let [tree1, tree2] = meshes.map(tree);
        let reach = meshes[1].vertices.iter().map(|v| f64::from(v.length())).fold(0.0, f64::max);
        let speed_bound = f64::from(self.velocity.length()) + reach * f64::from(self.spin.length());
        let options = AdvanceOptions {
            start: 0.0,
            end,
            speed_bound: speed_bound * (1.0 + 1e-6),
            tolerance: TOLERANCE,
            step_limit: 100_000,
        };
        let approaches =
            |pair: &FoundPair, _: &Placement| self.approach(pair.contact.normal) > 1e-6;
        let placement_at = |time| Placement::new(&self.at(time));
        let scratch = &mut SearchScratch::default();
        let meshes = &mut Meshes { trees: (&tree1, &tree2), scratch };
        advance_from_contact(meshes, placement_at, options, approaches)
    }
}

fn tree(soup: &Soup) -> Tree {
    Tree::build(&soup.vertices, &soup.triangles, &BuildOptions::default()).expect("valid")
}

/// All pairs of triangles up to a distance, by brute force.
fn truth(meshes: [&Soup; 2], pose: &Pose3, distance: f64) -> Vec<TruthPair> {
    let vertices = |soup: &Soup| soup.vertices.iter().map(|v| v.as_dvec3()).collect::<Vec<_>>();
    let rotation = pose.rotation.as_dquat().normalize();
    let pose = DPose3::from_parts(pose.translation.as_dvec3(), rotation);
    let [one, two] = meshes;
    let (v1, v2) = (vertices(one), vertices(two));
    pairs_within(&v1, &one.triangles, &v2, &two.triangles, pose, distance)
}

fn names(pair: &TruthPair) -> [u32; 2] {
    [pair.triangle1, pair.triangle2]
}

/// What brute force says of the start: the pairs that touch, and whether one approaches; `None`
/// where rounding may decide that.
fn start_of(meshes: [&Soup; 2], motion: &Motion) -> Option<(Vec<TruthPair>, bool)> {
    let near = truth(meshes, &motion.start, 10.0 * TOLERANCE);
    let is_clear = |pair: &TruthPair| {
        let is_sure = pair.normal_is_unique && motion.approach(pair.normal).abs() > 1e-4;
        is_sure && pair.distance < 0.1 * TOLERANCE
    };
    let approaches = near.iter().any(|pair| motion.approach(pair.normal) > 0.0);
    near.iter().all(is_clear).then_some((near, approaches))
}

/// Casts from deep inside, from grazing contact and from apart, against a march with brute force:
/// an impact at the start where a pair that touches approaches, and then the deepest of these; else
/// the first touch of a pair that did not touch. Would catch a pair forgotten at the start, a bound
/// of the distance from a pair that is left out, and an impact passed by.
#[test]
fn beside_a_march() {
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
        let hit = motion.ask(meshes, 1.0);
        if approaches {
            check_start(&motion, &touching, hit);
            at_start += 1;
            continue;
        }
        let left_out: Vec<_> = touching.iter().map(names).collect();
        let others = |time: f64, margin: f64| -> Vec<TruthPair> {
            let all = truth(meshes, &motion.at(time), margin);
            all.into_iter().filter(|pair| !left_out.contains(&names(pair))).collect()
        };
        let end = hit.map_or(1.0, |hit| hit.time);
        for step in 0..40 {
            let time = end * f64::from(step) / 40.0;
            assert!(others(time, 0.0).is_empty(), "case {seed}: met at {time}, before {hit:?}");
        }
        let Some(hit) = hit else {
            never += 1;
            continue;
        };
        assert!(hit.has_converged && hit.time > 0.0, "case {seed}");
        let found = [hit.pair.triangle1, hit.pair.triangle2];
        let near = others(end, 3.0 * TOLERANCE);
        assert!(near.iter().any(|pair| names(pair) == found), "case {seed}: {found:?}, {near:?}");
        later += usize::from(!left_out.is_empty());
    }
    assert!(at_start > 60 && later > 30 && never > 30, "{at_start} {later} {never}");
    assert!(skipped < 150, "{skipped} skipped");
}

fn check_start(motion: &Motion, touching: &[TruthPair], hit: Option<Advance<FoundPair>>) {
    let hit = hit.expect("a pair approaches");
    assert!(hit.time == 0.0 && hit.has_converged);
    let impacts = touching.iter().filter(|pair| motion.approach(pair.normal) > 0.0);
    let deepest = impacts.map(|pair| pair.distance).fold(f64::INFINITY, f64::min);
    assert!((hit.pair.contact.distance - deepest).abs() < 1e-6, "deepest is {deepest}: {hit:?}");
}

/// A tile on a floor, known exactly: pressed down it is stopped at once; lifted, or slid along, it
/// meets the wall or nothing.
#[test]
fn a_tile_on_a_floor() {
    let floor = Soup {
        vertices: vec![
            Vec3::new(-9.0, -9.0, 0.0),
            Vec3::new(30.0, -9.0, 0.0),
            Vec3::new(-9.0, 30.0, 0.0),
            Vec3::new(3.0, -9.0, -1.0),
            Vec3::new(3.0, 9.0, -1.0),
            Vec3::new(3.0, 0.0, 9.0),
        ],
        triangles: vec![[0, 1, 2], [3, 4, 5]],
    };
    let tile = Soup { vertices: vec![Vec3::ZERO, Vec3::X, Vec3::Y], triangles: vec![[0, 1, 2]] };
    for height in [0.0, -0.25] {
        let cast = |velocity: Vec3| {
            // The tile hangs through the floor by a corner, or lies on it.
            let turn = if height < 0.0 { Quat::from_rotation_y(-0.3) } else { Quat::IDENTITY };
            let start = Pose3::from_parts(Vec3::new(0.0, 0.0, 0.5 * height), turn);
            let motion = Motion { start, velocity, spin: Vec3::ZERO };
            motion.ask([&floor, &tile], 10.0)
        };
        let pressed = cast(Vec3::new(0.5, 0.0, -1.0)).expect("is stopped");
        assert_eq!((pressed.time, pressed.pair.triangle1), (0.0, 0));
        assert_eq!(cast(Vec3::new(-0.5, 0.0, 1.0)), None);
        let slid = cast(Vec3::new(0.5, 0.0, 0.0)).expect("meets the wall");
        let reach = if height < 0.0 { 0.3_f64.cos() } else { 1.0 };
        let expected = (3.0 - reach) / 0.5;
        assert!((slid.time - expected).abs() < 1e-5, "{} for {expected}", slid.time);
        assert_eq!(slid.pair.triangle1, 1);
    }
}

/// From apart it is an ordinary advancement.
#[test]
fn from_apart_nothing_is_left_out() {
    let ball = bumpy_ball(4, 0.2);
    let tree = tree(&ball);
    let mut hits = 0;
    for seed in 0..30 {
        let random = &mut Random(seed);
        let start = Pose3::from_parts(4.0 * random.vector(1.0).normalize(), random.rotation());
        let velocity = 2.0 * random.vector(1.0) - 0.3 * start.translation;
        let motion = Motion { start, velocity, spin: random.vector(1.0) };
        let options = AdvanceOptions {
            start: 0.0,
            end: 2.0,
            speed_bound: 8.0,
            tolerance: TOLERANCE,
            step_limit: 1000,
        };
        let scratch = &mut SearchScratch::default();
        let meshes = &mut Meshes { trees: (&tree, &tree), scratch };
        let placement_at = |time| Placement::new(&motion.at(time));
        let plain = advance(meshes, placement_at, options);
        let never = |_: &FoundPair, _: &Placement| panic!("nothing touches at the start");
        assert_eq!(advance_from_contact(meshes, placement_at, options, never), plain);
        hits += usize::from(plain.is_some());
    }
    assert!((5..30).contains(&hits), "{hits} hits");
}

/// Poses and times that are none have no answer.
#[test]
fn numbers_that_are_none() {
    let ball = bumpy_ball(3, 0.1);
    let still = Motion { start: Pose3::IDENTITY, velocity: Vec3::ZERO, spin: Vec3::ZERO };
    assert_eq!(still.ask([&ball; 2], 1.0), None, "nothing moves");
    for bad in [f32::NAN, f32::INFINITY] {
        let start = Pose3::translation(bad, 0.0, 0.0);
        assert_eq!(Motion { start, ..still }.ask([&ball; 2], 1.0), None);
        let velocity = Vec3::new(bad, 0.0, 0.0);
        let start = Pose3::translation(0.5, 0.0, 0.0);
        let hit = Motion { start, velocity, ..still }.ask([&ball; 2], 1.0);
        assert!(hit.is_none_or(|hit| hit.time == 0.0), "{hit:?}");
    }
    assert_eq!(still.ask([&ball; 2], f64::NAN), None);
    assert_eq!(still.ask([&ball; 2], -1.0), None);
    // Pole against pole.
    let start = Pose3::translation(0.0, 0.0, 2.000_000_5);
    let closer = Motion { start, velocity: -Vec3::Z, ..still };
    assert!(closer.ask([&ball; 2], 0.0).is_some_and(|hit| hit.time == 0.0));
    assert_eq!(closer.ask([&ball; 2], -1.0), None, "it ends before it starts");
}
