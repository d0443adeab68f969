//! Worlds whose bodies are led along a run.

use crate::prelude::*;
use rapier3d::dynamics::{IntegrationParameters, RigidBody};
use rapier3d::geometry::InteractionGroups;

use crate::metrics::timed_step;

/// Pose and velocities of a body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    pose: Pose,
    linear: Vector,
    angular: Vector,
}

impl Motion {
    fn of(body: &RigidBody) -> Self {
        Self { pose: *body.position(), linear: body.linvel(), angular: body.angvel() }
    }
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
    built: SceneWorld,
    _installed: Installed,
    /// Times of all steps so far.
    pub times: Vec<StepTimes>,
}

impl Led {
    pub fn new(scene: &dyn Scene, backend: Backend) -> Self {
        let mut built = scene.build();
        let _installed = backend.install(&mut built.world);
        Self { built, _installed, times: Vec::new() }
    }

    /// A world without contacts.
    pub fn without_contacts(scene: &dyn Scene) -> Self {
        let mut led = Self::new(scene, Backend::Stock);
        for (_, collider) in led.built.world.colliders.iter_mut() {
            collider.set_collision_groups(InteractionGroups::none());
        }
        led
    }

    pub fn parameters(&mut self) -> &mut IntegrationParameters {
        &mut self.built.world.integration_parameters
    }

    /// Steps once from each state, with the contacts and impulses of the step before. Returns the
    /// motions after the last step.
    pub fn lead(&mut self, states: &[Vec<Motion>]) -> Vec<Motion> {
        for state in states {
            for (&handle, motion) in self.built.watched.iter().zip(state) {
                let body = &mut self.built.world.bodies[handle];
                body.set_position(motion.pose, true);
                body.set_linvel(motion.linear, true);
                body.set_angvel(motion.angular, true);
            }
            self.times.push(timed_step(&mut self.built.world));
        }
        self.motions()
    }

    pub fn solver_points(&self) -> usize {
        solver_points(&self.built.world)
    }

    fn motions(&self) -> Vec<Motion> {
        self.built.watched.iter().map(|&body| Motion::of(&self.built.world.bodies[body])).collect()
    }
}

/// Norm of velocities, weighted by mass.
pub(super) struct Norm(Vec<Inertia>);

struct Inertia {
    mass: f64,
    /// About the principal axes, and these in the world.
    principal: DVec3,
    axes: Quat,
}

impl Norm {
    pub fn of(scene: &dyn Scene, state: &[Motion]) -> Self {
        let built = scene.build();
        let inertia = |(&handle, motion): (&RigidBodyHandle, &Motion)| {
            let properties = built.world.bodies[handle].mass_properties().local_mprops;
            Inertia {
                mass: f64::from(properties.mass()),
                principal: properties.principal_inertia().as_dvec3(),
                axes: motion.pose.rotation * properties.principal_inertia_local_frame,
            }
        };
        Self(built.watched.iter().zip(state).map(inertia).collect())
    }

    /// Distance of two motions of all bodies.
    pub fn distance(&self, some: &[Motion], others: &[Motion]) -> f64 {
        let squares = self.0.iter().zip(some).zip(others).map(|((inertia, some), other)| {
            let linear = (some.linear - other.linear).as_dvec3();
            let angular = inertia.axes.inverse() * (some.angular - other.angular);
            let angular = angular.as_dvec3();
            inertia.mass * linear.length_squared() + inertia.principal.dot(angular * angular)
        });
        squares.sum::<f64>().sqrt()
    }
}

/// Would catch moments of inertia about the wrong axes.
#[test]
fn the_norm_is_the_root_of_twice_the_energy() {
    use rapier3d::dynamics::RigidBodyBuilder;
    use rapier3d::geometry::ColliderBuilder;

    /// A turned brick, alone.
    struct Brick;

    impl Scene for Brick {
        fn name(&self) -> String {
            "brick".to_owned()
        }

        fn build(&self) -> SceneWorld {
            let mut world = rapier3d::pipeline::PhysicsWorld::new();
            world.gravity = Vector::ZERO;
            let body = RigidBodyBuilder::dynamic().rotation(Vector::new(0.4, 1.1, -0.3));
            let body = body.linvel(Vector::new(1.0, -2.0, 0.5)).angvel(Vector::new(3.0, 1.0, -2.0));
            let (body, _) = world.insert(body, ColliderBuilder::cuboid(0.2, 0.5, 1.1));
            SceneWorld { world, watched: vec![body] }
        }
    }

    let mut led = Led::new(&Brick, Backend::Stock);
    // Rapier knows a body's inertia in the world after a step.
    let motions = led.lead(&[led.motions()]);
    let energy = f64::from(led.built.world.bodies[led.built.watched[0]].kinetic_energy());
    let still = [Motion { linear: Vector::ZERO, angular: Vector::ZERO, ..motions[0] }];
    let distance = Norm::of(&Brick, &motions).distance(&motions, &still);
    assert!((distance * distance / (2.0 * energy) - 1.0).abs() < 1e-4, "{distance} {energy}");
}
