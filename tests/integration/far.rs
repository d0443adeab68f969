//! Contacts of fine meshes beyond the reach of their candidates.

use crate::prelude::*;

/// A cradle of fine triangles rises under a bar of fine triangles. Its sides touch the bar first. Would catch a bottom without contacts.
/// Rapier keeps contacts of the sides for five centimetres, so the bar passed through the bottom.
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
