//! A pair of shapes as the narrow phase keeps it.

use rapier3d::geometry::ContactManifold;
use rapier3d::math::{Pose, Real};
use rapier3d::parry::query::ContactManifoldsWorkspace;
use rapier3d::parry::shape::Shape;

use super::SharedDispatcher;

/// Data that a host keeps of a pair of shapes from query to query.
#[derive(Default)]
pub struct Memory {
    /// Result of the last query.
    pub manifolds: Vec<ContactManifold>,
    workspace: Option<ContactManifoldsWorkspace>,
}

impl Memory {
    /// Brings the manifolds up to date.
    ///
    /// # Panics
    ///
    /// If the dispatcher does not support the shapes.
    pub fn ask(
        &mut self,
        dispatcher: &SharedDispatcher,
        [shape1, shape2]: [&dyn Shape; 2],
        pos12: &Pose,
        prediction: Real,
    ) {
        let Self { manifolds, workspace } = self;
        dispatcher
            .contact_manifolds(pos12, shape1, shape2, prediction, manifolds, workspace)
            .expect("every backend supports a mesh and the shapes of the studies");
    }
}
