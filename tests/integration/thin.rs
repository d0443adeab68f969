//! Thin and fast bodies: on sheets, at the distances of soft CCD, and beyond the reach of
//! candidates.

use crate::prelude::*;

/// Half the thickness of plates that are a unit wide.
const HALF: Real = 0.015;

fn plate(cells: u32) -> TriMesh {
    shape(&mesh::cuboid(Vec3::new(0.5, HALF, 0.5), cells))
}

/// A sheet with its front up.
fn floor() -> TriMesh {
    shape(&mesh::floor(10.0, 20))
}

/// A plate whose middle is a little behind the sheet may come from either side, so the contacts of
/// the triangles hold it. Would catch a plate that is pushed through. Would also catch plates at
/// rest, sunk by a millimetre, with contacts to both sides.
#[test]
fn a_plate_a_little_behind_a_sheet_is_held() {
    let floor = floor();
    for (cells, height) in [(1, -0.03), (4, -0.03), (1, -0.025)] {
        let plate = plate(cells);
        for tilt in [0.06, 0.08] {
            let turn = Quat::from_rotation_y(0.3) * Quat::from_rotation_x(tilt);
            let pose = Pose::from_parts(Vec3::new(0.13, height, 0.21), turn);
            let query = Question::new(&floor, &plate, pose);
            let of = |found: Vec<Manifold>| found.iter().map(triangles).collect::<BTreeSet<_>>();
            let expected = of(query.fresh(&per_triangle()));
            assert!(expected.len() >= 4, "{expected:?} at {height}, tilted by {tilt}");
            assert_eq!(of(query.fresh(&every())), expected, "at {height}, tilted by {tilt}");
        }
        for side in [1.0, -1.0] {
            let pose = Pose::translation(0.13, side * (HALF - 0.001), 0.21);
            let found = Question::new(&floor, &plate, pose).fresh(&every());
            assert!(!found.is_empty());
            let is_apart = |manifold: &Manifold| side * manifold.local_n1.y > 0.99;
            assert!(found.iter().all(is_apart), "{cells} cells, side {side}");
        }
    }
}

/// Would catch bodies that fall through an open floor although a quarter of them is above it. Would
/// also catch bodies from below that the floor pulls up.
#[test]
fn a_body_through_a_sheet_leaves_to_the_front_until_three_quarters_are_behind() {
    let floor = floor();
    for body in [mesh::cuboid(Vec3::splat(0.5), 3), mesh::ball(0.5, 6)] {
        let body = shape(&body);
        for (behind, side) in [(0.1, 1.0), (0.3, 1.0), (0.45, 1.0), (0.55, -1.0), (0.8, -1.0)] {
            let place = Vec3::new(0.13, -0.5 * behind, 0.21);
            let query = Question::new(&floor, &body, Pose::from_translation(place));
            for query in [query, query.flipped(true)] {
                let found = query.fresh(&every());
                let normal = |manifold: &Manifold| {
                    query.host_order([manifold.local_n1, manifold.local_n2])[0]
                };
                let is_apart = |manifold: &Manifold| side * normal(manifold).y > 0.99;
                assert!(found.iter().any(is_apart), "{}, {behind} behind", body.indices().len());
                let is_through = |manifold: &Manifold| side * normal(manifold).y < -0.5;
                assert!(!found.iter().any(is_through), "{}, {behind} behind", body.indices().len());
            }
        }
    }
}

/// A tilted plate of fine triangles hovers over a sheet without a front. Would catch plates that
/// count as halfway through, and have no contacts under the higher edge.
#[test]
fn a_tilted_plate_over_a_sheet_has_contacts_under_both_edges() {
    let floor = mesh::floor(10.0, 80);
    let floors = [mesh::random_winding(&floor, 3), mesh::two_sided(&floor)];
    let plate = plate(32);
    for floor in floors.map(|floor| shape(&floor)) {
        for (tilt, gap) in [(0.02, 0.01), (0.06, 0.003), (0.06, 0.001), (0.2, 0.01)] {
            let (sin, cos) = Real::sin_cos(tilt);
            let height = 0.5 * sin + HALF * cos + gap;
            let pose = Pose::from_parts(height * Vec3::Y, Quat::from_rotation_z(tilt));
            let query = Question::new(&floor, &plate, pose).within(0.6);
            let found = query.fresh(&every());
            let points = found.iter().flat_map(|manifold| &manifold.points);
            let ends = points.map(|point| point.local_p2.x);
            let farthest = ends.fold(0.0, Real::max);
            assert!(farthest > 0.45, "{farthest}, tilted by {tilt}, {gap} over a sheet");
        }
    }
}

/// Would catch more points of one direction than Rapier's solver takes, and points away from the
/// corners.
#[test]
fn far_contacts_are_four_corners() {
    let (floor, plate) = (floor(), plate(4));
    let turn = Quat::from_rotation_y(0.3);
    for gap in [0.1, 0.3, 0.5] {
        let pose = Pose::from_parts(Vec3::new(0.1, gap + HALF, 0.2), turn);
        let found = Question::new(&floor, &plate, pose).within(0.6).fresh(&every());
        for (i, manifold) in found.iter().enumerate() {
            assert!((1..=4).contains(&manifold.points.len()));
            let is_like = |other: &Manifold| other.local_n1.dot(manifold.local_n1) >= 0.996;
            assert!(!found[..i].iter().any(is_like), "two of one direction");
        }
        let down = found.iter().find(|manifold| manifold.local_n1.y > 0.999).expect("one is down");
        for corner in [[0.5, 0.5], [0.5, -0.5], [-0.5, 0.5], [-0.5, -0.5]] {
            let corner = Vector::new(corner[0], -HALF, corner[1]);
            let away = down.points.iter().map(|point| (point.local_p2 - corner).length());
            let away = away.fold(Real::INFINITY, Real::min);
            assert!(away < 0.05, "nothing at {corner}, but {away} away");
        }
    }
}

/// Would catch plates that turn about one contact of soft CCD, and through the floor.
#[test]
fn fast_plates_do_not_pass_a_floor() {
    const SPEED: Real = 30.0;
    let [floor, plate] = [floor(), plate(4)].map(SharedShape::new);
    let passes = |index: &usize| {
        let phase = *index as Real / 64.0;
        let ground = ColliderBuilder::new(floor.clone());
        let world = world_of([ground], SbbkDispatcher::default());
        let turn = Quat::from_rotation_y(6.0 * phase) * Quat::from_rotation_x(0.6 * phase);
        let place = Vec3::new(0.1, 2.0 + phase * SPEED / 60.0, 0.05);
        let body = RigidBodyBuilder::dynamic().pose(Pose3::from_parts(place, turn));
        let body = body.linvel(-SPEED * Vec3::Y).soft_ccd_prediction(0.6);
        let end = after(60, world, body, ColliderBuilder::new(plate.clone()));
        end.translation().y < -HALF
    };
    let passed = (0..64).filter(passes).count();
    assert!(passed <= 5, "{passed} of 64 passed");
}

/// A cradle of fine triangles rises under a bar of fine triangles. Its sides touch the bar first.
/// Would catch a bottom without contacts. Rapier keeps contacts of the sides for five centimetres,
/// so the bar passed through the bottom.
#[test]
fn a_cradle_that_touches_a_bar_at_its_sides_lifts_the_bar() {
    const WIDTH: Real = 0.02;
    const WALL: Real = 0.02;
    let bar = mesh::cuboid(Vec3::new(WIDTH, WIDTH, 0.1), 12);
    for (i, gap) in [0.004, 0.008, 0.012, 0.016].into_iter().enumerate() {
        let side = WIDTH + 0.001 + 0.0004 * i as Real;
        let part = |half: Vec3, x: Real, y: Real| {
            mesh::cuboid(half, 8).mapped(move |at| at + Vec3::new(x, y, 0.0))
        };
        let wall = Vec3::new(0.5 * WALL, WIDTH + WALL, WALL);
        let parts = [
            part(Vec3::new(side + WALL, WALL, WALL), 0.0, -WALL),
            part(wall, side + 0.5 * WALL, WIDTH),
            part(wall, -side - 0.5 * WALL, WIDTH),
        ];
        let cradle = ColliderBuilder::new(Mesh::merged("cradle", &parts).shape());
        let mut world = world_of([], SbbkDispatcher::default());
        for z in [0.085, -0.085] {
            let support = ColliderBuilder::cuboid(0.05, 0.05, 0.01);
            world.insert(RigidBodyBuilder::fixed().translation(Vec3::new(0.0, -0.05, z)), support);
        }
        let body = RigidBodyBuilder::dynamic().translation(WIDTH * Vec3::Y);
        let (body, _) = world.insert(body, ColliderBuilder::new(bar.shape()));
        let lift = RigidBodyBuilder::kinematic_velocity_based().translation(-gap * Vec3::Y);
        let (lift, _) = world.insert(lift, cradle);
        (0..30).for_each(|_| world.step());
        world.bodies[lift].set_linvel(0.1 * Vec3::Y, true);
        (0..120).for_each(|_| world.step());
        let [body, lift] = [body, lift].map(|body| world.bodies[body].translation().y);
        let depth = lift - (body - WIDTH);
        assert!(depth < 0.002, "{depth} deep in a cradle {gap} below");
    }
}
