//! Worlds of random scenes. All lengths are in sizes of the scene.

use rapier3d::parry::mass_properties::MassProperties;

use super::draw::{Draw, Part};
use crate::study::hard::kit::*;

/// Energy that a scene may gain, as a share: bodies may be lifted by Rapier's prediction distance
/// and allowed error, in sizes. More lets bodies hop; less is what pushing out of an impact gains.
const GAIN: f64 = 0.025;

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

    /// Damps all motion, so that balls come to rest as well: to a thousandth in 14 falls.
    pub fn damped(mut self, draw: &Draw) -> Self {
        let damping = 0.5 * draw.gravity.sqrt();
        self.builder = self.builder.linear_damping(damping).angular_damping(damping);
        self
    }

    /// Sets the speed, in sizes/s, and the spin.
    pub fn thrown(mut self, speed: Vec3, spin: Vec3) -> Self {
        self.builder = self.builder.linvel(speed).angvel(spin);
        self
    }
}

/// A world with the bodies of a scene.
pub(super) struct Stage<'a> {
    pub world: World,
    pub draw: &'a Draw,
    bodies: &'a [Body],
    pub handles: Vec<RigidBodyHandle>,
}

impl<'a> Stage<'a> {
    pub fn new(draw: &'a Draw, kit: &Kit, bodies: &'a [Body]) -> Self {
        let size = draw.size;
        let mut world = kit.world();
        world.gravity = -size * draw.gravity * Vec3::Y;
        let parameters = &mut world.integration_parameters;
        let length_unit = draw.options.unit.unwrap_or(size);
        (parameters.length_unit, parameters.dt) = (length_unit, draw.dt);
        let mut insert = |body: &Body| insert(&mut world, kit, body, size);
        let mut handles: Vec<_> = match draw.is_reversed {
            false => bodies.iter().map(insert).collect(),
            true => bodies.iter().rev().map(&mut insert).collect(),
        };
        if draw.is_reversed {
            handles.reverse();
        }
        Self { world, draw, bodies, handles }
    }

    pub fn place(&self, body: usize) -> Vec3 {
        self.world.bodies[self.handles[body]].translation() / self.draw.size
    }

    /// The way of a body from its start.
    pub fn moved(&self, body: usize) -> Vec3 {
        self.place(body) - self.bodies[body].pose.translation
    }

    /// The pose in metres.
    pub fn pose(&self, body: usize) -> &Pose3 {
        self.world.bodies[self.handles[body]].position()
    }

    /// Runs for some seconds. Returns the greatest rise of the energy as a share. The whole is the
    /// energy of the motion at the start, and of lifting all bodies by a size.
    pub fn gain(&mut self, seconds: f32) -> f64 {
        let Draw { gravity, size, .. } = *self.draw;
        let lift = gravity * size * size;
        let bodies = self.world.watched.iter().map(|&body| &self.world.bodies[body]);
        let unit: f32 = bodies.map(|body| body.mass() * lift + body.kinetic_energy()).sum();
        self.world.rise(self.draw.steps(seconds)) / f64::from(unit)
    }

    /// Runs for the time of 20 falls from half a size. Energy must not grow, and all bodies must
    /// come to rest.
    pub fn settle(&mut self) -> Figures {
        let root = self.draw.gravity.sqrt();
        let gain = self.gain(20.0 / root);
        let speed = self.world.top_speed() / self.draw.size / root;
        Figures::default().at_most("energy gained", gain, GAIN).at_most("speed", speed, 0.05)
    }

    /// Greatest depth in each other of the bodies from number `first` on.
    pub fn deepest(&self, first: usize) -> f32 {
        let size = self.draw.size;
        let meshes = self.bodies.iter().map(|body| body.part.sound.clone().scaled(size));
        let depths: Vec<Depths> = meshes.map(|mesh| Depths::new(&mesh)).collect();
        let pairs = (first..depths.len()).flat_map(|j| (first..j).map(move |i| [i, j]));
        let between =
            |[i, j]: [usize; 2]| depths[i].between(self.pose(i), &depths[j], self.pose(j));
        largest(pairs.map(between)) / size
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
    let (mass, density) = (&part.mass, body.density);
    let mass = MassProperties::with_principal_inertia_frame(
        mass.local_com * size,
        density * mass.mass() * size.powi(3),
        density * mass.principal_inertia() * size.powi(5),
        mass.principal_inertia_local_frame,
    );
    let collider = collider.mass_properties(mass).friction(body.friction);
    let pose = Pose3::from_parts(size * pose.translation, pose.rotation);
    let mut builder = builder.clone().pose(pose);
    builder.linvel *= size;
    builder.soft_ccd_prediction *= size;
    if builder.body_type.is_dynamic() {
        return world.add(builder, &collider);
    }
    world.insert(builder, collider).0
}
