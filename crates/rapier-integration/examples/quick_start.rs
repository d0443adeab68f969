//! Plain Rapier with SBBK: a ball, a cylinder and a cuboid, all as triangle meshes, fall on a mesh
//! floor.
//!
//! ```text
//! cargo run --release --example quick_start
//! ```

use rapier_integration::SbbkDispatcher;
use rapier3d::parry::shape::{Ball, Cuboid, Cylinder};
use rapier3d::prelude::*;

/// Three seconds.
const STEPS: usize = 180;

fn main() {
    let (mut stock, _) = world();
    let (mut sbbk, bodies) = world();

    // The one line. Clones share everything; keep one to ask it for numbers later.
    let dispatcher = SbbkDispatcher::default();
    sbbk.narrow_phase.set_query_dispatcher(dispatcher.clone());

    for _ in 0..STEPS {
        stock.step();
        sbbk.step();
    }

    println!("where bodies are after {STEPS} steps");
    for (name, body) in bodies {
        // Both worlds were built alike, so the handles are the same.
        let [with_stock, with_sbbk] = [&stock, &sbbk].map(|world| world.bodies[body].translation());
        println!("{name:>10}: stock {with_stock:6.3}, SBBK {with_sbbk:6.3}");
    }

    // More is counted with `SbbkConfig::count_queries`.
    let stats = dispatcher.stats();
    println!(
        "{} trees of {} KiB, found {} times",
        stats.trees,
        stats.tree_bytes / 1024,
        stats.tree_hits
    );
}

/// A floor and three bodies above it. Nothing in it knows SBBK: colliders are plain `TriMesh`es.
fn world() -> (PhysicsWorld, Vec<(&'static str, RigidBodyHandle)>) {
    let mut world = PhysicsWorld::new();

    let (vertices, indices) = Cuboid::new(Vector::new(10.0, 0.5, 10.0)).to_trimesh();
    let floor = trimesh(vertices, indices).translation(Vector::new(0.0, -0.5, 0.0));
    world.insert(RigidBodyBuilder::fixed(), floor);

    let (ball, cylinder, cuboid) =
        (Ball::new(0.5), Cylinder::new(0.2, 0.5), Cuboid::new(Vector::new(0.6, 0.2, 0.4)));
    let meshes = [
        ("ball", ball.to_trimesh(24, 12)),
        ("cylinder", cylinder.to_trimesh(24)),
        ("cuboid", cuboid.to_trimesh()),
    ];
    let bodies = (0..).zip(meshes).map(|(index, (name, (vertices, indices)))| {
        let place = Vector::new(2.0 * index as f32 - 2.0, 1.5, 0.0);
        let tilt = Vector::new(0.1, 0.0, 0.2);
        let body =
            RigidBodyBuilder::dynamic().translation(place).rotation(tilt).angular_damping(0.5);
        (name, world.insert(body, trimesh(vertices, indices)).0)
    });
    let bodies = bodies.collect();
    (world, bodies)
}

/// Without a flag. For convex bodies the floor would have `TriMeshFlags::FIX_INTERNAL_EDGES`.
fn trimesh(vertices: Vec<Vector>, indices: Vec<[u32; 3]>) -> ColliderBuilder {
    ColliderBuilder::trimesh(vertices, indices).expect("it has triangles")
}
