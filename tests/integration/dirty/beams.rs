use glamx::{Pose3, Vec2, Vec3};
use rapier3d::dynamics::RigidBodyBuilder;
use rapier3d::geometry::{ColliderBuilder, SharedShape};
use sbbk_testkit::mesh::{self, Mesh};

use super::table::{Case, judge};
use super::{FLAGS, row, world};

/// Distance of beams, half the width of a top, width and depth of a chamfer, and depth of a beam.
const PITCH: f32 = 0.56;
const TOP: f32 = 0.115;
const CHAMFER: [f32; 2] = [0.038, 0.025];
const DEPTH: f32 = 0.6;
/// Beams to either side of the middle one.
const BEAMS: i32 = 8;
const HALF_WIDTH: f32 = 2.0;
/// A box that always spans a gap.
const HALF: Vec3 = Vec3::new(0.4, 0.9, 0.4);
/// Turning point of the box, its drift, and the speed upwards that is no launch.
const RANGE: Vec2 = Vec2::new(3.5, 0.5);
const DRIFT: f32 = 0.5;
const MOST: f32 = 0.05;
const STEPS: usize = 300;
const LANDING: usize = 10;

/// Section of a beam from its left foot to its right one.
fn section() -> [Vec2; 6] {
    let [width, depth] = CHAMFER;
    let right = [(TOP, 0.0), (TOP + width, -depth), (TOP + width, -DEPTH)];
    let left = right.map(|(x, y)| (-x, y));
    [left[2], left[1], left[0], right[0], right[1], right[2]].map(|(x, y)| Vec2::new(x, y))
}

/// Closed beams with tops at height 0.
fn beams() -> Mesh {
    let middle = 0.5 * DEPTH;
    let mut outline = section().map(|point| point + Vec2::Y * middle);
    // Counter-clockwise, about the origin.
    outline.reverse();
    let beam = mesh::prism(&outline, HALF_WIDTH);
    let beams = (-BEAMS..=BEAMS).map(|k| {
        let place = Vec3::new(PITCH * k as f32, -middle, 0.0);
        beam.clone().mapped(|v| v + place)
    });
    Mesh::merged("beams", &beams.collect::<Vec<Mesh>>())
}

/// A sheet of beams with pits between them.
fn pits() -> Mesh {
    let at = |k: i32| Vec2::X * (PITCH * k as f32);
    let profile = (-BEAMS..=BEAMS).flat_map(|k| section().map(|point| point + at(k)));
    mesh::furrows(&profile.collect::<Vec<Vec2>>(), HALF_WIDTH, 12)
}

/// The beams as convex hulls, which Rapier's own code handles.
fn hulls() -> SharedShape {
    let hulls = (-BEAMS..=BEAMS).map(|k| {
        let place = Vec2::X * (PITCH * k as f32);
        let ends = |point: Vec2| [-HALF_WIDTH, HALF_WIDTH].map(|z| (point + place).extend(z));
        let points: Vec<Vec3> = section().into_iter().flat_map(ends).collect();
        (Pose3::IDENTITY, SharedShape::convex_hull(&points).expect("a hull"))
    });
    SharedShape::compound(hulls.collect())
}

/// Drives a box that cannot turn to and fro. Returns the number of its launches and the highest
/// speed upwards.
fn drive(ground: &SharedShape, body: &SharedShape, speed: f32) -> (usize, f32) {
    let [ground, body] =
        [ground, body].map(|shape| ColliderBuilder::new(shape.clone()).friction(0.0));
    let mut world = world(ground);
    let start = RigidBodyBuilder::dynamic().translation(Vec3::new(-3.0, HALF.y + 0.002, 0.1));
    let (handle, _) = world.insert(start.lock_rotations().can_sleep(false), body);
    let (mut launches, mut highest, mut was_launched) = (0, 0.0_f32, false);
    let mut way = Vec2::new(speed, DRIFT);
    for step in 0..STEPS {
        let body = &mut world.bodies[handle];
        let place = body.translation();
        for (way, (place, range)) in
            [(&mut way.x, (place.x, RANGE.x)), (&mut way.y, (place.z, RANGE.y))]
        {
            if place.abs() > range {
                *way = -way.abs() * place.signum();
            }
        }
        let up = body.linvel().y;
        body.set_linvel(Vec3::new(way.x, up, way.y), true);
        world.step();
        if step >= LANDING {
            let rise = world.bodies[handle].linvel().y;
            highest = highest.max(rise);
            launches += usize::from(rise > MOST && !was_launched);
            was_launched = rise > MOST;
        }
    }
    (launches, highest)
}

/// Would catch contacts with chamfers below the tops over which a box slides. Rapier's hulls launch
/// boxes as well.
#[test]
fn boxes_are_not_launched_by_chamfers_below_them() {
    let mut cases = Vec::new();
    let cuboid = SharedShape::cuboid(HALF.x, HALF.y, HALF.z);
    for flags in FLAGS {
        let [beams, pits] = [beams(), pits()].map(|mesh| mesh.shape_with(flags));
        let cube = mesh::cuboid(HALF, 2).shape_with(flags);
        let columns = [
            ("cuboid on hulls", hulls(), &cuboid),
            ("cuboid on beams", beams.clone(), &cuboid),
            ("mesh on beams", beams, &cube),
            ("cuboid on pits", pits.clone(), &cuboid),
            ("mesh on pits", pits, &cube),
        ];
        for speed in [1.0, 2.0, 3.0, 5.0, 7.0, 9.0, 10.0] {
            for (column, ground, body) in &columns {
                let (launches, highest) = drive(ground, body, speed);
                let shown = format!("{launches}, {highest:.2}");
                let is_right = launches == 0 || ground.as_compound().is_some();
                let row = row(&format!("{speed} m/s"), flags);
                cases.push(Case { row, column, shown, is_right });
            }
        }
    }
    judge("beams with chamfers: launches in 5 s, and highest speed upwards", &cases, KNOWN);
}

/// Speeds, and boxes on grounds, that fail today.
const KNOWN: &[(&str, &str)] = &[
    ("1 m/s", ALL),
    ("2 m/s", ALL),
    ("3 m/s", ALL),
    ("5 m/s", ALL),
    ("7 m/s", ALL),
    ("9 m/s", ALL),
    ("10 m/s", ALL),
];
const ALL: &str = "cuboid on beams, mesh on beams, cuboid on pits, mesh on pits";
