use glamx::Vec3;
use rapier_integration::SbbkDispatcher;
use rapier3d::geometry::SharedShape;
use rapier3d::math::{Pose, Real};
use rapier3d::pipeline::PhysicsWorld;
use rapier3d::prelude::{ColliderBuilder, RigidBodyBuilder, RigidBodyHandle};

/// A world of equal bodies above a fixed ground.
pub struct Bodies {
    world: PhysicsWorld,
    handles: Vec<RigidBodyHandle>,
}

impl Bodies {
    /// Bodies of `shape` at these places. Stock answers if there is no dispatcher.
    pub fn above(
        ground: SharedShape,
        shape: &SharedShape,
        places: impl IntoIterator<Item = Vec3>,
        angular_damping: Real,
        dispatcher: Option<SbbkDispatcher>,
    ) -> Self {
        let mut world = PhysicsWorld::new();
        if let Some(dispatcher) = dispatcher {
            world.narrow_phase.set_query_dispatcher(dispatcher);
        }
        world.insert(RigidBodyBuilder::fixed(), ColliderBuilder::new(ground));
        let insert = |place| {
            let body = RigidBodyBuilder::dynamic().translation(place);
            let collider = ColliderBuilder::new(shape.clone()).density(1.0);
            world.insert(body.angular_damping(angular_damping), collider).0
        };
        let handles = places.into_iter().map(insert).collect();
        Self { world, handles }
    }

    pub fn step(&mut self, count: usize) {
        (0..count).for_each(|_| self.world.step());
    }

    pub fn poses(&self) -> Vec<Pose> {
        self.handles.iter().map(|&body| *self.world.bodies[body].position()).collect()
    }

    pub fn manifold_count(&self) -> usize {
        self.world.narrow_phase.contact_pairs().map(|pair| pair.manifolds().len()).sum()
    }

    /// The same world, saved and restored with a new dispatcher.
    pub fn restored(&self) -> Self {
        let bytes = postcard::to_stdvec(&self.world).expect("a world with SBBK can be saved");
        let mut world: PhysicsWorld = postcard::from_bytes(&bytes).expect("and loaded");
        world.narrow_phase.set_query_dispatcher(SbbkDispatcher::default());
        Self { world, handles: self.handles.clone() }
    }
}
