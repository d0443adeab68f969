use super::moving::{Cast, walled};
use super::queries::truth_of;
use super::shapes::{lattice_pose, pose, shapes};
use crate::prelude::*;
use glamx::DVec3;
use sbbk_testkit::truth::convex_body;
use sbbk_truth::ConvexBody;

fn motion(
    random: &mut Rand32,
    start: Pose3,
    size: Real,
    speeds: [Real; 2],
) -> NonlinearRigidMotion {
    let [velocity, spin] = speeds;
    let centre = 0.2 * size * direction(random);
    let velocity = velocity * size * direction(random);
    NonlinearRigidMotion::new(start, centre, velocity, spin * direction(random))
}

/// A velocity, a spin and a place of few digits, which lets faces, edges and corners meet at once.
fn lattice_motion(random: &mut Rand32, start: Pose3, size: Real) -> NonlinearRigidMotion {
    let mut axis = || [Vec3::X, -Vec3::Y, Vec3::Z, Vec3::ZERO][random.rand_range(0..4) as usize];
    let [velocity, spin, centre] = [axis(), axis(), axis()];
    NonlinearRigidMotion::new(start, 0.5 * size * centre, 2.0 * size * velocity, FRAC_PI_2 * spin)
}

/// Motions of a mesh and a shape that is at a pose in it, both about a place far away.
fn motions(
    random: &mut Rand32,
    i: usize,
    in_mesh: Pose3,
    size: Real,
    far: Real,
) -> [NonlinearRigidMotion; 2] {
    let mut place = Pose3::from_parts(0.5 * size * direction(random), rotation(random));
    place.translation += far * size * Vec3::X;
    if i < 3 {
        let spin = [0.0, 1.0, 3.0][i];
        let mesh_motion = motion(random, place, size, [[0.0, 0.0], [0.5, 1.0]][i / 2]);
        let mut shape_motion = motion(random, place * in_mesh, size, [0.5, spin]);
        shape_motion.linvel -= place.rotation * in_mesh.translation;
        return [mesh_motion, shape_motion];
    }
    let mut start = lattice_pose(random);
    start.translation *= 2.0 * size;
    start.translation.x += far * size;
    let still = Pose3::translation(far * size, 0.0, 0.0);
    let mesh_motion = lattice_motion(random, still, 0.25 * size);
    [mesh_motion, lattice_motion(random, start, size)]
}

/// Panics unless an impact has its witnesses, normals and triangle, up to a distance.
fn check_hit(cast: &Cast, hit: &ShapeCastHit, body: &ConvexBody, rounded: f64, says: &str) {
    assert_eq!(hit.status, ShapeCastStatus::Converged, "{says} {hit:?}");
    let end = f64::from(hit.time_of_impact);
    let distance = cast.distance(body, end);
    assert!(distance.abs() <= rounded, "{says}: {hit:?} {distance}");
    let [pos1, pos2] = cast.swap(cast.places(end));
    let point1 = pos1.transform_point3(hit.witness1.as_dvec3());
    let point2 = pos2.transform_point3(hit.witness2.as_dvec3());
    assert!(point1.distance(point2) <= 2.0 * rounded, "{says} {hit:?}");
    let normal1: DVec3 = pos1.transform_vector3(hit.normal1.as_dvec3());
    let normal2: DVec3 = pos2.transform_vector3(hit.normal2.as_dvec3());
    assert!((normal1 + normal2).length() < 1.0e-5, "{says} {hit:?}");
    let [of_mesh, of_shape] = cast.swap([hit.subshape1, hit.subshape2]);
    assert_eq!(of_shape, 0, "{says}");
    let [mesh_place, shape_place] = cast.places(end);
    let triangle = cast.mesh.triangle(of_mesh);
    let own = truth_of(&triangle, body, shape_place.inverse() * mesh_place);
    assert!(own.abs() <= rounded, "{says} {hit:?}");
}

/// Would catch a bound of the speed that is too low, a wrong order of transforms, triangles left
/// out, and an impact that is not the first.
#[test]
fn first_impacts_are_those_of_brute_force() {
    let dispatcher = SbbkDispatcher::default();
    let (mut hits, mut misses, mut unclear, mut stocks_wrong) = (0, 0, 0, 0);
    for (size, far) in [(0.01, 0.0), (2.0, 1.0e3), (40.0, 0.0)] {
        let mesh = shape(&mesh::monkey_head_with(4).centred().scaled_to(size));
        let tolerance = 3.0e-6 * f64::from(size);
        for (seed, (name, other)) in (0..).zip(shapes(0.3 * size)) {
            let body = convex_body(&*other);
            for i in 0..4 {
                let random = &mut Rand32::new(100 * seed + i as u64);
                let mut in_mesh = pose(random, &mesh, 0.3 * size);
                in_mesh.translation += 0.8 * size * direction(random);
                let motions = motions(random, i, in_mesh, size, far);
                let cast = Cast {
                    motions,
                    is_mesh_first: i % 2 == 0,
                    ..Cast::past(&mesh, &other, still())
                };
                if cast.distance(&body, 0.0) <= tolerance {
                    continue;
                }
                let says = format!("{name}, {size}, {i}");
                let found = cast.ask(&dispatcher, true);
                let end = found.map_or(1.0, |hit| f64::from(hit.time_of_impact));
                let speed = cast.speed(f64::from(reach(&mesh).max(reach_of(&other))));
                // Times are rounded to f32.
                let rounded = tolerance + 1.0e-7 * speed;
                let (closest, is_through) = cast.march(&body, speed, tolerance, end);
                unclear += usize::from(!is_through);
                assert!(closest > -rounded, "{says}: {closest} on the way to {found:?}");
                // Stock has no answer for half-spaces.
                let stock = cast.ask(&DefaultQueryDispatcher, true);
                let off = stock.map(|hit| cast.distance(&body, f64::from(hit.time_of_impact)));
                let is_stock_right =
                    off.is_some() == found.is_some() && off.is_none_or(|off| off.abs() <= rounded);
                stocks_wrong += usize::from(!is_stock_right);
                if let Some(hit) = &found {
                    check_hit(&cast, hit, &body, rounded, &says);
                }
                *(if found.is_some() { &mut hits } else { &mut misses }) += 1;
            }
        }
    }
    assert!(hits > 60 && misses > 40 && unclear < 5, "{hits} {misses} {unclear}");
    assert!(stocks_wrong > 20, "{stocks_wrong}");
}

/// Radius about the origin that holds a shape.
fn reach_of(shape: &SharedShape) -> Real {
    let around = shape.compute_local_aabb();
    if shape.as_halfspace().is_some() {
        0.0
    } else {
        around.mins.abs().max(around.maxs.abs()).length()
    }
}

fn still() -> NonlinearRigidMotion {
    NonlinearRigidMotion::identity()
}

fn pushed(place: Vec3, velocity: Vec3) -> NonlinearRigidMotion {
    let start = Pose3::from_translation(place);
    NonlinearRigidMotion::new(start, Vec3::ZERO, velocity, Vec3::ZERO)
}

/// Shapes whose middle is half a unit above what they stand on, times a size.
fn blocks(size: Real) -> [(&'static str, SharedShape); 4] {
    let corners = mesh::cuboid(Vec3::splat(0.5 * size), 1).vertices;
    [
        ("cylinder", SharedShape::cylinder(0.5 * size, 0.3 * size)),
        ("cuboid", SharedShape::cuboid(0.3 * size, 0.5 * size, 0.2 * size)),
        ("ball", SharedShape::ball(0.5 * size)),
        ("hull", SharedShape::convex_hull(&corners).expect("a cube has a hull")),
    ]
}

/// Would catch a disobeyed option, a wrong thickness, velocities of the wrong points, and a
/// forgotten order. A body that crosses a floor stops if it would come out behind it. A body that
/// slides stops at the wall.
#[test]
fn casts_from_contact_stop_as_their_options_say() {
    let ours = SbbkDispatcher::default();
    let sizes = [0.01, 1.0, 40.0].into_iter();
    for (size, is_mesh_first) in sizes.flat_map(|size| [(size, true), (size, false)]) {
        let mesh = walled(20.0, 1, 5.0).scaled(Vec3::splat(size));
        for (name, other) in blocks(size) {
            let cast = |dispatcher: &dyn QueryDispatcher, velocity: Vec3, stop: bool| {
                let moving = pushed(0.4 * size * Vec3::Y, velocity * size);
                Cast { is_mesh_first, ..Cast::past(&mesh, &other, moving) }.ask(dispatcher, stop)
            };
            let says = format!("{name}, {size}, {is_mesh_first}");
            let crossing = cast(&ours, Vec3::Y, true).expect("crosses");
            assert_eq!(crossing.time_of_impact, 0.0, "{says}");
            assert_eq!(crossing.status, ShapeCastStatus::PenetratingOrWithinTargetDist, "{says}");
            let normals = [crossing.normal1, crossing.normal2];
            let [of_mesh, of_shape] =
                Cast { is_mesh_first, ..Cast::past(&mesh, &other, still()) }.swap(normals);
            assert!((of_mesh - Vec3::Y).length() < 1e-6 && (of_shape + Vec3::Y).length() < 1e-6);
            let away = [Vec3::Y, -0.01 * Vec3::Y, Vec3::X].map(|velocity| (velocity, false));
            for (velocity, is_stopped) in away.into_iter().chain([(-2.0 * Vec3::Y, true)]) {
                let found = cast(&ours, velocity, false);
                assert_eq!(found.is_some(), is_stopped, "{says} {velocity}: {found:?}");
                let found = found.map(|hit| (hit.time_of_impact, hit.status));
                assert!(found.is_none_or(|hit| hit == (0.0, ShapeCastStatus::Converged)));
                let stock = cast(&DefaultQueryDispatcher, velocity, false);
                assert!(
                    size != 1.0 || stock.is_some() == is_stopped,
                    "{says} {velocity}: {stock:?}"
                );
            }
            let slid = cast(&ours, 10.0 * Vec3::X, false).expect("meets the wall");
            let wide = other.compute_local_aabb().maxs.x / size;
            assert!((slid.time_of_impact - (0.5 - 0.1 * wide)).abs() < 1e-5, "{says} {slid:?}");
            assert_eq!(slid.status, ShapeCastStatus::Converged, "{says}");
        }
    }
}

/// A falling pole leaves the floor with one end and comes down with the other. Would catch a floor
/// ignored because it was touched at the start.
#[test]
fn a_falling_pole_meets_the_floor_with_its_other_end() {
    let mesh = walled(20.0, 1, 5.0);
    for (name, other) in [
        ("cylinder", SharedShape::cylinder(1.0, 0.1)),
        ("cuboid", SharedShape::cuboid(0.1, 1.0, 0.1)),
        ("capsule", SharedShape::capsule_y(1.0, 0.1)),
    ] {
        for is_mesh_first in [true, false] {
            let turn = Quat::from_rotation_z(0.5);
            let low = other.compute_aabb(&Pose3::from_rotation(turn)).mins.y;
            let start = Pose3::from_parts(Vec3::new(0.3, -low, 0.1), turn);
            let ask = |dispatcher: &dyn QueryDispatcher, spin: Real, sinking: Real| {
                let (velocity, spin) = (-sinking * Vec3::Y, spin * Vec3::Z);
                let moving = NonlinearRigidMotion::new(start, Vec3::ZERO, velocity, spin);
                Cast { is_mesh_first, ..Cast::past(&mesh, &other, moving) }.ask(dispatcher, false)
            };
            for (spin, sinking, is_met) in
                [(6.0, 0.3, true), (-0.5, -0.5, false), (0.0, 0.0, false)]
            {
                let found = ask(&SbbkDispatcher::default(), spin, sinking);
                let stock = ask(&DefaultQueryDispatcher, spin, sinking);
                assert_eq!(found.is_some(), is_met, "{name} {spin}: {found:?} for {stock:?}");
                assert_eq!(stock.is_some(), is_met, "{name} {spin}: {stock:?}");
                if let (Some(hit), Some(stock)) = (found, stock) {
                    assert_eq!(hit.status, ShapeCastStatus::Converged, "{name}");
                    let [hit, stock] = [hit, stock].map(|hit| hit.time_of_impact);
                    assert!((0.85 * stock..=stock).contains(&hit), "{name} {hit} {stock}");
                }
            }
        }
    }
}

/// The pole looks alike after each tenth of the time. Would catch sample times that ignore the
/// spin.
#[test]
fn a_fast_pole_meets_the_floor_with_its_other_end() {
    let corners = [[-50.0, 0.0, 50.0], [50.0, 0.0, 50.0], [0.0, 0.0, -50.0]].map(Vec3::from);
    let mesh = TriMesh::new(corners.to_vec(), vec![[0, 1, 2]]).unwrap();
    let pole = SharedShape::cuboid(0.1, 1.0, 0.1);
    let turn = Quat::from_rotation_z(0.5);
    let low = pole.compute_aabb(&Pose3::from_rotation(turn)).mins.y;
    let start = Pose3::from_parts(-low * Vec3::Y, turn);
    for (spin, met) in [(31.4, 0.0666), (60.0, 0.0352), (200.0, 0.0107)] {
        let moving = NonlinearRigidMotion::new(start, Vec3::ZERO, -0.3 * Vec3::Y, spin * Vec3::Z);
        let hit = Cast::past(&mesh, &pole, moving)
            .ask(&SbbkDispatcher::default(), false)
            .expect("comes down");
        assert!((hit.time_of_impact - met).abs() < 1e-4, "{spin}: {hit:?}");
    }
}

/// Would catch a spin that counts as an approach of the whole body, which took a minute and
/// invented an impact.
#[test]
fn a_box_that_turns_above_a_floor_does_not_meet_it() {
    let dispatcher = SbbkDispatcher::default();
    let mesh = shape(&mesh::floor(20.0, 20));
    let cube = SharedShape::cuboid(0.5, 0.5, 0.5);
    for (height, velocity, spin, end) in [
        (5.0, Vec3::ZERO, 2.0, Real::MAX),
        (0.87, Vec3::X, 1.0e4, 5.0),
        (0.87, Vec3::X, 1.0e6, 5.0),
    ] {
        let start = Pose3::translation(0.0, height, 0.0);
        let spin = spin * Vec3::new(0.6, 0.0, 0.8);
        let moving = NonlinearRigidMotion::new(start, Vec3::ZERO, velocity, spin);
        for is_mesh_first in [true, false] {
            let cast = Cast { is_mesh_first, until: end, ..Cast::past(&mesh, &cube, moving) };
            let found = cast.ask(&dispatcher, true);
            assert!(found.is_none(), "{height} {spin}: {found:?}");
        }
    }
}

/// Would catch a cast that runs out of steps, a plane that a body crosses, and a triangle that is
/// not met first.
#[test]
fn bodies_that_glide_along_a_floor_meet_the_wall() {
    let dispatcher = SbbkDispatcher::default();
    for (cells, height) in [(1, 1e-2), (1, 1e-4), (20, 1e-2), (20, 1e-4)] {
        let mesh = walled(20.0, cells, 5.0);
        for (name, other) in shapes(1.0).into_iter().filter(|(name, _)| *name != "half-space") {
            let low = other.compute_local_aabb().mins.y;
            let start = Pose3::translation(-3.0, height - low, 0.0);
            let cast = |velocity: Vec3| {
                let moving = NonlinearRigidMotion::new(start, Vec3::ZERO, velocity, Vec3::Y);
                let cast = Cast::past(&mesh, &other, moving);
                let found = cast.ask(&dispatcher, true);
                found.map(|hit| {
                    (hit, cast.distance(&convex_body(&*other), f64::from(hit.time_of_impact)))
                })
            };
            let (hit, left) = cast(9.0 * Vec3::X).expect("meets the wall");
            let says = format!("{name}, {cells}, {height}: {hit:?}");
            assert_eq!(hit.status, ShapeCastStatus::Converged, "{says}");
            assert!(left.abs() < 1e-5 && hit.time_of_impact > 0.8, "{says}");
            assert_eq!(hit.subshape1, mesh.indices().len() as u32 - 1, "{says}");
            assert!(cast(-3.0 * Vec3::X).is_none(), "{says}");
        }
    }
}

/// Would catch a half-space that turns about its centre like a body, or not at all. Impacts are the
/// same if the time has no end.
#[test]
fn turning_half_spaces_meet_the_far_corner() {
    let dispatcher = SbbkDispatcher::default();
    let cube = shape(&mesh::cuboid(Vec3::splat(0.5), 1));
    let ground = SharedShape::halfspace(Vec3::Y);
    let slab = SharedShape::cuboid(9.0, 0.5, 9.0);
    let there = pushed(Vec3::new(3.0, 1.5, 0.0), Vec3::ZERO);
    let high = pushed(8.0 * Vec3::Y, Vec3::ZERO);
    let rising = NonlinearRigidMotion::new(Pose3::IDENTITY, Vec3::X, Vec3::Y, Vec3::Z);
    for is_mesh_first in [true, false] {
        let cast = |spin: Real, until: Real| {
            let spin = spin * Vec3::Z;
            let turning = NonlinearRigidMotion::new(Pose3::IDENTITY, Vec3::ZERO, Vec3::ZERO, spin);
            let motions = [there, turning];
            Cast { mesh: &cube, shape: &ground, motions, is_mesh_first, until }
                .ask(&dispatcher, true)
        };
        for until in [1.0, Real::INFINITY] {
            let hit = cast(0.5, until).expect("it comes up");
            assert!((0.5 * hit.time_of_impact - (1.0_f32 / 3.5).atan()).abs() < 1e-5, "{hit:?}");
            assert_eq!(hit.status, ShapeCastStatus::Converged);
        }
        assert!(cast(0.25, 1.0).is_none());
        let motions = [high, rising];
        let [short, long] = [9.0, Real::INFINITY].map(|until| {
            let cast = Cast { mesh: &cube, shape: &slab, motions, is_mesh_first, until };
            cast.ask(&dispatcher, true).expect("meets it").time_of_impact
        });
        assert!((short - long).abs() < 1e-5, "{short:?} {long:?}");
    }
}

/// Would catch half-spaces that count as touching from any height, as they have no far side.
#[test]
fn meshes_meet_half_spaces_whatever_their_options() {
    let cube = shape(&mesh::cuboid(Vec3::splat(0.5), 1));
    let ground = SharedShape::halfspace(Vec3::Y);
    for (height, is_met) in [(2.0, true), (0.7, true), (4.0, false)] {
        for (is_mesh_first, stop) in [(true, true), (true, false), (false, true), (false, false)] {
            let motions = [pushed(Vec3::Y * height, -2.0 * Vec3::Y), still()];
            let cast = Cast { mesh: &cube, shape: &ground, motions, is_mesh_first, until: 1.0 };
            let found = cast.ask(&SbbkDispatcher::default(), stop);
            let time = found.map(|hit| hit.time_of_impact);
            assert_eq!(time.is_some(), is_met, "{height}, {is_mesh_first}, {stop}");
            assert!(time.is_none_or(|time| (2.0 * time - (height - 0.5)).abs() < 1e-4), "{time:?}");
        }
    }
}

/// Would catch a tolerance of zero: a mesh that is a point has no size, and takes all steps there
/// are.
#[test]
fn a_point_that_falls_is_met() {
    let point = TriMesh::new(vec![Vec3::ZERO; 3], vec![[0, 1, 2]]).expect("it has a triangle");
    let at = Pose3::translation(0.1, 3.0, 0.2);
    let falling = NonlinearRigidMotion::new(at, Vec3::ZERO, -Vec3::Y, Vec3::new(0.3, 0.1, 0.2));
    let mut hits = 0;
    for (name, other) in shapes(1.0) {
        let motions = [falling, still()];
        let cast = Cast { motions, until: 9.0, ..Cast::past(&point, &other, still()) };
        let Some(hit) = cast.ask(&SbbkDispatcher::default(), true) else { continue };
        assert_eq!(hit.status, ShapeCastStatus::Converged, "{name} {hit:?}");
        hits += 1;
    }
    assert!(hits > 8, "{hits}");
}

/// Meshes are surfaces: a body in the hollow of one is apart from it, and meets it from inside.
#[test]
fn a_body_in_a_hollow_is_apart() {
    let dispatcher = SbbkDispatcher::default();
    let hollow = shape(&mesh::ball(3.0, 6));
    for (name, other) in shapes(1.0).into_iter().filter(|(name, _)| *name != "half-space") {
        for (velocity, is_met) in [(Vec3::ZERO, false), (4.0 * Vec3::X, true)] {
            let moving =
                NonlinearRigidMotion::new(Pose3::IDENTITY, Vec3::ZERO, velocity, 3.0 * Vec3::ONE);
            let cast = Cast::past(&hollow, &other, moving);
            for stop in [true, false] {
                assert_eq!(cast.ask(&dispatcher, stop).is_some(), is_met, "{name}");
            }
        }
    }
}

/// Motions and times that are no numbers: nothing is found, nothing panics or goes on for ever.
/// Bodies that do not move are met where they touch, however long.
#[test]
fn non_finite_input_has_no_result() {
    let dispatcher = SbbkDispatcher::default();
    let mesh = shape(&mesh::monkey_head_with(4));
    for (name, other) in shapes(1.0) {
        for bad in [f32::NAN, f32::INFINITY] {
            let bad = Vec3::new(bad, 0.0, 0.0);
            let away = Pose3::translation(0.0, 0.0, 9.0);
            for motion in [
                NonlinearRigidMotion::constant_position(Pose3::from_translation(bad)),
                NonlinearRigidMotion::new(away, bad, Vec3::X, Vec3::X),
                NonlinearRigidMotion::new(away, Vec3::X, bad, Vec3::X),
                NonlinearRigidMotion::new(away, Vec3::X, Vec3::X, bad),
            ] {
                for (motions, stop) in [([still(), motion], true), ([motion, still()], false)] {
                    let cast = Cast { motions, ..Cast::past(&mesh, &other, still()) };
                    assert!(cast.ask(&dispatcher, stop).is_none(), "{name} {motion:?}");
                }
            }
        }
        let until = |until: Real| {
            Cast { until, ..Cast::past(&mesh, &other, still()) }.ask(&dispatcher, true)
        };
        for end in [-1.0, f32::NAN] {
            assert!(until(end).is_none(), "{name}");
        }
        let touches =
            dispatcher.distance(&Pose3::IDENTITY, &mesh, &*other).unwrap().distance == 0.0;
        for end in [0.0, 1.0, f32::MAX, f32::INFINITY] {
            assert_eq!(until(end).is_some(), touches, "{name} {end}");
        }
    }
}
