//! Compares SBBK with stock Rapier and with the right answer. A mesh box slides over a mesh floor,
//! and mesh rings fall in a pile.
//!
//! ```text
//! cargo run --release -p rapier-integration --example quick_start
//! ```

use std::time::Instant;

use rapier_integration::SbbkDispatcher;
use rapier3d::parry::shape::Cuboid;
use rapier3d::prelude::*;

/// Speed of the box at the start in m/s, and the coefficient of friction.
const SPEED: f32 = 6.0;
const FRICTION: f32 = 0.2;
/// Steps until the box stands still, and steps of the pile.
const STEPS: usize = 240;

fn main() {
    // The one line is `set_query_dispatcher`. Clones share everything; this one is kept for
    // `stats`.
    let dispatcher = SbbkDispatcher::default();
    let sbbk = |mut world: PhysicsWorld| {
        world.narrow_phase.set_query_dispatcher(dispatcher.clone());
        world
    };

    println!("A box slides at {SPEED} m/s with friction {FRICTION}. Its path:");
    println!("{:>8.3} m  closed form", SPEED * SPEED / (2.0 * FRICTION * 9.81));
    println!("{:>8.3} m  cuboid on a cuboid floor", path(slide(false)));
    println!("{:>8.3} m  mesh on a mesh floor, stock Rapier", path(slide(true)));
    println!("{:>8.3} m  mesh on a mesh floor, SBBK", path(sbbk(slide(true))));

    println!("Thirty rings, meshes of 640 triangles, in a pile:");
    for (name, world) in [("stock Rapier", pile()), ("SBBK", sbbk(pile()))] {
        let (milliseconds, sleeping) = settle(world);
        println!("{milliseconds:>8.3} ms a step, {sleeping:>2} of 30 sleep at the end  {name}");
    }
    println!("{} trees were built by SBBK", dispatcher.stats().trees);
}

/// A box on a floor. Nothing in this world is special: colliders are plain `TriMesh`es or cuboids.
fn slide(is_mesh: bool) -> PhysicsWorld {
    let mut world = PhysicsWorld::new();
    let floor = match is_mesh {
        true => trimesh(grid(40.0, 60)),
        false => ColliderBuilder::cuboid(20.0, 0.5, 20.0).translation(Vector::Y * -0.5),
    };
    world.insert(RigidBodyBuilder::fixed(), floor.friction(FRICTION));
    let half_extents = Vector::new(0.5, 0.3, 0.4);
    let collider = match is_mesh {
        true => trimesh(Cuboid::new(half_extents).to_trimesh()),
        false => ColliderBuilder::cuboid(half_extents.x, half_extents.y, half_extents.z),
    };
    let body = RigidBodyBuilder::dynamic().translation(Vector::new(-9.0, 0.3, 0.17));
    world.insert(body.linvel(Vector::X * SPEED), collider.friction(FRICTION));
    world
}

/// How far the last body of a world slides.
fn path(mut world: PhysicsWorld) -> f32 {
    let place = |world: &PhysicsWorld| {
        world.bodies.iter().last().map_or(Vector::ZERO, |(_, body)| body.translation())
    };
    let start = place(&world);
    (0..STEPS).for_each(|_| world.step());
    (place(&world) - start).x
}

/// Rings above a floor.
fn pile() -> PhysicsWorld {
    let mut world = PhysicsWorld::new();
    world.insert(RigidBodyBuilder::fixed(), trimesh(grid(20.0, 20)));
    let ring = trimesh(ring(0.5, 0.2, 32, 10));
    for index in 0..30 {
        let [x, y, z] = [index % 3, index / 6, index / 3 % 2].map(|k| k as f32);
        let place = Vector::new(0.7 * x - 0.7, 0.8 + 0.8 * y, 0.7 * z - 0.35);
        let tilt = Vector::new(0.4 * y, 0.1, 0.3 * x);
        let body = RigidBodyBuilder::dynamic().translation(place).rotation(tilt);
        world.insert(body, ring.clone());
    }
    world
}

/// Mean time of a step in milliseconds, and how many bodies sleep at the end.
fn settle(mut world: PhysicsWorld) -> (f64, usize) {
    let start = Instant::now();
    (0..STEPS).for_each(|_| world.step());
    let milliseconds = 1e3 * start.elapsed().as_secs_f64() / STEPS as f64;
    let is_asleep = |body: &RigidBody| body.is_dynamic() && body.is_sleeping();
    (milliseconds, world.bodies.iter().filter(|(_, body)| is_asleep(body)).count())
}

type Triangles = (Vec<Vector>, Vec<[u32; 3]>);

fn trimesh((vertices, indices): Triangles) -> ColliderBuilder {
    ColliderBuilder::trimesh(vertices, indices).expect("it has triangles")
}

/// A flat sheet with sides of length `size`, facing up.
fn grid(size: f32, cells: u32) -> Triangles {
    let place = |k: u32| size * (k as f32 / cells as f32 - 0.5);
    quads([cells, cells], |i, j| Vector::new(place(j), 0.0, place(i)))
}

/// A torus about the `y` axis.
fn ring(radius: f32, thickness: f32, around: u32, across: u32) -> Triangles {
    let angle = |k: u32, count: u32| std::f32::consts::TAU * (k % count) as f32 / count as f32;
    let (vertices, mut indices) = quads([around, across], |i, j| {
        let (sin, cos) = angle(j, across).sin_cos();
        let (z, x) = angle(i, around).sin_cos();
        let distance = radius + thickness * cos;
        Vector::new(distance * x, -thickness * sin, distance * z)
    });
    // The last row and column are the first: a closed mesh is a solid.
    let wrap = |k: u32| k / (across + 1) % around * (across + 1) + k % (across + 1) % across;
    indices.iter_mut().flatten().for_each(|index| *index = wrap(*index));
    (vertices, indices)
}

/// A grid of quads, two triangles each.
fn quads([rows, columns]: [u32; 2], point: impl Fn(u32, u32) -> Vector) -> Triangles {
    let vertices = (0..=rows).flat_map(|i| (0..=columns).map(move |j| (i, j)));
    let vertices = vertices.map(|(i, j)| point(i, j)).collect();
    let mut indices = Vec::new();
    for (i, j) in (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j))) {
        let [a, b] = [i * (columns + 1) + j, (i + 1) * (columns + 1) + j];
        indices.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
    }
    (vertices, indices)
}
