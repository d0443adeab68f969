//! Bodies that slide and roll over fine meshes, beside the same bodies on a cuboid. A mesh ball loses
//! speed at its facets by chance, so several are started, each turned another way.

use std::f32::consts::FRAC_PI_2;

use glamx::{Pose3, Quat, Vec3};
use oorandom::Rand32;
use rapier3d::dynamics::RigidBodyBuilder;
use rapier3d::geometry::{ColliderBuilder, SharedShape};

use super::Trial;
use super::figures::{Figures, largest};
use super::kit::{Column, Form, Kit};
use crate::mesh;
use crate::scene::random;

/// Length of a floor along the way, and its width.
const LENGTH: f32 = 30.0;
const WIDTH: f32 = 6.0;
const HALF_EXTENTS: Vec3 = Vec3::new(0.5 * LENGTH, 0.5, 0.5 * WIDTH);
/// Height of bodies above the floor at the start.
const GAP: f32 = 0.001;
/// Steps at the start in which the body lands, and those at the end that tell its speed.
const LANDING: usize = 20;
const LAST: usize = 60;

/// Made of triangles.
#[derive(Clone, Copy, PartialEq)]
enum Floor {
    Sheet,
    Slab,
    HeightField,
}

/// A moving body: sliders are a unit high with little friction, rollers a unit in radius.
#[derive(Clone, Copy)]
enum Rider {
    MeshCube,
    MeshBall,
    Cuboid,
    Ball,
    Capsule,
    Cylinder,
}

pub(super) fn trials() -> Vec<Trial> {
    let mut trials = Vec::new();
    let riders = [
        (Rider::MeshCube, "cube slides"),
        (Rider::MeshBall, "ball rolls"),
        (Rider::Cuboid, "cuboid slides"),
        (Rider::Ball, "smooth ball rolls"),
        (Rider::Capsule, "capsule rolls"),
        (Rider::Cylinder, "cylinder rolls"),
    ];
    for (rider, name) in riders {
        for cell in [0.5, 0.1] {
            for floor in [Floor::Sheet, Floor::Slab, Floor::HeightField] {
                // Parry handles convex shapes on height fields.
                if floor == Floor::HeightField && !rider.is_mesh() {
                    continue;
                }
                let name = format!("{name} on a {} of triangles of {cell}", floor.name());
                let run = move |kit: &Kit| run(kit, rider, floor.shape(kit, cell));
                trials.push(Trial::new(name, run).seeded());
            }
        }
    }
    trials
}

impl Floor {
    fn name(self) -> &'static str {
        match self {
            Self::Sheet => "sheet",
            Self::Slab => "slab",
            Self::HeightField => "height field",
        }
    }

    /// Its upper side is at height 0.
    fn shape(self, kit: &Kit, cell: f32) -> SharedShape {
        let [columns, rows] = [LENGTH, WIDTH].map(|side| (side / cell).round() as u32);
        if self == Self::HeightField {
            return kit.flat_field([rows, columns], 2.0 * HALF_EXTENTS);
        }
        let cells = [columns, 1, rows];
        let mut floor = mesh::slab(HALF_EXTENTS, cells).mapped(|v| v - Vec3::Y * HALF_EXTENTS.y);
        if self == Self::Sheet {
            let vertices = &floor.vertices;
            let is_top =
                |triangle: &[u32; 3]| triangle.iter().all(|&i| vertices[i as usize].y == 0.0);
            floor.triangles.retain(is_top);
        }
        kit.mesh_shape(&floor.welded())
    }
}

/// Path of a body in all and in the last second, and its highest speed upwards.
struct Ride {
    path: f32,
    speed: f32,
    bump: f32,
}

impl Rider {
    fn is_mesh(self) -> bool {
        matches!(self, Self::MeshCube | Self::MeshBall)
    }

    fn rolls(self) -> bool {
        !matches!(self, Self::MeshCube | Self::Cuboid)
    }

    /// Number of starts.
    fn starts(self) -> usize {
        if matches!(self, Self::MeshBall) { 12 } else { 1 }
    }

    /// Height of the middle, in units.
    fn height(self) -> f32 {
        if self.rolls() { 1.0 } else { 0.5 }
    }

    /// At the start, in units a second.
    fn speed(self) -> f32 {
        if self.rolls() { 3.5 } else { 8.0 }
    }

    /// Number of steps for a path of about 20 units.
    fn steps(self) -> usize {
        if self.rolls() { 340 } else { 180 }
    }

    fn start(self, random: &mut Rand32) -> RigidBodyBuilder {
        let place = Vec3::new(2.0 - 0.5 * LENGTH, self.height() + GAP, random.rand_float());
        let turn = match self {
            Self::MeshCube | Self::Cuboid => Quat::from_rotation_y(random.rand_float()),
            Self::MeshBall | Self::Ball => random::rotation(random),
            Self::Capsule | Self::Cylinder => Quat::from_rotation_x(FRAC_PI_2),
        };
        let roll = if self.rolls() { self.speed() / self.height() } else { 0.0 };
        let body = RigidBodyBuilder::dynamic().pose(Pose3::from_parts(place, turn));
        body.linvel(self.speed() * Vec3::X).angvel(-roll * Vec3::Z).can_sleep(false)
    }

    fn collider(self, kit: &Kit) -> ColliderBuilder {
        let size = self.height();
        match self {
            Self::MeshCube => kit.collider(&Form::cuboid(Vec3::splat(size), 4)),
            // Rolls as the mesh that it is, in the control as well.
            Self::MeshBall => kit.collider(&Form::mesh(mesh::ball(size, 32))),
            Self::Cuboid => ColliderBuilder::cuboid(size, size, size),
            Self::Ball => ColliderBuilder::ball(size),
            Self::Capsule => ColliderBuilder::capsule_y(size, size),
            Self::Cylinder => ColliderBuilder::cylinder(size, size),
        }
    }

    fn friction(self) -> f32 {
        if self.rolls() { 0.5 } else { 0.1 }
    }

    /// Means over all starts, and the highest bump.
    fn rides(self, kit: &Kit, floor: &ColliderBuilder) -> Ride {
        let (mut random, count) = (kit.random(), self.starts());
        let rides = (0..count).map(|_| self.ride(kit, self.start(&mut random), floor.clone()));
        let sum = rides.reduce(|sum, ride| Ride {
            path: sum.path + ride.path,
            speed: sum.speed + ride.speed,
            bump: largest([sum.bump, ride.bump]),
        });
        let sum = sum.expect("there is a start");
        Ride { path: sum.path / count as f32, speed: sum.speed / count as f32, ..sum }
    }

    fn ride(self, kit: &Kit, start: RigidBodyBuilder, floor: ColliderBuilder) -> Ride {
        let mut world = kit.world();
        world.fix(Vec3::ZERO, floor.friction(self.friction()));
        let collider = self.collider(kit).friction(self.friction());
        let body = world.add(start, &collider);
        let mut bump = 0.0;
        let mut way = vec![world.bodies[body].translation().x];
        for step in 1..=self.steps() {
            world.step();
            way.push(world.bodies[body].translation().x);
            if step > LANDING {
                bump = largest([bump, world.bodies[body].linvel().y]);
            }
        }
        let end = way[self.steps()];
        Ride { path: end - way[0], speed: end - way[self.steps() - LAST], bump }
    }
}

fn run(kit: &Kit, rider: Rider, floor: SharedShape) -> Figures {
    let Vec3 { x, y, z } = HALF_EXTENTS;
    let cuboid = ColliderBuilder::cuboid(x, y, z).translation(-Vec3::Y * y);
    let control = rider.rides(&Kit { film: None, ..kit.clone() }, &cuboid);
    let floor = match kit.column {
        Column::Control => cuboid,
        _ => ColliderBuilder::new(floor),
    };
    let ride = rider.rides(kit, &floor);
    Figures::default()
        .within("path to that on a cuboid", ride.path / control.path, 0.98, 1.02)
        .within("speed to that on a cuboid", ride.speed / control.speed, 0.98, 1.02)
        .at_most("bump", ride.bump - control.bump, 0.1)
        .note("path on a cuboid", control.path)
}
