//! A dispatcher that times another one.

use std::sync::Arc;

use rapier3d::math::{Pose, Real, Vector};
use rapier3d::parry::query::details::{NormalConstraints, ShapeCastOptions};
use rapier3d::parry::query::{
    ClosestPoints, Contact, ContactManifold, ContactManifoldsWorkspace, NonlinearRigidMotion,
    PersistentQueryDispatcher, QueryDispatcher, ShapeCastHit, ShapeDistance, ShapeIntersection,
    Unsupported,
};
use rapier3d::parry::shape::Shape;

use super::{Answer, PairKind, Probe, Question};

/// Passes every query on unchanged, and counts and times `contact_manifolds` by [`PairKind`].
///
/// Cost: two readings of the clock a timed call (see [`clock_cost`](super::clock_cost) and
/// [`Probe::time_every`]), one or two additions to shared counters, and one virtual call.
pub struct Timed<D: ?Sized> {
    probe: Probe,
    inner: Arc<D>,
}

impl<D: ?Sized> Timed<D> {
    /// A timer around `inner` that adds to `probe`.
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

impl<D: QueryDispatcher + ?Sized> QueryDispatcher for Timed<D> {
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

impl<M, C, D> PersistentQueryDispatcher<M, C> for Timed<D>
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
        let kind = PairKind::of(g1, g2);
        let result = self.probe.measure(kind, || {
            (self.inner).contact_manifolds(pos12, g1, g2, prediction, manifolds, workspace)
        });
        if kind == PairKind::MeshMesh {
            let question = Question::new(pos12, [g1, g2], prediction);
            self.probe.record(|| Answer::new(question, manifolds));
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
