use crate::prelude::*;
use rapier3d::dynamics::SoftBodyBuilder;
use rapier3d::parry::shape::HeightFieldCellStatus;
pub use sbbk_testkit::scene::{Placed, SceneWorld};

/// A world of fixed colliders. Stock answers if there is no dispatcher.
pub fn world_of(
    fixed: impl IntoIterator<Item = ColliderBuilder>,
    dispatcher: impl Into<Option<SbbkDispatcher>>,
) -> PhysicsWorld {
    let mut world = PhysicsWorld::new();
    if let Some(dispatcher) = dispatcher.into() {
        world.narrow_phase.set_query_dispatcher(dispatcher);
    }
    fixed.into_iter().for_each(|collider| _ = world.insert(RigidBodyBuilder::fixed(), collider));
    world
}

/// Adds a body to a world, steps it, and looks at the body after each step. Returns it at the end.
pub fn watched(
    steps: usize,
    mut world: PhysicsWorld,
    body: RigidBodyBuilder,
    collider: ColliderBuilder,
    mut look: impl FnMut(&RigidBody),
) -> RigidBody {
    let (body, _) = world.insert(body, collider);
    for _ in 0..steps {
        world.step();
        look(&world.bodies[body]);
    }
    world.bodies[body].clone()
}

/// Adds a body to a world and steps it. Returns the body at the end.
pub fn after(
    steps: usize,
    world: PhysicsWorld,
    body: RigidBodyBuilder,
    collider: ColliderBuilder,
) -> RigidBody {
    watched(steps, world, body, collider, |_| ())
}

/// Adds bodies to a world and steps it. Returns where they are at the end.
pub fn settled(
    steps: usize,
    world: PhysicsWorld,
    bodies: impl IntoIterator<Item = Placed>,
) -> Vec<Vec3> {
    let mut bodies = SceneWorld::new(world, bodies);
    bodies.step(steps);
    bodies.poses().iter().map(|pose| pose.translation).collect()
}

/// Height of the lowest vertex of a mesh.
pub fn lowest(mesh: &Mesh, pose: &Pose) -> Real {
    mesh.clone().posed(pose).bounds().mins.y
}

/// Bodies of `shape` at these places. Stock answers if there is no dispatcher.
pub fn bodies_above(
    ground: SharedShape,
    shape: &SharedShape,
    places: impl IntoIterator<Item = Vec3>,
    angular_damping: Real,
    dispatcher: Option<SbbkDispatcher>,
) -> SceneWorld {
    let bodies = places.into_iter().map(|place| {
        let body = RigidBodyBuilder::dynamic().translation(place);
        let collider = ColliderBuilder::new(shape.clone()).density(1.0);
        (body.angular_damping(angular_damping), collider)
    });
    SceneWorld::new(world_of([ColliderBuilder::new(ground)], dispatcher), bodies)
}

/// Three dumbbells above a mesh terrain.
pub fn dumbbells(dispatcher: Option<SbbkDispatcher>) -> SceneWorld {
    let ground = mesh::terrain(12.0, 24, 0.4).shape();
    let bar = SharedShape::cuboid(0.6, 0.1, 0.1);
    let end = SharedShape::cuboid(0.3, 0.3, 0.3);
    let dumbbell = SharedShape::compound(vec![
        (Pose::IDENTITY, bar),
        (Pose::translation(-0.7, 0.0, 0.0), end.clone()),
        (Pose::translation(0.7, 0.0, 0.0), end),
    ]);
    let place = |i| Vec3::new(3.0 * (i as Real - 1.0), 1.2, 0.3 * i as Real);
    bodies_above(ground, &dumbbell, (0..3).map(place), 2.0, dispatcher)
}

/// Four heads above a terrain.
pub fn heads_above(terrain: SharedShape, dispatcher: Option<SbbkDispatcher>) -> SceneWorld {
    let head = mesh::monkey_head().shape();
    let place = |i: usize| Vec3::new(3.0 * (i % 2) as Real - 1.5, 2.2, 3.0 * (i / 2) as Real - 1.5);
    bodies_above(terrain, &head, (0..4).map(place), 3.0, dispatcher)
}

/// A bowl of twelve units across: bodies stay in it.
pub fn bowl() -> SharedShape {
    let lines = 41;
    let at = |i: usize| 12.0 * (i as Real / (lines - 1) as Real - 0.5);
    let heights = Array2::from_fn(lines, lines, |i, j| {
        0.05 * (at(i).powi(2) + at(j).powi(2)) + 0.05 * (3.0 * at(i)).sin() * (3.0 * at(j)).cos()
    });
    let mut field = HeightField::new(heights, Vec3::new(12.0, 1.0, 12.0));
    for status in field.cells_statuses_mut().data_mut() {
        *status = HeightFieldCellStatus::ZIGZAG_SUBDIVISION;
    }
    SharedShape::new(field)
}

/// A table of boxes with a rim.
pub fn table() -> SharedShape {
    let mut parts = vec![(Pose::translation(0.0, -0.5, 0.0), SharedShape::cuboid(4.0, 0.5, 4.0))];
    for (x, z) in [(4.0, 0.0), (-4.0, 0.0), (0.0, 4.0), (0.0, -4.0)] {
        let half = if x == 0.0 { [4.0, 0.2] } else { [0.2, 4.0] };
        let rim = SharedShape::cuboid(half[0], 0.6, half[1]);
        parts.push((Pose::translation(x, 0.6, z), rim));
    }
    SharedShape::compound(parts)
}

/// A soft ball above fixed ground.
pub fn soft_ball_above(ground: &SharedShape, dispatcher: Option<&SbbkDispatcher>) -> PhysicsWorld {
    let mut world = world_of([ColliderBuilder::new(ground.clone())], dispatcher.cloned());
    let ball = mesh::ball(0.6, 5);
    let vertices = ball.vertices.iter().map(|v| *v + Vec3::new(0.4, 1.5, 0.3)).collect();
    let soft = SoftBodyBuilder::trimesh(vertices, ball.triangles.clone()).expect("a mesh");
    world.insert_soft_body(soft);
    world
}

pub fn particles(world: &PhysicsWorld) -> Vec<Vector> {
    world.soft_bodies().flat_map(|(_, body)| body.particle_positions()).collect()
}

/// Bodies as meshes and convex bodies of every kind on a mesh ground, all lengths times `unit`.
pub fn mixed(unit: Real, has_soft_ccd: bool) -> PhysicsWorld {
    let ground = mesh::terrain(8.0 * unit, 16, 0.3 * unit).shape();
    let mut world = world_of([ColliderBuilder::new(ground)], None);
    world.integration_parameters.contact_recycling = false;
    world.integration_parameters.length_unit = unit;
    world.gravity *= unit;
    let head = mesh::monkey_head_with(6).mapped(|vertex| 0.3 * unit * vertex);
    let cloud: Vec<Vec3> = head.vertices.iter().step_by(7).copied().collect();
    let [half, thin] = [0.25 * unit, 0.1 * unit];
    let dumbbell = [-half, half].map(|x| (Pose::translation(x, 0.0, 0.0), SharedShape::ball(half)));
    let shapes = [
        head.shape(),
        SharedShape::ball(half),
        SharedShape::cuboid(half, thin, half),
        SharedShape::capsule_y(half, thin),
        SharedShape::cylinder(thin, half),
        SharedShape::cone(half, half),
        SharedShape::convex_hull(&cloud).expect("a head has a hull"),
        SharedShape::round_cylinder(thin, half, 0.3 * thin),
        SharedShape::round_cuboid(half, thin, thin, 0.3 * thin),
        SharedShape::compound(dumbbell.to_vec()),
    ];
    for (i, shape) in shapes.into_iter().enumerate() {
        let (row, column) = ((i / 4) as Real, (i % 4) as Real);
        let place = unit * Vec3::new(1.1 * column - 1.6, 0.9, 1.1 * row - 1.2);
        let ccd = if has_soft_ccd { 0.5 * unit } else { 0.0 };
        let body = RigidBodyBuilder::dynamic().translation(place).soft_ccd_prediction(ccd);
        let body = body.rotation(Vec3::new(0.2 * i as Real, 0.5, 0.1)).can_sleep(false);
        world.insert(body, ColliderBuilder::new(shape).density(1.0));
    }
    world
}
