//! Linear casts.

use super::{all_pairs, distance_of, least, tree, triangle};
use crate::prelude::*;
use sbbk_core::query::{Cast, CastOptions, cast};

fn options(max_time: f32, target_distance: f32) -> CastOptions {
    CastOptions { max_time, target_distance, stop_at_penetration: true }
}

fn cast_at(meshes: [&Soup; 2], pose: &Pose3, velocity: Vec3, options: CastOptions) -> Option<Cast> {
    let [tree1, tree2] = meshes.map(tree);
    let mut scratch = SearchScratch::default();
    cast((&tree1, &tree2), Placement::new(pose), velocity, options, &mut scratch, |_| true)
}

#[test]
fn casts_stop_at_the_first_impact_of_a_march() {
    let mut random = Random(1);
    let (mut hits, mut misses) = (0, 0);
    for case in 0..150 {
        let target = [0.0_f32, 0.05, 0.5][case % 3];
        let [one, two] = [6, 5].map(|count| soup(&mut random, count, 0.6));
        let pose = Pose3::from_parts(4.0 * random.vector(1.0).normalize(), random.rotation());
        let velocity = 0.7 * random.vector(1.0) - 0.5 * pose.translation;
        let hit = cast_at([&one, &two], &pose, velocity, options(3.0, target));
        let target = f64::from(target);
        let pairs_at = |time| all_pairs([&one, &two], &pose, velocity.as_dvec3() * time);
        let end = hit.map_or(3.0, |hit| hit.time);
        // A start within the target distance has no time before it.
        let steps = if hit.is_some_and(|hit| hit.is_penetrating) { 0 } else { 100 };
        for time in (0..steps).map(|step| end * f64::from(step) / 100.0) {
            let distance = least(&pairs_at(time));
            assert!(distance > target - 1e-5, "{distance} at {time}, before {hit:?}");
        }
        let Some(Cast { time, pair, is_penetrating }) = hit else {
            misses += 1;
            continue;
        };
        hits += 1;
        let distance = distance_of(&pairs_at(time), [pair.triangle1, pair.triangle2]);
        let starts_within = least(&pairs_at(0.0)) < target;
        assert_eq!(is_penetrating, starts_within);
        assert!(starts_within || (distance - target).abs() < 1e-5);
    }
    assert!(hits > 30 && misses > 10, "{hits} hits, {misses} misses");
}

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
        let until = |max_time| cast_at([&one, &two], &pose, velocity, options(max_time, target));
        let Some(hit) = until(f32::INFINITY).filter(|hit| hit.time > 0.0) else { continue };
        hits += 1;
        let time = hit.time as f32;
        assert_eq!(until(time.next_up()), Some(hit));
        assert_eq!(until(0.999 * time), None);
    }
    assert!(hits > 500, "{hits} hits");
}

#[test]
fn the_normal_of_corners_that_meet_is_from_before_the_impact() {
    let way = Vec3::new(0.3, -0.2, 1.0);
    let below = |z: f32| triangle([[0.0; 3], [-1.0, 0.0, z], [0.7, 0.9, z]]);
    let meshes = [&below(-2.0), &below(2.0)];
    let hit = cast_at(meshes, &Pose3::from_translation(way), -way, options(2.0, 0.0)).unwrap();
    assert!((hit.time - 1.0).abs() < 1e-9);
    assert!((hit.pair.contact.normal - way.as_dvec3().normalize()).length() < 1e-6, "{hit:?}");
}

#[test]
fn a_falling_face_has_the_time_and_status_of_its_start() {
    let floor = triangle([[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]);
    let from = |height: f32, velocity: Vec3, options| {
        cast_at([&floor; 2], &Pose3::translation(0.5, 0.5, height), velocity, options)
    };
    let down = -2.0 * Vec3::Z;
    for (height, target, time) in [(3.0, 0.0, 1.5), (3.0, 1.0, 1.0), (1.0, 1.0, 0.0)] {
        let hit = from(height, down, options(10.0, target)).unwrap();
        assert!((hit.time - time).abs() < 1e-12 && !hit.is_penetrating, "{hit:?}");
        assert!((hit.pair.contact.normal - DVec3::Z).length() < 1e-9);
        assert!((hit.pair.contact.distance - f64::from(target)).abs() < 1e-12);
    }
    for (height, velocity, options) in [
        (3.0, down, options(1.49, 0.0)),
        (3.0, -down, options(10.0, 0.0)),
        (3.0, Vec3::ZERO, options(10.0, 0.0)),
        (3.0, down, options(10.0, -1.0)),
        (0.0, down, options(-1.0, 0.0)),
        (0.0, down, options(f32::NAN, 0.0)),
    ] {
        assert_eq!(from(height, velocity, options), None);
    }
    let within = options(10.0, 1.0);
    let through = CastOptions { stop_at_penetration: false, ..within };
    for (velocity, passes) in [(down, false), (-down, true)] {
        let hit = from(0.5, velocity, within).unwrap();
        assert!(hit.time == 0.0 && hit.is_penetrating);
        assert_eq!(from(0.5, velocity, through).is_none(), passes);
    }
}

#[test]
fn triangles_that_just_touch_are_met() {
    let origin = Pose3::IDENTITY;
    let below = triangle([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
    let above = triangle([[-2.0, 1.0, 0.0], [-3.0, 2.0, 0.0], [-3.0, 2.0, 1.0]]);
    let hit = cast_at([&below, &above], &origin, Vec3::X, options(5.0, 0.0)).unwrap();
    assert!((hit.time - 2.0).abs() < 1e-9, "{hit:?}");

    // They leave each other along y a part in 10¹⁴ of the time before they meet along x.
    let right = triangle([[0.0; 3], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0]]);
    let left = triangle([[0.0; 3], [-1.0, -1.0, 0.0], [-1.0, -1.0, 1.0]]);
    let away = Pose3::translation(-16_777_215.0, 16_777_213.0, 0.0);
    let velocity = Vec3::new(8_388_608.0, -8_388_607.0, 0.0);
    let hit = cast_at([&right, &left], &away, velocity, options(5.0, 0.0)).unwrap();
    assert!((hit.time - 2.0).abs() < 1e-6, "{hit:?}");

    // The boxes meet before the last moment, the triangles after it.
    let wall = triangle([[0.0; 3], [1.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    let small = triangle([[0.9, 0.1, 0.1], [0.9, 0.11, 0.1], [0.9, 0.1, 0.11]]);
    let until = |end| cast_at([&wall, &small], &origin, -Vec3::X, options(end, 0.0));
    assert_eq!([1.0, 0.5].map(|end| until(end).is_some()), [true, false]);

    let wide = triangle([[0.0; 3], [1e6, 0.0, 0.0], [0.0, 1e6, 0.0]]);
    let hardly = Pose3::translation(0.0, 0.0, 2.0_f32.powi(-24));
    let hit = cast_at([&wide; 2], &hardly, Vec3::Z, options(1.0, 0.0)).unwrap();
    assert!(hit.time == 0.0 && hit.pair.is_touching, "{hit:?}");
}

/// Corners graze the top edge of a wall, far from the origin. A cast of two triangles alone has no
/// boxes that rounding could separate.
#[test]
fn grazing_corners_are_met_among_other_triangles() {
    let mut random = Random(23);
    let mut hits = 0;
    for _ in 0..1000 {
        let [top, far] = [0; 2].map(|_| 1000.0 * random.vector(1.0));
        let turn = random.rotation();
        let wall = [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]].map(Vec3::from_array);
        // The last corner is the lowest one of its box in the frame of the wall.
        let lowest = -(turn.inverse() * Vec3::Y).signum();
        let with_others = |corners: [Vec3; 3], at: Vec3| {
            let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
            let part =
                |i| corners.map(|v| at + 0.002 * v.lerp(middle, if i > 0 { 0.5 } else { 0.0 }));
            Soup::apart((0..12).flat_map(part))
        };
        let meshes =
            [with_others(wall, top), with_others([Vec3::ZERO, lowest.with_x(0.0), lowest], far)];
        let alone = meshes.each_ref().map(|soup| Soup::apart(soup.vertices[..3].to_vec()));
        let corner = turn * alone[1].vertices[2];
        let pose = Pose3::from_parts(top + 0.01 * Vec3::X - corner, turn);
        let time = |[one, two]: &[Soup; 2]| {
            cast_at([one, two], &pose, -Vec3::X, options(1.0, 0.0)).map(|hit| hit.time)
        };
        let hit = time(&alone);
        hits += i32::from(hit.is_some());
        assert!(hit.is_none() || time(&meshes) == hit, "{hit:?} {:?}", time(&meshes));
    }
    assert!(hits > 300, "{hits} hits");
}

#[test]
fn non_finite_input_has_no_impact() {
    let ball = bumpy_ball(6, 0.1);
    let pose = Pose3::translation(5.0, 0.0, 0.0);
    let at = |pose: &Pose3, velocity, options| cast_at([&ball; 2], pose, velocity, options);
    for bad in [f32::NAN, f32::INFINITY] {
        assert_eq!(at(&pose, Vec3::new(bad, 0.0, 0.0), options(1.0, 0.0)), None);
        assert_eq!(at(&pose, -Vec3::X, options(1.0, bad)), None);
        assert_eq!(at(&Pose3::translation(bad, 0.0, 0.0), -Vec3::X, options(1.0, 0.0)), None);
    }
    assert_eq!(at(&pose, -Vec3::X, options(f32::NAN, 0.0)), None);
    assert!(at(&pose, -Vec3::X, options(f32::INFINITY, 0.0)).is_some());
    let crossing = Pose3::translation(1.0, 0.0, 0.0);
    assert_eq!(at(&crossing, -Vec3::X, options(1.0, -0.001)), None);
    assert!(at(&crossing, -Vec3::X, options(0.0, 0.0)).is_some(), "no time is needed");
}
