//! Bodies that are released in each other.

use glamx::{Pose3, Vec3};
use rapier3d::dynamics::RigidBodyBuilder;

use super::Trial;
use super::depth::Depths;
use super::figures::{Figures, largest};
use super::kit::{Form, Kit};
use crate::mesh;
use crate::scene::random;

const BODIES: usize = 8;
const STEPS: usize = 120;
/// Bodies are a unit long, and start with their centres in a cube of this side.
const SPREAD: f32 = 1.0;

pub(super) fn trials() -> Vec<Trial> {
    let balls = Trial::new("eight balls in each other", |kit| run(kit, &Form::ball(0.5, 8)));
    let heads = Trial::new("eight heads in each other", |kit| {
        run(kit, &Form::mesh(mesh::monkey_head().centred().scaled_to(1.0)))
    });
    vec![balls.seeded(), heads.without_control().seeded()]
}

fn run(kit: &Kit, form: &Form) -> Figures {
    let mut world = kit.world();
    world.gravity = Vec3::ZERO;
    let mut random = kit.random();
    let collider = kit.collider(form);
    for _ in 0..BODIES {
        let place = Vec3::from_array([(); 3].map(|()| SPREAD * (random.rand_float() - 0.5)));
        let pose = Pose3::from_parts(place, random::rotation(&mut random));
        world.add(RigidBodyBuilder::dynamic().pose(pose), &collider);
    }
    let mut fastest = 0.0_f32;
    for _ in 0..STEPS {
        world.step();
        fastest = largest([fastest, world.top_speed()]);
    }
    let depths = Depths::new(&form.mesh);
    let poses = world.watched.iter().map(|&body| *world.bodies[body].position());
    let poses: Vec<Pose3> = poses.collect();
    let pairs = (1..BODIES).flat_map(|j| (0..j).map(move |i| [i, j]));
    let depths = pairs.map(|[i, j]| depths.between(&poses[i], &depths, &poses[j]));
    let depths: Vec<f32> = depths.collect();
    let apart = depths.iter().filter(|&&depth| depth <= APART).count();
    Figures::default()
        .none("pairs not apart", depths.len() - apart)
        .at_most("speed", fastest, 5.0)
        .note("deepest", largest(depths))
}

/// Pairs that are no deeper in each other only touch.
const APART: f32 = 0.01;
