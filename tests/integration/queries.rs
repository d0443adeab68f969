//! Queries without manifolds: the dispatcher beside brute force, and beside stock Parry where stock
//! is right.

use crate::convex::shapes::shapes;
use crate::prelude::*;
use crate::proximity::{LinearCast, Proximity};
use crate::truth::{normalized, of_meshes};
use rapier3d::parry::shape::{Ball, Capsule, Cylinder};
use sbbk_truth::TruthPair;

/// In sizes of the meshes.
const TOLERANCE: f32 = 1e-5;

/// All pairs of triangles up to a distance.
fn truth(meshes: [&TriMesh; 2], pos12: &Pose3, margin: f32) -> Vec<TruthPair> {
    of_meshes(meshes, normalized(pos12), f64::from(margin))
}

/// Least signed distance up to a margin, infinite beyond.
fn least(meshes: [&TriMesh; 2], pos12: &Pose3, margin: f32) -> f32 {
    let pairs = truth(meshes, pos12, margin);
    pairs.iter().map(|pair| pair.distance as f32).fold(f32::INFINITY, f32::min)
}

/// A small and a larger mesh at several sizes, and poses from crossing to far apart.
fn cases() -> impl Iterator<Item = ([TriMesh; 2], Vec<Pose3>)> {
    [0.01, 1.0, 100.0].into_iter().map(|size| {
        let head = shape(&mesh::monkey_head_with(6).centred().scaled_to(2.0 * size));
        let ring = shape(&mesh::torus(0.7, 0.3, 12, 7).centred().scaled_to(1.5 * size));
        let mut random = Rand32::new(size.to_bits().into());
        let poses = (0..24).map(|i| {
            let distance = size * (0.2 + 0.12 * i as f32);
            Pose3::from_parts(direction(&mut random) * distance, rotation(&mut random))
        });
        let poses = poses.collect();
        ([head, ring], poses)
    })
}

/// Distance, closest points, intersection and contact, in both orders, against brute force. Would
/// catch points in the wrong frame, normals the wrong way round, numbers of triangles of the other
/// mesh, a limit that is not kept.
#[test]
fn proximity_is_true() {
    let dispatcher = SbbkDispatcher::default();
    let (mut crossing, mut apart) = (0, 0);
    for (meshes, poses) in cases() {
        let [head, ring] = &meshes;
        let size = reach(head) + reach(ring);
        for pos12 in poses {
            let question = Question::new(head, ring, pos12);
            for question in [question, question.flipped(true)] {
                let (meshes, pos12) = (question.meshes(), question.pos12());
                let reported = dispatcher.distance(&pos12, meshes[0], meshes[1]).unwrap().distance;
                // Were the distance less than the truth, this would be infinite.
                let pairs = truth(meshes, &pos12, 0.21 * size + 1.01 * reported);
                let of = |of: [u32; 2]| {
                    let pair = pairs.iter().find(|pair| pair.triangles == of);
                    pair.map_or(f64::INFINITY, |pair| pair.distance)
                };
                let least = pairs.iter().map(|pair| pair.distance).fold(f64::INFINITY, f64::min);
                let tolerance = f64::from(TOLERANCE * size);
                let proximity = Proximity { question, least, of: &of, tolerance };
                for margin in [0.2 * size, 2.0 * size] {
                    proximity.check(&dispatcher, margin, &format!("{pos12:?}"));
                }
                *(if least < 0.0 { &mut crossing } else { &mut apart }) += 1;
            }
        }
    }
    assert!(crossing > 20 && apart > 60, "{crossing} crossing, {apart} apart");
}

/// "Surfaces are what counts", as for stock: a small mesh inside a large one does not meet it.
#[test]
fn inside_is_not_intersecting() {
    let outer = shape(&mesh::ball(4.0, 16));
    let inner = shape(&mesh::ball(1.0, 8));
    let pos12 = Pose3::translation(0.5, 0.0, 0.0);
    for dispatcher in [&DefaultQueryDispatcher as &dyn QueryDispatcher, &SbbkDispatcher::default()]
    {
        assert!(!dispatcher.intersection_test(&pos12, &outer, &inner).unwrap().intersecting);
        assert!(dispatcher.distance(&pos12, &outer, &inner).unwrap().distance > 1.0);
        assert!(dispatcher.contact(&pos12, &outer, &inner, 0.1).unwrap().is_none());
    }
}

/// Would catch impacts that are late or early, and witnesses in the wrong frame, by brute force and
/// stock.
#[test]
fn casts_stop_at_the_first_impact() {
    let (stock, ours) = (DefaultQueryDispatcher, SbbkDispatcher::default());
    let ([head, ring], _) = cases().nth(1).expect("the size of one unit");
    let mut random = Rand32::new(5);
    let mut hits = 0;
    for case in 0..40 {
        let target_distance = [0.0, 0.1][case % 2];
        let from = direction(&mut random) * 4.0;
        let pos12 = Pose3::from_parts(from, rotation(&mut random));
        let velocity = -0.5 * from + 0.6 * direction(&mut random);
        let options =
            ShapeCastOptions { target_distance, ..ShapeCastOptions::with_max_time_of_impact(4.0) };
        let cast = LinearCast { question: Question::new(&head, &ring, pos12), velocity, options };
        let left = |time: f32| {
            let near = least([&head, &ring], &cast.at(time).pose, target_distance + 0.01);
            f64::from(near - target_distance)
        };
        let [hit, other] = [cast.ask(&ours), cast.ask(&stock)];
        assert_eq!(hit.is_some(), other.is_some(), "stock {other:?}, ours {hit:?}");
        cast.check(hit, left, 50, 1e-5, &format!("case {case}"));
        let Some((hit, other)) = hit.zip(other) else { continue };
        hits += 1;
        assert!((hit.time_of_impact - other.time_of_impact).abs() < 1e-3);
        // The other order: the same impact.
        let swapped = LinearCast { question: cast.question.flipped(true), ..cast };
        let swapped = swapped.ask(&ours).expect("the other order has an impact");
        assert!((swapped.time_of_impact - hit.time_of_impact).abs() < 1e-5);
        let early = ShapeCastOptions { max_time_of_impact: 0.99 * hit.time_of_impact, ..options };
        assert!(LinearCast { options: early, ..cast }.ask(&ours).is_none());
    }
    assert!((10..40).contains(&hits), "{hits} hits");
}

/// Boxes slide along a wall, at the target distance or a little nearer, up to another wall. Would
/// catch casts that stop at the edges within the first wall: character controllers would climb no
/// stairs.
#[test]
fn casts_slide_along_a_wall_up_to_the_next_one() {
    const TARGET: f32 = 0.014;
    let mut random = Rand32::new(7);
    for case in 0..120 {
        let mut number = |least: f32, most: f32| least + (most - least) * random.rand_float();
        let side = mesh::slab(Vec3::new(0.5, 2.0, 4.0), [1, case % 7 + 1, case % 5 + 1]);
        let end = mesh::slab(Vec3::new(2.0, 2.0, 0.5), [3; 3]);
        let walls =
            [side.mapped(|at| at - 0.5 * Vec3::X), end.mapped(|at| at + Vec3::new(1.5, 0.0, 4.5))];
        let walls = shape(&Mesh::merged("walls", &walls));
        let body = shape(&mesh::cuboid(Vec3::splat(0.25), case % 4 + 1));
        let nearer = 10.0_f32.powf(number(-8.0, -1.0));
        let start = Vec3::new(0.25 + TARGET * (1.0 - nearer), number(-1.0, 1.0), number(-3.0, 2.0));
        let (velocity, pos12) =
            (Vec3::new(0.0, number(-0.1, 0.1), 1.0), Pose3::from_translation(start));
        // In some cases, the distance of the wall is the target to the last digit.
        let target_distance = if case % 3 == 0 { start.x - 0.25 } else { TARGET };
        let options = ShapeCastOptions {
            target_distance,
            stop_at_penetration: false,
            ..ShapeCastOptions::with_max_time_of_impact(10.0)
        };
        let dispatcher = SbbkDispatcher::default();
        let expected = 4.0 - 0.25 - target_distance - start.z;
        for body in [&Cuboid::new(Vec3::splat(0.25)) as &dyn Shape, &body] {
            for prepared in [false, true] {
                let mesh = body.as_trimesh().filter(|_| prepared);
                let _prepared =
                    mesh.map(|mesh| [&walls, mesh].map(|mesh| dispatcher.prepare(mesh)));
                for is_flipped in [false, true] {
                    let question = Question::new(&walls, body, pos12).flipped(is_flipped);
                    let hit = LinearCast { question, velocity, options }.ask(&dispatcher);
                    let time = hit.expect("there is a wall").time_of_impact;
                    let says = format!("{case}, {:?}: {time}", body.shape_type());
                    assert!((time - expected).abs() < 1e-5, "{says}, not {expected}");
                }
            }
        }
    }
}

/// Bodies start within the target distance of a jagged ground, and cross the ground later. Would
/// catch casts that drop a triangle for good since another one is nearer at first: characters would
/// walk into the ground.
#[test]
fn casts_that_start_within_the_target_distance_pass_nothing() {
    let (stock, ours) = (DefaultQueryDispatcher, SbbkDispatcher::default());
    let mut random = Rand32::new(11);
    let mut ground = mesh::floor(4.0, 8);
    ground.vertices.iter_mut().for_each(|at| at.y += 0.3 * random.rand_float());
    let ground = shape(&ground);
    let body = shape(&mesh::ball(0.3, 3));
    let (capsule, cylinder) = (Capsule::new_y(0.3, 0.2), Cylinder::new(0.3, 0.2));
    let cuboid = Cuboid::new(Vec3::new(0.2, 0.35, 0.2));
    let bodies: [&dyn Shape; 5] = [&Ball::new(0.3), &capsule, &cylinder, &cuboid, &body];
    let mut crossings = 0;
    for case in 0..4000 {
        let body = bodies[case % bodies.len()];
        let target_distance = 0.3 * random.rand_float();
        let mut within = |most: f32| most * (2.0 * random.rand_float() - 1.0);
        let start = Vec3::new(within(1.2), 0.6 + within(0.3), within(1.2));
        let start = Pose3::from_parts(start, rotation(&mut random));
        let distance = |pose: &Pose3| stock.distance(pose, &ground, body).unwrap().distance;
        let nearest = distance(&start);
        if nearest < 1e-3 || nearest > target_distance {
            continue;
        }
        let velocity = direction(&mut random);
        let at = |time: f32| Pose3 { translation: start.translation + time * velocity, ..start };
        let mut times = (0..75).map(|step| 0.02 * step as f32);
        let Some(crossing) = times.find(|&time| distance(&at(time)) <= 0.0) else { continue };
        crossings += 1;
        let options = ShapeCastOptions {
            target_distance,
            stop_at_penetration: false,
            ..ShapeCastOptions::with_max_time_of_impact(2.0)
        };
        for is_flipped in [false, true] {
            let question = Question::new(&ground, body, start).flipped(is_flipped);
            let hit = LinearCast { question, velocity, options }.ask(&ours);
            let time = hit.map(|hit| hit.time_of_impact);
            let is_in_time = time.is_some_and(|time| time <= crossing);
            assert!(is_in_time, "{case}, {:?}: {time:?}, not {crossing}", body.shape_type());
        }
    }
    assert!(crossings > 400, "{crossings} cross");
}

/// A cast that starts beyond the target distance ends there, whether or not it would stop at a
/// penetration. Would catch an impact that each of two triangles at a gap leaves to the other one.
#[test]
fn casts_from_afar_end_at_the_target_distance_over_gaps() {
    let dispatcher = SbbkDispatcher::default();
    let mut random = Rand32::new(23);
    let bodies: [&dyn Shape; 5] = [
        &Ball::new(0.3),
        &Capsule::new_y(0.3, 0.2),
        &Cylinder::new(0.3, 0.2),
        &Cuboid::new(Vec3::new(0.2, 0.35, 0.2)),
        &shape(&mesh::ball(0.3, 3)),
    ];
    let mut hits = 0;
    for case in 0..600 {
        let gap = [0.0, 1e-5, 1e-4, 1e-3, 1e-2][case / 5 % 5];
        let mut within = |most: f32| most * (2.0 * random.rand_float() - 1.0);
        let mut ground = mesh::floor(2.0, 8);
        ground.vertices.iter_mut().for_each(|at| at.y += within(0.15));
        let ground = shape(&mesh::unwelded(&ground, gap, case as u64));
        let body = bodies[case % bodies.len()];
        let start = Vec3::new(within(0.3), 1.0, within(0.3));
        let velocity = Vec3::new(within(0.5), -1.0, within(0.5));
        let start = Pose3::from_parts(start, rotation(&mut random));
        let question = Question::new(&ground, body, start);
        let time = |question: Question<'_>, stop_at_penetration| {
            let options = ShapeCastOptions {
                target_distance: 0.05,
                stop_at_penetration,
                ..ShapeCastOptions::with_max_time_of_impact(2.0)
            };
            let hit = LinearCast { question, velocity, options }.ask(&dispatcher);
            hit.map(|hit| hit.time_of_impact)
        };
        for is_flipped in [false, true] {
            let times = [true, false].map(|stops| time(question.flipped(is_flipped), stops));
            let [Some(truth), Some(told)] = times else {
                assert_eq!(times, [None; 2], "{case}");
                continue;
            };
            hits += 1;
            let says = format!("{case}, {:?}, gap {gap}", body.shape_type());
            assert!((told - truth).abs() < 1e-5, "{says}: {told}, not {truth}");
        }
    }
    assert!(hits > 1000, "{hits} hit");
}

/// Starts that cross: stock's statuses, and the way out.
#[test]
fn casts_that_start_inside_have_stocks_status() {
    let head = shape(&mesh::monkey_head_with(6));
    let pos12 = Pose3::translation(0.3, 0.2, 0.1);
    let options = ShapeCastOptions::with_max_time_of_impact(1.0);
    for dispatcher in [&DefaultQueryDispatcher as &dyn QueryDispatcher, &SbbkDispatcher::default()]
    {
        let hit = dispatcher.cast_shapes(&pos12, Vec3::X, &head, &head, options).unwrap();
        let hit = hit.expect("starts crossing");
        assert_eq!(hit.time_of_impact, 0.0);
        assert_eq!(hit.status, ShapeCastStatus::PenetratingOrWithinTargetDist);
    }
}

/// Casts along curved ways: nothing meets before, and the meshes are together then.
#[test]
fn nonlinear_casts_stop_at_the_first_impact() {
    let dispatcher = SbbkDispatcher::default();
    let ([head, ring], _) = cases().nth(1).expect("the size of one unit");
    let mut random = Rand32::new(9);
    let mut hits = 0;
    for _ in 0..30 {
        let from = direction(&mut random) * 4.0;
        let start = Pose3::from_parts(from, rotation(&mut random));
        let velocity = -0.5 * from + 0.9 * direction(&mut random);
        let motion1 = NonlinearRigidMotion::new(
            Pose3::IDENTITY,
            0.2 * direction(&mut random),
            0.1 * direction(&mut random),
            direction(&mut random),
        );
        let spin = 3.0 * direction(&mut random);
        let motion2 = NonlinearRigidMotion::new(start, Vec3::ZERO, velocity, spin);
        let hit = dispatcher
            .cast_shapes_nonlinear(&motion1, &head, &motion2, &ring, 0.0, 4.0, true)
            .unwrap();
        let at =
            |time: f32| motion1.position_at_time(time).inv_mul(&motion2.position_at_time(time));
        let end = hit.map_or(4.0, |hit| hit.time_of_impact);
        for step in 0..20 {
            let left = least([&head, &ring], &at(end * step as f32 / 20.0), 0.0);
            assert!(left > 0.0, "{left} left before the impact");
        }
        if let Some(hit) = hit {
            hits += 1;
            assert_eq!(hit.status, ShapeCastStatus::Converged);
            assert!(least([&head, &ring], &at(end), 0.01).abs() < 1e-5);
            assert!((at(end) * hit.witness2 - hit.witness1).length() < 1e-5);
        }
    }
    assert!((3..30).contains(&hits), "{hits} hits");
}

/// A vertex moves within the boxes of all its triangles, forth and back. Nothing else of the mesh
/// changes. Would catch meshes that are known by boxes or by samples. Would catch answers from the
/// tree of the other state, and sensors that meet old triangles.
#[test]
fn edits_forth_and_back_are_seen() {
    let dispatcher = SbbkDispatcher::default();
    let mut edited = shape(&mesh::ball(1.0, 16));
    let probe = shape(&mesh::cuboid(Vec3::splat(0.05), 1));
    // In a triangle, the middle one of three corners along each axis is on no side of its box.
    let corners = [Vec3::ZERO, Vec3::new(0.5, 0.5, 0.1), Vec3::ONE].map(|c| c + Vec3::X * 3.0);
    edited.append(&TriMesh::new(corners.to_vec(), vec![[0, 1, 2]]).unwrap());
    let vertex = edited.vertices().len() - 2;
    let boxes = |mesh: &TriMesh| {
        mesh.bvh().leaves(|_| true).map(|i| mesh.triangle(i).local_aabb()).collect::<Vec<_>>()
    };
    let place = Pose3::translation(3.8, 0.2, 0.3);
    let mut seen = Vec::new();
    let (mut met, mut missed) = (0, 0);
    for height in [0.1, 0.9, 0.1, 0.9, 0.5] {
        let before = boxes(&edited);
        edited.update_vertices(|vertices| vertices[vertex].z = height);
        assert_eq!(boxes(&edited), before);
        let distance = dispatcher.distance(&place, &edited, &probe).unwrap().distance;
        let truth = least([&edited, &probe], &place, 2.0).max(0.0);
        assert!((distance - truth).abs() < 1e-5, "{distance}, truth {truth}");
        seen.push(distance);
        // A sensor on the triangle of this state or another one, as either mesh.
        for z in [0.1, 0.5, 0.9] {
            let place = Pose3::translation(3.5, 0.5, z);
            let truth = least([&edited, &probe], &place, 0.01) <= 0.0;
            let there = dispatcher.intersection_test(&place, &edited, &probe).unwrap();
            let back = dispatcher.intersection_test(&place.inverse(), &probe, &edited).unwrap();
            assert_eq!([there.intersecting, back.intersecting], [truth; 2], "{z} of {height}");
            *(if truth { &mut met } else { &mut missed }) += 1;
        }
    }
    assert!(met > 4 && missed > 4, "{met} met, {missed} missed");
    assert_eq!(seen[..2], seen[2..4]);
    assert!((seen[0] - seen[1]).abs() > 0.01, "{seen:?}");
}

/// Would catch a mesh taken for another one that had its address and its vertices.
#[test]
fn a_mesh_in_the_place_of_another_is_not_that_one() {
    let dispatcher = SbbkDispatcher::default();
    let ball = mesh::ball(1.0, 8);
    let probe = shape(&mesh::ball(0.3, 3));
    for i in 0..60 {
        let smooth = shape(&ball);
        let mut triangles = smooth.indices().to_vec();
        let moved = (7 * i) % triangles.len();
        triangles[moved] = triangles[(moved + triangles.len() / 2) % triangles.len()];
        let holed = TriMesh::new(smooth.vertices().to_vec(), triangles).unwrap();
        // Before the middle of the triangle that is missing.
        let at = smooth.triangle(moved as u32).center() * 1.31;
        let place = Pose3::from_translation(at);
        let distance = dispatcher.distance(&place, &holed, &probe).unwrap().distance;
        let truth = least([&holed, &probe], &place, 0.5).max(0.0);
        assert!((distance - truth).abs() < 1e-5, "{distance}, truth {truth}");
    }
}

/// Would catch an answer for a pose or a limit that is no number, and for a limit without end.
#[test]
fn non_finite_input_has_no_result() {
    let dispatcher = SbbkDispatcher::default();
    let head = mesh::monkey_head_with(6).shape();
    let others = shapes(1.0).into_iter().filter(|(name, _)| *name != "ball");
    for (name, other) in others.chain([("mesh", head.clone())]) {
        let [g1, g2]: [&dyn Shape; 2] = [&*head, &*other];
        // Half-spaces reach to infinity.
        for bad in [f32::NAN, f32::INFINITY].into_iter().take(if name == "mesh" { 2 } else { 1 }) {
            let pos12 = Pose3::translation(bad, 0.0, 0.0);
            assert!(!dispatcher.intersection_test(&pos12, g1, g2).unwrap().intersecting, "{name}");
            assert_eq!(dispatcher.distance(&pos12, g1, g2).unwrap().distance, f32::MAX, "{name}");
            let points = dispatcher.closest_points(&pos12, g1, g2, 1.0).unwrap();
            assert_eq!(points, ClosestPoints::Disjoint, "{name}");
            assert!(dispatcher.contact(&pos12, g1, g2, 1.0).unwrap().is_none(), "{name}");
            let options = ShapeCastOptions::with_max_time_of_impact(1.0);
            let hit = dispatcher.cast_shapes(&pos12, Vec3::X, g1, g2, options).unwrap();
            assert!(hit.is_none(), "{name}");
            let motion = NonlinearRigidMotion::constant_position(pos12);
            let still = NonlinearRigidMotion::identity();
            let hit = dispatcher.cast_shapes_nonlinear(&still, g1, &motion, g2, 0.0, 1.0, true);
            assert!(hit.unwrap().is_none(), "{name}");
        }
        let away = Pose3::translation(0.0, -3.0e6, 0.0);
        assert!(dispatcher.contact(&away, g2, g1, f32::NAN).unwrap().is_none(), "{name}");
        let high = Pose3::translation(0.0, 30.0, 0.0);
        let found = dispatcher.contact(&high, g2, g1, f32::MAX).unwrap();
        assert!(found.is_some_and(|contact| contact.dist > 20.0), "{name}");
    }
}

/// Would catch a query that builds two trees at once, for more than 2 ms, or that never builds the
/// second one.
#[test]
fn queries_build_trees_within_the_budget() {
    let dispatcher = SbbkDispatcher::default();
    let [one, two] = [0.5, 0.6].map(|half| shape(&mesh::cuboid(Vec3::splat(half), 20)));
    let at = Pose3::translation(2.0, 0.3, 0.1);
    let builds = |count: usize| {
        let mut distances =
            (0..count).map(|_| dispatcher.distance(&at, &one, &two).unwrap().distance);
        assert!(distances.all(|distance| (distance - 0.9).abs() < 1e-6));
        dispatcher.stats().internals.tree_builds
    };
    assert_eq!([builds(1), builds(10), builds(30)], [1, 1, 2]);
}

#[test]
fn queries_without_manifolds_are_counted() {
    let dispatcher = SbbkDispatcher::default();
    let (head, cuboid) = (shape(&mesh::monkey_head_with(6)), Cuboid::new(Vec3::ONE));
    let far = Pose3::translation(9.0, 0.0, 0.0);
    dispatcher.intersection_test(&far, &head, &head).unwrap();
    dispatcher.distance(&far, &head, &cuboid).unwrap();
    assert_eq!((dispatcher.stats().searches, dispatcher.stats().pairs), (2, 0));
    dispatcher.distance(&far, &cuboid, &cuboid).unwrap();
    assert_eq!(dispatcher.stats().searches, 2);
}
