//! A cube that slides and a ball that rolls over fine meshes, beside the same on a cuboid.

use glamx::{Pose3, Quat, Vec3};
use rapier3d::dynamics::RigidBodyBuilder;
use rapier3d::geometry::ColliderBuilder;

use super::Trial;
use super::figures::{Figures, largest};
use super::kit::{Column, Form, Kit};
use crate::mesh::{self, Mesh};
use crate::scene::{SceneError, random};

/// Length of a floor along the way, and its width.
const LENGTH: f32 = 30.0;
const WIDTH: f32 = 6.0;
const HALF_EXTENTS: Vec3 = Vec3::new(0.5 * LENGTH, 0.5, 0.5 * WIDTH);
/// How high bodies start above it.
const GAP: f32 = 0.001;
const STEPS: usize = 180;
/// Steps at the start in which the body lands.
const LANDING: usize = 20;

/// What moves.
#[derive(Clone, Copy)]
enum Rider {
    /// Half a unit high, slides with little friction.
    Cube,
    /// Half a unit in radius, rolls.
    Ball,
}

pub(super) fn trials() -> Vec<Trial> {
    let mut trials = Vec::new();
    for (rider, name) in [(Rider::Cube, "cube slides"), (Rider::Ball, "ball rolls")] {
        for cell in [0.5, 0.1] {
            for is_slab in [false, true] {
                let floor = if is_slab { "a slab" } else { "a sheet" };
                let name = format!("{name} on {floor} of triangles of {cell}");
                let run = move |kit: &Kit| run(kit, rider, &floor_mesh(cell, is_slab));
                trials.push(Trial::new(name, run).seeded());
            }
        }
    }
    trials
}

/// Its upper side is at height 0.
fn floor_mesh(cell: f32, is_slab: bool) -> Mesh {
    let cells = [LENGTH / cell, 1.0, WIDTH / cell].map(|cells| cells.round() as u32);
    let mut floor = mesh::slab(HALF_EXTENTS, cells).mapped(|v| v - Vec3::Y * HALF_EXTENTS.y);
    if !is_slab {
        let vertices = &floor.vertices;
        floor.triangles.retain(|triangle| triangle.iter().all(|&i| vertices[i as usize].y == 0.0));
    }
    floor.welded()
}

/// Where a run has ended, and the highest speed upwards on the way.
struct Ride {
    path: f32,
    speed: f32,
    bump: f32,
}

impl Rider {
    fn start(self, kit: &Kit) -> RigidBodyBuilder {
        let mut random = kit.random();
        let place = Vec3::new(0.8 - 0.5 * LENGTH, 0.5 + GAP, random.rand_float());
        match self {
            Self::Cube => {
                let turn = Quat::from_rotation_y(random.rand_float());
                let body = RigidBodyBuilder::dynamic().pose(Pose3::from_parts(place, turn));
                body.linvel(8.0 * Vec3::X)
            }
            Self::Ball => {
                let turn = random::rotation(&mut random);
                let body = RigidBodyBuilder::dynamic().pose(Pose3::from_parts(place, turn));
                body.linvel(7.0 * Vec3::X).angvel(-14.0 * Vec3::Z)
            }
        }
    }

    fn form(self) -> Form {
        match self {
            Self::Cube => Form::cuboid(Vec3::splat(0.5), 4),
            // Rolls as the mesh that it is, in the control as well.
            Self::Ball => Form::mesh(mesh::ball(0.5, 16)),
        }
    }

    fn ride(self, kit: &Kit, floor: ColliderBuilder) -> Result<Ride, SceneError> {
        let friction = match self {
            Self::Cube => 0.1,
            Self::Ball => 0.5,
        };
        let mut world = kit.world();
        world.insert(RigidBodyBuilder::fixed(), floor.friction(friction));
        let collider = kit.collider(&self.form())?.friction(friction);
        let start = self.start(kit).can_sleep(false).build();
        let from = start.translation().x;
        let (body, _) = world.insert(start, collider);
        let mut bump = 0.0;
        for step in 1..=STEPS {
            world.step();
            if step > LANDING {
                bump = largest([bump, world.bodies[body].linvel().y]);
            }
        }
        let body = &world.bodies[body];
        Ok(Ride { path: body.translation().x - from, speed: body.linvel().x, bump })
    }
}

fn run(kit: &Kit, rider: Rider, floor: &Mesh) -> Result<Figures, SceneError> {
    let Vec3 { x, y, z } = HALF_EXTENTS;
    let cuboid = ColliderBuilder::cuboid(x, y, z).translation(-Vec3::Y * y);
    let control = rider.ride(&Kit { column: Column::Control, ..*kit }, cuboid.clone())?;
    let floor = match kit.column {
        Column::Control => cuboid,
        _ => ColliderBuilder::new(kit.mesh_shape(floor)?),
    };
    let ride = rider.ride(kit, floor)?;
    Ok(Figures::default()
        .within("path to control's", ride.path / control.path, 0.98, 1.02)
        .within("speed to control's", ride.speed / control.speed, 0.98, 1.02)
        .at_most("bump", ride.bump - control.bump, 0.1)
        .note("control's path", control.path))
}
