//! A dispatcher around another one that records its answers about two meshes.

use std::sync::{Arc, Mutex, PoisonError};

use rapier3d::geometry::{ContactData, ContactManifold, ContactManifoldData};
use rapier3d::math::{Pose, Real, Vector};
use rapier3d::parry::query::details::{NormalConstraints, ShapeCastOptions};
use rapier3d::parry::query::{
    ClosestPoints, Contact, ContactManifoldsWorkspace, NonlinearRigidMotion,
    PersistentQueryDispatcher, QueryDispatcher, ShapeCastHit, ShapeDistance, ShapeIntersection,
    Unsupported,
};
use rapier3d::parry::shape::Shape;

/// The dispatchers that Rapier takes.
pub type SharedDispatcher = Arc<dyn PersistentQueryDispatcher<ContactManifoldData, ContactData>>;

/// A call of `contact_manifolds` for two meshes.
#[derive(Clone, Debug)]
pub struct Answer {
    /// [`shape_address`] of both meshes.
    pub shapes: [usize; 2],
    /// Pose of the second mesh in the first one's frame.
    pub pos12: Pose,
    /// The prediction distance of the call.
    pub prediction: Real,
    /// The manifolds after the call.
    pub manifolds: Vec<ContactManifold>,
}

/// Address of a shape, unique as long as the shape lives.
pub fn shape_address(shape: &dyn Shape) -> usize {
    std::ptr::from_ref(shape).cast::<()>().addr()
}

/// Passes every query on unchanged, and records answers about two meshes in the order of the calls.
/// Recording allocates, so steps that record are not steps to time.
pub struct Recording {
    pub inner: SharedDispatcher,
    pub answers: Arc<Mutex<Vec<Answer>>>,
}

macro_rules! forward {
    ($($name:ident($($argument:ident: $type:ty),*) -> $result:ty;)*) => {$(
        fn $name(&self, $($argument: $type),*) -> Result<$result, Unsupported> {
            self.inner.$name($($argument),*)
        }
    )*};
}

impl QueryDispatcher for Recording {
    forward! {
        intersection_test(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> ShapeIntersection;
        distance(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> ShapeDistance;
        contact(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape, near: Real) -> Option<Contact>;
        closest_points(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape, near: Real) -> ClosestPoints;
        cast_shapes(
            pos12: &Pose,
            local_vel12: Vector,
            g1: &dyn Shape,
            g2: &dyn Shape,
            options: ShapeCastOptions
        ) -> Option<ShapeCastHit>;
        cast_shapes_nonlinear(
            motion1: &NonlinearRigidMotion,
            g1: &dyn Shape,
            motion2: &NonlinearRigidMotion,
            g2: &dyn Shape,
            start_time: Real,
            end_time: Real,
            stop_at_penetration: bool
        ) -> Option<ShapeCastHit>;
    }
}

impl PersistentQueryDispatcher<ContactManifoldData, ContactData> for Recording {
    fn contact_manifolds(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
        manifolds: &mut Vec<ContactManifold>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Result<(), Unsupported> {
        let result =
            (self.inner).contact_manifolds(pos12, g1, g2, prediction, manifolds, workspace);
        if [g1, g2].iter().all(|shape| shape.as_trimesh().is_some()) {
            let (shapes, manifolds) = ([g1, g2].map(shape_address), manifolds.clone());
            let answer = Answer { shapes, pos12: *pos12, prediction, manifolds };
            self.answers.lock().unwrap_or_else(PoisonError::into_inner).push(answer);
        }
        result
    }

    forward! {
        contact_manifold_convex_convex(
            pos12: &Pose,
            g1: &dyn Shape,
            g2: &dyn Shape,
            constraints1: Option<&dyn NormalConstraints>,
            constraints2: Option<&dyn NormalConstraints>,
            prediction: Real,
            manifold: &mut ContactManifold
        ) -> ();
    }
}
