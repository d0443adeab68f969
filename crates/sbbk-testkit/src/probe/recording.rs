//! A dispatcher that records the answers of another one.

use std::sync::{Arc, Mutex, PoisonError};

use rapier3d::math::{Pose, Real, Vector};
use rapier3d::parry::query::details::{NormalConstraints, ShapeCastOptions};
use rapier3d::parry::query::{
    ClosestPoints, Contact, ContactManifold, ContactManifoldsWorkspace, NonlinearRigidMotion,
    PersistentQueryDispatcher, QueryDispatcher, ShapeCastHit, ShapeDistance, ShapeIntersection,
    Unsupported,
};
use rapier3d::parry::shape::Shape;

use super::{Answer, Question};

/// Answers of one [`Recording`] dispatcher, while they are recorded; clones share them.
#[derive(Clone, Debug, Default)]
pub struct Probe(Arc<Mutex<Option<Vec<Answer>>>>);

impl Probe {
    /// Keeps the answer of each query of two meshes from now on, until [`Self::take_answers`]. Off at
    /// first: recording allocates, so steps that record are not steps to time.
    pub fn start_recording(&self) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(Vec::new());
    }

    /// Stops recording; the answers since [`Self::start_recording`], in the order of the calls.
    pub fn take_answers(&self) -> Vec<Answer> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take().unwrap_or_default()
    }
}

/// Passes every query on unchanged, and records answers about two meshes.
pub struct Recording<D: ?Sized> {
    probe: Probe,
    inner: Arc<D>,
}

impl<D: ?Sized> Recording<D> {
    /// A dispatcher around `inner` that records into `probe`.
    pub fn new(inner: Arc<D>, probe: Probe) -> Self {
        Self { probe, inner }
    }
}

macro_rules! forward {
    ($($name:ident($($argument:ident: $type:ty),*) -> $result:ty;)*) => {$(
        fn $name(&self, $($argument: $type),*) -> Result<$result, Unsupported> {
            self.inner.$name($($argument),*)
        }
    )*};
}

impl<D: QueryDispatcher + ?Sized> QueryDispatcher for Recording<D> {
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

impl<M, C, D> PersistentQueryDispatcher<M, C> for Recording<D>
where
    D: PersistentQueryDispatcher<M, C> + ?Sized,
{
    fn contact_manifolds(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
        manifolds: &mut Vec<ContactManifold<M, C>>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Result<(), Unsupported> {
        let result =
            (self.inner).contact_manifolds(pos12, g1, g2, prediction, manifolds, workspace);
        let mut answers = self.probe.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(answers) = &mut *answers
            && [g1, g2].iter().all(|shape| shape.as_trimesh().is_some())
        {
            answers.push(Answer::new(Question::new(pos12, [g1, g2], prediction), manifolds));
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
            manifold: &mut ContactManifold<M, C>
        ) -> ();
    }
}
