//! Worlds whose bodies are led along a run.

use crate::prelude::*;
use rapier3d::dynamics::{RigidBodyMassProps, RigidBodyVelocity};
use rapier3d::geometry::InteractionGroups;

/// Pose and velocity of a body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    pose: Pose,
    velocity: RigidBodyVelocity<Real>,
}

/// The watched bodies before each step of a run with default parameters, and after `last` steps.
pub(super) fn run(
    scene: &dyn Scene,
    backend: Backend,
    last: usize,
    mut done: impl FnMut(),
) -> Vec<Vec<Motion>> {
    let mut led = Led::new(scene, backend);
    let mut run = vec![led.motions()];
    for _ in 0..last {
        led.built.world.step();
        run.push(led.motions());
        done();
    }
    run
}

/// A world of a scene whose bodies are led.
pub(super) struct Led {
    pub built: SceneWorld,
    _dispatcher: Dispatcher,
    /// Milliseconds of all steps so far.
    pub times: Vec<f64>,
}

impl Led {
    pub fn new(scene: &dyn Scene, backend: Backend) -> Self {
        let mut built = scene.build();
        let _dispatcher = backend.install(&mut built.world);
        Self { built, _dispatcher, times: Vec::new() }
    }

    /// A world without contacts.
    pub fn without_contacts(scene: &dyn Scene) -> Self {
        let mut led = Self::new(scene, Backend::Stock);
        for (_, collider) in led.built.world.colliders.iter_mut() {
            collider.set_collision_groups(InteractionGroups::none());
        }
        led
    }

    /// Steps once from each state, with the contacts and impulses of the step before. Returns the
    /// motions after the last step.
    pub fn lead(&mut self, states: &[Vec<Motion>]) -> Vec<Motion> {
        for state in states {
            for (&handle, motion) in self.built.watched.iter().zip(state) {
                let body = &mut self.built.world.bodies[handle];
                body.set_position(motion.pose, true);
                body.set_vels(motion.velocity, true);
            }
            let start = Instant::now();
            self.built.world.step();
            self.times.push(1e3 * start.elapsed().as_secs_f64());
        }
        self.motions()
    }

    fn motions(&self) -> Vec<Motion> {
        let bodies = self.built.watched.iter().map(|&body| &self.built.world.bodies[body]);
        bodies.map(|body| Motion { pose: *body.position(), velocity: *body.vels() }).collect()
    }
}

/// Norm of velocities, weighted by mass: the root of twice the kinetic energy.
pub(super) struct Norm(Vec<RigidBodyMassProps>);

impl Norm {
    pub fn of(scene: &dyn Scene, state: &[Motion]) -> Self {
        let built = scene.build();
        let properties = built.watched.iter().zip(state).map(|(&handle, motion)| {
            let body = &built.world.bodies[handle];
            let mut properties = body.mass_properties().clone();
            properties.update_world_mass_properties(body.body_type(), &motion.pose);
            properties
        });
        Self(properties.collect())
    }

    /// Distance of two motions of all bodies.
    pub fn distance(&self, some: &[Motion], others: &[Motion]) -> f64 {
        let energies = self.0.iter().zip(some).zip(others).map(|((properties, some), other)| {
            f64::from((some.velocity - other.velocity).kinetic_energy(properties))
        });
        (2.0 * energies.sum::<f64>()).sqrt()
    }
}
