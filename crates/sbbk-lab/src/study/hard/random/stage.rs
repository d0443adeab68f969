//! Worlds of random scenes. All lengths are in sizes of the scene.

use rapier3d::parry::mass_properties::MassProperties;

use super::draw::{Draw, Part};
use crate::study::hard::kit::*;

/// A body before the first step.
#[derive(Clone)]
pub(super) struct Body {
    pub part: Part,
    pub pose: Pose3,
    pub builder: RigidBodyBuilder,
    pub friction: f32,
    pub density: f32,
}

impl Body {
    pub fn fixed(part: Part, pose: Pose3) -> Self {
        let builder = RigidBodyBuilder::fixed();
        Self { part, pose, builder, friction: 0.5, density: 1.0 }
    }

    /// A body that moves and does not sleep.
    pub fn moving(part: Part, pose: Pose3) -> Self {
        let builder = RigidBodyBuilder::dynamic().can_sleep(false);
        Self { builder, ..Self::fixed(part, pose) }
    }

    pub fn friction(self, friction: f32) -> Self {
        Self { friction, ..self }
    }

    pub fn density(self, density: f32) -> Self {
        Self { density, ..self }
    }

    /// Sets the speed, in sizes/s, and the spin.
    pub fn thrown(mut self, speed: Vec3, spin: Vec3) -> Self {
        self.builder = self.builder.linvel(speed).angvel(spin);
        self
    }
}

/// A world with the bodies of a scene.
pub(super) struct Stage {
    pub world: World,
    size: f32,
    handles: Vec<RigidBodyHandle>,
}

impl Stage {
    pub fn new(draw: &Draw, kit: &Kit, bodies: &[Body]) -> Self {
        let size = draw.size;
        let mut world = kit.world();
        world.gravity = -size * draw.gravity * Vec3::Y;
        world.integration_parameters.length_unit = size;
        world.integration_parameters.dt = draw.dt;
        let mut order: Vec<usize> = (0..bodies.len()).collect();
        if draw.is_reversed {
            order.reverse();
        }
        let mut handles = vec![RigidBodyHandle::invalid(); bodies.len()];
        for index in order {
            handles[index] = insert(&mut world, kit, &bodies[index], size);
        }
        Self { world, size, handles }
    }

    pub fn step(&mut self) {
        self.world.step();
    }

    pub fn place(&self, body: usize) -> Vec3 {
        self.world.bodies[self.handles[body]].translation() / self.size
    }

    /// The pose in metres.
    pub fn pose(&self, body: usize) -> &Pose3 {
        self.world.bodies[self.handles[body]].position()
    }

    /// Highest speed, in sizes/s.
    pub fn top_speed(&self) -> f32 {
        self.world.top_speed() / self.size
    }
}

fn insert(world: &mut World, kit: &Kit, body: &Body, size: f32) -> RigidBodyHandle {
    let Body { part, pose, builder, .. } = body;
    let scaled = |shape: &SharedShape| {
        let scaled = shape.scale_dyn(Vec3::splat(size), 1).expect("shapes scale evenly");
        SharedShape(scaled.into())
    };
    let mesh = part.form.mesh.clone().scaled(size);
    let form = Form { mesh, control: part.form.control.as_ref().map(scaled) };
    let collider = match &form.control {
        Some(control) if part.is_primitive => ColliderBuilder::new(control.clone()),
        _ => kit.collider(&form),
    };
    // The mass of a sound part, in all columns.
    let mass = &part.mass;
    let inertia = body.density * mass.principal_inertia() * size.powi(5);
    let mass = MassProperties::with_principal_inertia_frame(
        mass.local_com * size,
        body.density * mass.mass() * size.powi(3),
        inertia,
        mass.principal_inertia_local_frame,
    );
    let collider = collider.mass_properties(mass).friction(body.friction);
    let mut builder = builder.clone();
    builder.linvel *= size;
    builder = builder.pose(Pose3::from_parts(size * pose.translation, pose.rotation));
    if builder.body_type.is_dynamic() {
        return world.add(builder, &collider);
    }
    world.insert(builder, collider).0
}
