use glamx::{DVec3, Pose3, Quat, Vec3};
use proptest::prelude::*;
use sbbk_core::query::{AdvanceOptions, Cast, CastOptions, Meshes, SearchScratch, advance, cast};
use sbbk_core::traverse::Placement;
use sbbk_core::tree::{BuildOptions, Tree};

use super::truth::{all_pairs, least, of};
use crate::support::{Random, Soup, bumpy_ball, soup};

fn tree(soup: &Soup) -> Tree {
    Tree::build(&soup.vertices, &soup.triangles, &BuildOptions::default()).expect("valid")
}

fn options(max_time: f32, target_distance: f32) -> CastOptions {
    CastOptions { max_time, target_distance, stop_at_penetration: true }
}

fn ask(meshes: [&Soup; 2], pose: &Pose3, velocity: Vec3, options: CastOptions) -> Option<Cast> {
    let [tree1, tree2] = meshes.map(tree);
    let mut scratch = SearchScratch::default();
    cast((&tree1, &tree2), Placement::new(pose), velocity, options, &mut scratch)
}

/// The least distance of all pairs after a time.
fn distance_at(meshes: [&Soup; 2], pose: &Pose3, velocity: Vec3, time: f64) -> f64 {
    least(&all_pairs(meshes, pose, velocity.as_dvec3() * time))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(50))]

    /// Against a march in 200 steps with the distance of all pairs: nothing is met before the time
    /// of impact, and the meshes are at the target distance then. Would catch an impact passed by,
    /// or found too early.
    #[test]
    fn beside_a_march(seed: u64, target in prop::sample::select(vec![0.0_f32, 0.05, 0.5])) {
        let mut random = Random(seed);
        let [one, two] = [6, 5].map(|count| soup(&mut random, count, 0.6));
        let pose = Pose3::from_parts(4.0 * random.vector(1.0).normalize(), random.rotation());
        let velocity = 0.7 * random.vector(1.0) - 0.5 * pose.translation;
        let hit = ask([&one, &two], &pose, velocity, options(3.0, target));
        let target = f64::from(target);
        let end = hit.map_or(3.0, |hit| hit.time);
        // At a start within the target distance there is nothing before it.
        let steps = if hit.is_some_and(|hit| hit.is_penetrating) { 0 } else { 200 };
        for step in 0..steps {
            let time = end * f64::from(step) / 200.0;
            let distance = distance_at([&one, &two], &pose, velocity, time);
            prop_assert!(distance > target - 1e-5, "{distance} at {time}, before {hit:?}");
        }
        if let Some(Cast { time, pair, is_penetrating }) = hit {
            let pairs = all_pairs([&one, &two], &pose, velocity.as_dvec3() * time);
            let distance = of(&pairs, [pair.triangle1, pair.triangle2]);
            let starts_within = distance_at([&one, &two], &pose, velocity, 0.0) < target;
            prop_assert_eq!(is_penetrating, starts_within);
            prop_assert!(starts_within || (distance - target).abs() < 1e-5);
        }
    }
}

/// Not vacuous: most of the casts above hit, some do not. And the counterpart, a cast that must go
/// through.
#[test]
fn some_hit_and_some_miss() {
    let ball = bumpy_ball(12, 0.0);
    let mut random = Random(3);
    for target in [0.0, 0.5] {
        let (reach, mut hits) = (2.0 + target, 0);
        for _ in 0..100 {
            let pose = Pose3::from_parts(Vec3::new(-5.0, 0.0, 0.0), random.rotation());
            let side = 2.0 * reach * random.range(0.0, 1.0);
            let pose = Pose3::from_parts(pose.translation + side * Vec3::Y, pose.rotation);
            let hit = ask([&ball; 2], &pose, Vec3::X, options(100.0, target));
            // Between the balls in and around the polyhedra.
            if side < reach - 0.1 {
                let depth = 5.0 - (reach * reach - side * side).sqrt();
                let time = hit.expect("the balls meet").time;
                assert!((time - f64::from(depth)).abs() < 0.2, "{time}, spheres at {depth}");
                hits += 1;
            } else if side > reach {
                assert_eq!(hit, None);
            }
        }
        assert!((20..80).contains(&hits));
    }
}

/// Would catch an impact lost to the rounding of its bounds, and one that is too late: each is there
/// until its very time.
#[test]
fn impacts_count_until_the_last_moment() {
    let mut random = Random(17);
    let mut hits = 0;
    for i in 0..1500 {
        let [mut one, mut two] = [12, 9].map(|count| soup(&mut random, count, 0.6));
        let mut pose = Pose3::from_parts(4.0 * random.vector(1.0).normalize(), random.rotation());
        let velocity = 0.7 * random.vector(1.0) - 0.5 * pose.translation;
        if i % 4 > 1 {
            // Both far from their origins.
            let [far1, far2] = [1000.0 * Vec3::ONE, 700.0 * Vec3::Y];
            one.vertices.iter_mut().for_each(|v| *v += far1);
            two.vertices.iter_mut().for_each(|v| *v += far2);
            pose.translation += far1 - pose.rotation * far2;
        }
        // Along an axis too.
        let velocity = if i % 3 == 0 { velocity * Vec3::AXES[i % 9 / 3] } else { velocity };
        let target = [0.0, 0.05][i % 2];
        let ask = |max_time| ask([&one, &two], &pose, velocity, options(max_time, target));
        let Some(hit) = ask(f32::INFINITY).filter(|hit| hit.time > 0.0) else { continue };
        hits += 1;
        let time = hit.time as f32;
        assert_eq!(ask(time.next_up()), Some(hit));
        assert_eq!(ask(0.999 * time), None);
    }
    assert!(hits > 500, "{hits} hits");
}

/// Would catch the normal of corners that touch, which could be any, in place of that of corners just
/// apart.
#[test]
fn the_normal_is_that_before_the_impact() {
    let way = Vec3::new(0.3, -0.2, 1.0);
    let below = |x: Vec3| Soup {
        vertices: vec![Vec3::ZERO, x - Vec3::X, x + Vec3::new(0.7, 0.9, 0.0)],
        triangles: vec![[0, 1, 2]],
    };
    let meshes = [&below(-2.0 * Vec3::Z), &below(2.0 * Vec3::Z)];
    let hit =
        ask(meshes, &Pose3::from_translation(way), -way, options(2.0, 0.0)).expect("corners meet");
    assert!((hit.time - 1.0).abs() < 1e-9);
    assert!((hit.pair.contact.normal - way.as_dvec3().normalize()).length() < 1e-6, "{hit:?}");
}

/// Face against face, known exactly; a limit of time before and after; the way out of a
/// penetration.
#[test]
fn statuses() {
    let floor = Soup {
        vertices: vec![Vec3::ZERO, 4.0 * Vec3::X, 4.0 * Vec3::Y],
        triangles: vec![[0, 1, 2]],
    };
    let above = |height: f32| Pose3::translation(0.5, 0.5, height);
    let down = -2.0 * Vec3::Z;
    let hit = ask([&floor; 2], &above(3.0), down, options(10.0, 0.0)).expect("falls on it");
    assert!((hit.time - 1.5).abs() < 1e-12 && !hit.is_penetrating);
    assert!((hit.pair.contact.normal - DVec3::Z).length() < 1e-9);
    let hit = ask([&floor; 2], &above(3.0), down, options(10.0, 1.0)).expect("comes to 1 unit");
    assert!((hit.time - 1.0).abs() < 1e-12 && !hit.is_penetrating);
    assert!((hit.pair.contact.distance - 1.0).abs() < 1e-12);
    assert_eq!(ask([&floor; 2], &above(3.0), down, options(1.49, 0.0)), None);
    assert_eq!(ask([&floor; 2], &above(3.0), -down, options(10.0, 0.0)), None);
    assert_eq!(ask([&floor; 2], &above(3.0), Vec3::ZERO, options(10.0, 0.0)), None);
    let hit = ask([&floor; 2], &above(1.0), down, options(10.0, 1.0)).expect("starts at 1 unit");
    assert!(hit.time == 0.0 && !hit.is_penetrating);
    for none in [-1.0, f32::NAN] {
        assert_eq!(ask([&floor; 2], &above(0.0), down, options(none, 0.0)), None);
    }
    assert_eq!(ask([&floor; 2], &above(3.0), down, options(10.0, -1.0)), None);

    let within = options(10.0, 1.0);
    let through = CastOptions { stop_at_penetration: false, ..within };
    for (velocity, passes) in [(down, false), (-down, true)] {
        let hit = ask([&floor; 2], &above(0.5), velocity, within).expect("starts within 1 unit");
        assert!(hit.time == 0.0 && hit.is_penetrating);
        assert_eq!(ask([&floor; 2], &above(0.5), velocity, through).is_none(), passes);
    }
}

/// A triangle by its corners.
fn triangle(corners: [[f32; 3]; 3]) -> Soup {
    Soup { vertices: corners.map(Vec3::from_array).to_vec(), triangles: vec![[0, 1, 2]] }
}

/// Would catch boxes of triangles that pass each other where corners just touch, beside a side that
/// stands still or a long way off, where the corners miss each other by less than rounding; an impact
/// after the last moment of triangles whose boxes meet before; and a gap of less than rounding that
/// counts.
#[test]
fn triangles_that_just_touch_are_met() {
    let origin = Pose3::IDENTITY;
    let below = triangle([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
    let above = triangle([[-2.0, 1.0, 0.0], [-3.0, 2.0, 0.0], [-3.0, 2.0, 1.0]]);
    let hit = ask([&below, &above], &origin, Vec3::X, options(5.0, 0.0)).expect("corners meet");
    assert!((hit.time - 2.0).abs() < 1e-9, "{hit:?}");

    // They leave each other along y a part in 10¹⁴ of the time before they meet along x.
    let right = triangle([[0.0; 3], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0]]);
    let left = triangle([[0.0; 3], [-1.0, -1.0, 0.0], [-1.0, -1.0, 1.0]]);
    let away = Pose3::translation(-16_777_215.0, 16_777_213.0, 0.0);
    let velocity = Vec3::new(8_388_608.0, -8_388_607.0, 0.0);
    let hit = ask([&right, &left], &away, velocity, options(5.0, 0.0)).expect("corners meet");
    assert!((hit.time - 2.0).abs() < 1e-6, "{hit:?}");

    let wall = triangle([[0.0; 3], [1.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    let small = triangle([[0.9, 0.1, 0.1], [0.9, 0.11, 0.1], [0.9, 0.1, 0.11]]);
    let ask_until = |end| ask([&wall, &small], &origin, -Vec3::X, options(end, 0.0));
    assert!(ask_until(1.0).is_some());
    assert_eq!(ask_until(0.5), None);

    let wide = triangle([[0.0; 3], [1e6, 0.0, 0.0], [0.0, 1e6, 0.0]]);
    let hardly = Pose3::translation(0.0, 0.0, 2.0_f32.powi(-24));
    let hit = ask([&wide; 2], &hardly, Vec3::Z, options(1.0, 0.0)).expect("they touch");
    assert!(hit.time == 0.0 && hit.pair.is_touching, "{hit:?}");
}

/// Would catch walls that small boxes far from the origin pass over by less than rounding, where a
/// corner grazes the top edge: among other triangles the answer is that of the two alone, which have
/// no boxes.
#[test]
fn rounding_lets_no_corner_pass() {
    let mut random = Random(23);
    let mut hits = 0;
    for _ in 0..1000 {
        let [top, far] = [0; 2].map(|_| 1000.0 * random.vector(1.0));
        let turn = random.rotation();
        let wall = [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]].map(Vec3::from_array);
        // Its last corner is the lowest one of its box in the frame of the wall.
        let lowest = -(turn.inverse() * Vec3::Y).signum();
        let with_others = |corners: [Vec3; 3], at: Vec3| {
            let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
            let part =
                |i| corners.map(|v| at + 0.002 * v.lerp(middle, if i > 0 { 0.5 } else { 0.0 }));
            let vertices = (0..12).flat_map(part).collect();
            Soup { vertices, triangles: (0..12).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect() }
        };
        let meshes =
            [with_others(wall, top), with_others([Vec3::ZERO, lowest.with_x(0.0), lowest], far)];
        let alone = meshes
            .each_ref()
            .map(|soup| Soup { vertices: soup.vertices[..3].to_vec(), triangles: vec![[0, 1, 2]] });
        let corner = turn * alone[1].vertices[2];
        let pose = Pose3::from_parts(top + 0.01 * Vec3::X - corner, turn);
        let ask = |[one, two]: &[Soup; 2]| {
            ask([one, two], &pose, -Vec3::X, options(1.0, 0.0)).map(|hit| hit.time)
        };
        let hit = ask(&alone);
        hits += i32::from(hit.is_some());
        assert!(hit.is_none() || ask(&meshes) == hit, "{hit:?} {:?}", ask(&meshes));
    }
    assert!(hits > 300, "{hits} hits");
}

/// Numbers that are none have no answer.
#[test]
fn numbers_that_are_none() {
    let ball = bumpy_ball(6, 0.1);
    let pose = Pose3::translation(5.0, 0.0, 0.0);
    for bad in [f32::NAN, f32::INFINITY] {
        assert_eq!(ask([&ball; 2], &pose, Vec3::new(bad, 0.0, 0.0), options(1.0, 0.0)), None);
        assert_eq!(ask([&ball; 2], &pose, -Vec3::X, options(1.0, bad)), None);
        let nowhere = Pose3::translation(bad, 0.0, 0.0);
        assert_eq!(ask([&ball; 2], &nowhere, -Vec3::X, options(1.0, 0.0)), None);
    }
    assert_eq!(ask([&ball; 2], &pose, -Vec3::X, options(f32::NAN, 0.0)), None);
    let crossing = Pose3::translation(1.0, 0.0, 0.0);
    assert_eq!(ask([&ball; 2], &crossing, -Vec3::X, options(1.0, -0.001)), None);
    assert!(ask([&ball; 2], &crossing, -Vec3::X, options(0.0, 0.0)).is_some(), "no time is needed");
    assert!(ask([&ball; 2], &pose, -Vec3::X, options(f32::INFINITY, 0.0)).is_some());
}

/// A ball that turns and flies past or into another: never beyond the first touch, and within the
/// tolerance of it.
#[test]
fn advancement_stops_at_the_first_touch() {
    let ball = bumpy_ball(4, 0.2);
    let tree = tree(&ball);
    let mut random = Random(11);
    let mut hits = 0;
    for _ in 0..40 {
        let axis = random.vector(1.0).normalize();
        let side = 2.5 * random.vector(1.0).with_x(0.0);
        let pose_at = |time: f64| {
            let turn = Quat::from_scaled_axis(axis * (2.0 * time) as f32);
            Pose3::from_parts(Vec3::new(5.0 - 2.0 * time as f32, 0.0, 0.0) + side, turn)
        };
        let placement_at = |time| Placement::new(&pose_at(time));
        let options = AdvanceOptions {
            start: 0.0,
            end: 4.0,
            speed_bound: 2.0 + 2.0 * 1.3,
            tolerance: 1e-5,
            step_limit: 10_000,
        };
        let scratch = &mut SearchScratch::default();
        let found = advance(&mut Meshes { trees: (&tree, &tree), scratch }, placement_at, options);
        let end = found.map_or(4.0, |found| found.time);
        for step in 0..8 {
            let distance =
                least(&all_pairs([&ball; 2], &pose_at(end * f64::from(step) / 8.0), DVec3::ZERO));
            assert!(distance > 0.0, "met before {end}");
        }
        if let Some(found) = found {
            hits += 1;
            let distance = least(&all_pairs([&ball; 2], &pose_at(end), DVec3::ZERO));
            assert!(found.has_converged && distance < 2e-5, "{distance} {found:?}");
        }
    }
    assert!((5..36).contains(&hits), "{hits} hits");
}

/// Triangles head on, with steps, times and distances that are just enough. Would catch an answer
/// that is lost at the last time, one that is later than that, and a touch that is none without a
/// tolerance.
#[test]
fn advancement_goes_to_the_last_moment() {
    let floor = tree(&triangle([[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]));
    let ask = |options| {
        let placement_at = |time| Placement::new(&Pose3::translation(0.5, 0.5, 1.0 - time as f32));
        let scratch = &mut SearchScratch::default();
        advance(&mut Meshes { trees: (&floor, &floor), scratch }, placement_at, options)
    };
    let exact =
        AdvanceOptions { start: 0.0, end: 4.0, speed_bound: 1.0, tolerance: 0.0, step_limit: 10 };
    let hit = ask(exact).expect("they meet");
    assert!(hit.has_converged && hit.time == 1.0, "{hit:?}");
    let hit = ask(AdvanceOptions { step_limit: 0, ..exact }).expect("a bound of the time");
    assert!(!hit.has_converged && hit.time == 0.0, "{hit:?}");
    let near = AdvanceOptions { tolerance: 0.125, ..exact };
    let hit = ask(AdvanceOptions { start: 0.9375, end: 0.9375, ..near }).expect("they are near");
    assert!(hit.has_converged && hit.time == 0.9375, "{hit:?}");
    assert!(ask(AdvanceOptions { end: 0.9375, ..near }).is_none_or(|hit| hit.time <= 0.9375));
}
