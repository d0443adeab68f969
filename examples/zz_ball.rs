//! scratch
use rapier_integration::SbbkDispatcher;
use rapier3d::prelude::*;
fn main() {
    let kind = std::env::args().nth(1).unwrap_or_default();
    let n = 32;
    let mut v = vec![];
    let mut t = vec![];
    for i in 0..=n {
        for j in 0..=n {
            let (x, z) = (i as f32, j as f32);
            v.push(Vector::new(x, 0.3 * (0.4 * x).sin() * (0.3 * z).cos(), z));
        }
    }
    for i in 0..n {
        for j in 0..n {
            let a = (i * (n + 1) + j) as u32;
            let b = a + (n + 1) as u32;
            t.push([a, a + 1, b]);
            t.push([a + 1, b + 1, b]);
        }
    }
    let mesh = SharedShape::trimesh(v, t).unwrap();
    let mut world = PhysicsWorld::new();
    if std::env::args().nth(2).is_none() {
        world.narrow_phase.set_query_dispatcher(SbbkDispatcher::default());
    }
    world.insert(RigidBodyBuilder::fixed(), ColliderBuilder::new(mesh));
    let shape = || match kind.as_str() {
        "cuboid" => SharedShape::cuboid(0.5, 0.4, 0.3),
        "cone" => SharedShape::cone(0.5, 0.5),
        "cylinder" => SharedShape::cylinder(0.5, 0.5),
        _ => SharedShape::ball(0.5),
    };
    for i in 0..10 {
        for j in 0..10 {
            world.insert(
                RigidBodyBuilder::dynamic()
                    .can_sleep(false)
                    .translation(Vector::new(2.0 + 2.8 * i as f32, 1.0, 2.0 + 2.8 * j as f32))
                    .linvel(Vector::new(0.3, 0.0, 0.2)),
                ColliderBuilder::new(shape()),
            );
        }
    }
    let t0 = std::time::Instant::now();
    for k in 0..6000 {
        let a = 0.01 * k as f32;
        world.gravity = Vector::new(4.0 * a.sin(), -9.81, 4.0 * a.cos());
        world.step();
    }
    println!("{:?} a step", t0.elapsed() / 6000);
}
