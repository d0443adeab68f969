//! Bodies that slide and roll over fine meshes, beside the same bodies on a cuboid. A mesh ball
//! loses speed at its facets by chance, so several are started, each turned another way.

use super::kit::*;

/// Length of a floor along the way, and its width.
const LENGTH: f32 = 30.0;
const WIDTH: f32 = 6.0;
const HALF_EXTENTS: Vec3 = Vec3::new(0.5 * LENGTH, 0.5, 0.5 * WIDTH);
/// Height of bodies above the floor at the start.
const GAP: f32 = 0.001;
/// Steps at the start in which the body lands, and those at the end that tell its speed.
const LANDING: usize = 20;
const LAST: usize = 60;

/// A moving body: sliders are a unit high with little friction, rollers a unit in radius.
#[derive(Clone, Copy)]
struct Rider {
    name: &'static str,
    is_mesh: bool,
    rolls: bool,
    starts: usize,
    collider: fn(&Kit) -> ColliderBuilder,
    turn: fn(&mut Rand32) -> Quat,
}

const SLIDER: Rider = Rider {
    name: "cube slides",
    is_mesh: true,
    rolls: false,
    starts: 1,
    collider: |kit| kit.collider(&Form::cuboid(Vec3::splat(0.5), 4)),
    turn: |random| Quat::from_rotation_y(random.rand_float()),
};
const BALL: Rider = Rider {
    name: "smooth ball rolls",
    is_mesh: false,
    rolls: true,
    collider: |_| ColliderBuilder::ball(1.0),
    turn: random::rotation,
    ..SLIDER
};
const LYING: Rider = Rider { turn: |_| Quat::from_rotation_x(FRAC_PI_2), ..BALL };

const RIDERS: [Rider; 6] = [
    SLIDER,
    // Rolls as the mesh that it is, in the control as well.
    Rider {
        name: "ball rolls",
        is_mesh: true,
        starts: 12,
        collider: |kit| kit.mesh(&mesh::ball(1.0, 32)),
        ..BALL
    },
    Rider {
        name: "cuboid slides",
        is_mesh: false,
        collider: |_| ColliderBuilder::cuboid(0.5, 0.5, 0.5),
        ..SLIDER
    },
    BALL,
    Rider { name: "capsule rolls", collider: |_| ColliderBuilder::capsule_y(1.0, 1.0), ..LYING },
    Rider { name: "cylinder rolls", collider: |_| ColliderBuilder::cylinder(1.0, 1.0), ..LYING },
];

pub(super) fn trials() -> Vec<Trial> {
    let mut trials = Vec::new();
    for rider in RIDERS {
        for cell in [0.5, 0.1] {
            // Parry handles convex shapes on height fields.
            let floors = if rider.is_mesh { 3 } else { 2 };
            trials.extend(["sheet", "slab", "height field"][..floors].iter().map(|&floor| {
                let name = format!("{} on a {floor} of triangles of {cell}", rider.name);
                Trial::new(name, move |kit| compare(kit, rider, ground(kit, floor, cell)))
            }));
        }
    }
    trials
}

/// A floor of triangles, with its upper side at height 0.
fn ground(kit: &Kit, name: &str, cell: f32) -> ColliderBuilder {
    let [columns, rows] = [LENGTH, WIDTH].map(|side| (side / cell).round() as u32);
    if name == "height field" {
        return kit.flat_field([rows, columns], 2.0 * HALF_EXTENTS);
    }
    let cells = [columns, 1, rows];
    let mut floor = mesh::slab(HALF_EXTENTS, cells).mapped(|v| v - Vec3::Y * HALF_EXTENTS.y);
    if name == "sheet" {
        floor = floor.keeping(|corners| corners.iter().all(|corner| corner.y == 0.0));
    }
    kit.mesh(&floor.welded())
}

/// Path of a body in all and in the last second, and its highest speed upwards.
struct Ride {
    path: f32,
    speed: f32,
    bump: f32,
}

impl Rider {
    /// Height of the middle, in units.
    fn height(self) -> f32 {
        if self.rolls { 1.0 } else { 0.5 }
    }

    fn start(self, random: &mut Rand32) -> RigidBodyBuilder {
        let place = Vec3::new(2.0 - 0.5 * LENGTH, self.height() + GAP, random.rand_float());
        let speed = if self.rolls { 3.5 } else { 8.0 };
        let roll = if self.rolls { speed / self.height() } else { 0.0 };
        let pose = Pose3::from_parts(place, (self.turn)(random));
        let body = RigidBodyBuilder::dynamic().pose(pose);
        body.linvel(speed * Vec3::X).angvel(-roll * Vec3::Z).can_sleep(false)
    }

    /// Means over all starts, and the highest bump.
    fn rides(self, kit: &Kit, floor: &ColliderBuilder) -> Ride {
        let mut random = seeded();
        let rides = (0..self.starts).map(|_| self.ride(kit, self.start(&mut random), floor));
        let rides: Vec<Ride> = rides.collect();
        let mean = |of: fn(&Ride) -> f32| rides.iter().map(of).sum::<f32>() / rides.len() as f32;
        let bump = largest(rides.iter().map(|ride| ride.bump));
        Ride { path: mean(|ride| ride.path), speed: mean(|ride| ride.speed), bump }
    }

    fn ride(self, kit: &Kit, start: RigidBodyBuilder, floor: &ColliderBuilder) -> Ride {
        // A path of about 20 units.
        let (friction, steps) = if self.rolls { (0.5, 340) } else { (0.1, 180) };
        let mut world = kit.world();
        world.fix(Vec3::ZERO, floor.clone().friction(friction));
        let body = world.add(start, &(self.collider)(kit).friction(friction));
        let mut bump = 0.0;
        let mut way = vec![world.bodies[body].translation().x];
        for step in 1..=steps {
            world.step();
            way.push(world.bodies[body].translation().x);
            if step > LANDING {
                bump = largest([bump, world.bodies[body].linvel().y]);
            }
        }
        let end = way[steps];
        Ride { path: end - way[0], speed: end - way[steps - LAST], bump }
    }
}

fn compare(kit: &Kit, rider: Rider, floor: ColliderBuilder) -> Figures {
    let Vec3 { x, y, z } = HALF_EXTENTS;
    let cuboid = ColliderBuilder::cuboid(x, y, z).translation(-Vec3::Y * y);
    let control = rider.rides(&Kit::new(kit.column, None), &cuboid);
    let floor = if kit.column == Column::Control { cuboid } else { floor };
    let ride = rider.rides(kit, &floor);
    Figures::default()
        .within("path to that on a cuboid", ride.path / control.path, [0.98, 1.02])
        .within("speed to that on a cuboid", ride.speed / control.speed, [0.98, 1.02])
        .at_most("bump", ride.bump - control.bump, 0.1)
        .note("path on a cuboid", control.path)
}
