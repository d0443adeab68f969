use super::queries::least_at;
use super::shapes::{pose, shapes};
use crate::prelude::*;
use crate::proximity::LinearCast;
use sbbk_testkit::truth::{affine, convex_body};

/// Times before an impact at which brute force looks whether there was an earlier one.
const LOOKS: usize = 6;

/// Would catch a velocity in the wrong frame, triangles left out by a bound, and an impact that is
/// not the first.
#[test]
fn first_impacts_are_those_of_brute_force() {
    let dispatcher = SbbkDispatcher::default();
    let (mut hits, mut misses, mut stocks_wrong) = (0, 0, 0);
    for size in [0.01_f32, 2.0, 40.0] {
        let mesh = shape(&mesh::monkey_head_with(6).centred().scaled_to(size));
        let tolerance = 4.0e-6 * f64::from(size);
        for (seed, (name, other)) in (0..).zip(shapes(0.3 * size)) {
            let (body, around) = (convex_body(&*other), other.compute_local_aabb());
            let mut random = Rand32::new(seed);
            for i in 0..4 {
                let way = direction(&mut random);
                let mut in_mesh = pose(&mut random, &mesh, 0.3 * size);
                // The last one passes by, more often than not.
                let aside = [0.5, 0.5, 0.5, 2.5][i];
                in_mesh.translation = (1.5 * way + aside * direction(&mut random)) * size;
                let options = ShapeCastOptions {
                    max_time_of_impact: 1.5,
                    target_distance: [0.0, 0.02][i / 2] * size,
                    ..ShapeCastOptions::default()
                };
                let question = Question::new(&mesh, &*other, in_mesh).flipped(i % 2 > 0);
                let cast = LinearCast { question, velocity: -2.0 * size * way, options };
                let left = |time: Real| {
                    let in_body = affine(&cast.at(time).pose).inverse();
                    least_at(&mesh, &body, &around, in_body) - f64::from(options.target_distance)
                };
                if left(0.0) <= 0.0 {
                    continue;
                }
                let found = cast.ask(&dispatcher);
                cast.check(found, left, LOOKS, tolerance, &format!("{name}, {size}, {i}"));
                let stock = cast.ask(&DefaultQueryDispatcher);
                let off = stock.map_or(0.0, |hit| left(hit.time_of_impact).abs());
                stocks_wrong += usize::from(stock.is_some() != found.is_some() || off > tolerance);
                *(if found.is_some() { &mut hits } else { &mut misses }) += 1;
            }
        }
    }
    assert!(hits > 60 && misses > 5 && stocks_wrong > 10, "{hits} {misses} {stocks_wrong}");
}

/// Would catch an option that is not obeyed.
#[test]
fn casts_that_start_crossing_obey_their_options() {
    let dispatcher = SbbkDispatcher::default();
    let corners = [[-1.0, 0.0, -1.0], [0.0, 0.0, 1.0], [1.0, 0.0, -1.0]].map(Vec3::from);
    let floor = TriMesh::new(corners.to_vec(), vec![[0, 1, 2]]).unwrap();
    for other in [SharedShape::cylinder(0.5, 0.3), SharedShape::cuboid(0.3, 0.5, 0.2)] {
        let cast = |height: Real, velocity: Vec3, target: Real, stop_at_penetration: bool| {
            let options = ShapeCastOptions {
                target_distance: target,
                stop_at_penetration,
                ..Default::default()
            };
            let pos12 = Pose3::translation(0.0, height, 0.0);
            dispatcher.cast_shapes(&pos12, velocity, &floor, &*other, options).unwrap()
        };
        let (up, down) = (Vec3::Y, -Vec3::Y);
        let crossing = cast(0.4, up, 0.0, true).unwrap();
        assert_eq!(crossing.time_of_impact, 0.0);
        assert_eq!(crossing.status, ShapeCastStatus::PenetratingOrWithinTargetDist);
        assert!((crossing.normal1 - up).length() < 1.0e-6, "{crossing:?}");
        assert!(cast(0.4, up, 0.0, false).is_none());
        assert!(cast(0.4, down, 0.0, false).is_some());
        let within = cast(0.55, up, 0.1, true).unwrap();
        assert_eq!(within.status, ShapeCastStatus::PenetratingOrWithinTargetDist);
        assert!(cast(0.55, up, 0.1, false).is_none());
        let above = cast(1.5, down, 0.1, false).unwrap();
        assert!((above.time_of_impact - 0.9).abs() < 1.0e-6, "{above:?}");
        assert!((above.witness2.y + 0.5).abs() < 1.0e-6 && above.witness1.y.abs() < 1.0e-6);
        assert!(cast(1.5, Vec3::ZERO, 0.0, true).is_none());
        assert!(cast(1.5, Vec3::X, 0.0, true).is_none());
        assert!(cast(1.5, down * Real::NAN, 0.0, true).is_none());
    }
}

/// Would catch an impact, or a nearest triangle, lost to the rounding of its bound.
#[test]
fn impacts_and_distances_count_up_to_the_last_digit() {
    let dispatcher = SbbkDispatcher::default();
    let (mut hits, mut near) = (0, 0);
    for (seed, (name, other)) in (0..).zip(shapes(0.6)) {
        let mut random = Rand32::new(seed);
        let ground = mesh::terrain(8.0, 12, 0.7).mapped(|v| v + 30.0 * Vec3::ONE);
        let mesh = shape(&ground);
        for i in 0..40 {
            let turn = rotation(&mut random);
            let way = direction(&mut random);
            let target = [0.0, 0.05][i % 2];
            let mut pos12 = Pose3::from_parts(30.0 * Vec3::ONE + 3.0 * way, turn);
            pos12.translation.y = 33.0;
            let velocity = 0.5 * direction(&mut random) - Vec3::Y;
            let cast = |max_time_of_impact| {
                let default = ShapeCastOptions::default();
                let options =
                    ShapeCastOptions { max_time_of_impact, target_distance: target, ..default };
                dispatcher.cast_shapes(&pos12, velocity, &mesh, &*other, options).unwrap()
            };
            if let Some(hit) = cast(100.0).filter(|hit| hit.time_of_impact > 0.0) {
                let again = cast(hit.time_of_impact.next_up()).map(|hit| hit.time_of_impact);
                assert_eq!(again, Some(hit.time_of_impact), "{name}, {i}");
                hits += 1;
            }
            let distance = dispatcher.distance(&pos12, &mesh, &*other).unwrap().distance;
            // Parry answers for balls.
            if distance > 0.0 && name != "ball" {
                let limit = distance.next_up();
                let found = dispatcher.closest_points(&pos12, &mesh, &*other, limit).unwrap();
                assert!(matches!(found, ClosestPoints::WithinMargin(..)), "{name}, {i}");
                near += 1;
            }
        }
    }
    assert!(hits > 200 && near > 300, "{hits} hits, {near} near");
}
