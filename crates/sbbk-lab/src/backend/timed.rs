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
    ($name:ident($($argument:ident: $type:ty),* $(,)?) -> $result:ty) => {
        fn $name(&self, $($argument: $type),*) -> Result<$result, Unsupported> {
            self.inner.$name($($argument),*)
        }
    };
}

impl<D: QueryDispatcher + ?Sized> QueryDispatcher for Timed<D> {
    forward!(intersection_test(
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> ShapeIntersection);

    forward!(distance(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> ShapeDistance);

    forward!(contact(
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
    ) -> Option<Contact>);

    forward!(closest_points(
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        max_dist: Real,
    ) -> ClosestPoints);

    forward!(cast_shapes(
        pos12: &Pose,
        local_vel12: Vector,
        g1: &dyn Shape,
        g2: &dyn Shape,
        options: ShapeCastOptions,
    ) -> Option<ShapeCastHit>);

    forward!(cast_shapes_nonlinear(
        motion1: &NonlinearRigidMotion,
        g1: &dyn Shape,
        motion2: &NonlinearRigidMotion,
        g2: &dyn Shape,
        start_time: Real,
        end_time: Real,
        stop_at_penetration: bool,
    ) -> Option<ShapeCastHit>);
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

    forward!(contact_manifold_convex_convex(
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        normal_constraints1: Option<&dyn NormalConstraints>,
        normal_constraints2: Option<&dyn NormalConstraints>,
        prediction: Real,
        manifold: &mut ContactManifold<M, C>,
    ) -> ());
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use rapier3d::parry::query::DefaultQueryDispatcher;
    use rapier3d::parry::shape::{Ball, Cuboid};

    use super::*;
    use crate::mesh;

    type Manifolds = Vec<ContactManifold<(), ()>>;

    /// Would catch a wrapper that times the wrong kind of pair, forgets a call or changes the
    /// answer: one call of each kind against the inner dispatcher's own result.
    #[test]
    fn counts_each_kind_and_answers_as_the_inner_dispatcher() {
        let probe = Probe::default();
        let timed = Timed::new(Arc::new(DefaultQueryDispatcher), probe.clone());
        let ball_mesh = mesh::ball(1.0, 4).trimesh(Default::default()).unwrap();
        let (ball, cuboid) = (Ball::new(1.0), Cuboid::new(Vector::splat(0.5)));
        let pos12 = Pose::translation(1.2, 0.3, 0.1);
        let pairs: [([&dyn Shape; 2], PairKind); 4] = [
            ([&ball_mesh, &ball_mesh], PairKind::MeshMesh),
            ([&ball_mesh, &cuboid], PairKind::MeshOther),
            ([&cuboid, &ball_mesh], PairKind::MeshOther),
            ([&ball, &cuboid], PairKind::Other),
        ];
        for ([g1, g2], kind) in pairs {
            probe.reset();
            let answers = [&timed as &dyn PersistentQueryDispatcher, &DefaultQueryDispatcher].map(
                |dispatcher| {
                    let (mut manifolds, mut workspace) = (Manifolds::new(), None);
                    dispatcher
                        .contact_manifolds(&pos12, g1, g2, 0.1, &mut manifolds, &mut workspace)
                        .unwrap();
                    Answer::new(Question::new(&pos12, [g1, g2], 0.1), &manifolds)
                },
            );
            assert_eq!(answers[0], answers[1]);
            assert!(!answers[0].reported.is_empty());
            for other in [PairKind::MeshMesh, PairKind::MeshOther, PairKind::Other] {
                let tally = probe.times()[other];
                assert_eq!(tally.calls, u64::from(other == kind));
                assert_eq!(tally.time.is_zero(), other != kind);
            }
        }
    }

    /// Would catch calls that are not counted because they are not timed, and times that are not made up for them.
    #[test]
    fn one_call_in_some_is_timed_and_stands_for_all() {
        const SLEEP: Duration = Duration::from_millis(2);
        let probe = Probe::default();
        probe.time_every(4);
        let mut slept = 0;
        for call in 0..10 {
            // Calls 0, 4 and 8 are timed.
            probe.measure(PairKind::MeshMesh, || {
                if call % 4 == 0 {
                    std::thread::sleep(SLEEP);
                    slept += 1;
                }
            });
        }
        assert_eq!(slept, 3);
        let tally = probe.times()[PairKind::MeshMesh];
        assert_eq!(tally.calls, 10);
        assert!(tally.time >= 10 * SLEEP && tally.time < 1000 * SLEEP, "{:?}", tally.time);
    }

    /// Would catch a recorder that keeps recording, loses answers or sees other pairs than
    /// meshes.
    #[test]
    fn records_the_mesh_pairs_between_start_and_take() {
        let probe = Probe::default();
        let timed = Timed::new(Arc::new(DefaultQueryDispatcher), probe.clone());
        let mesh = mesh::ball(1.0, 2).trimesh(Default::default()).unwrap();
        let ball = Ball::new(1.0);
        let ask = |g1: &dyn Shape, x: Real| {
            let pos12 = Pose::translation(x, 0.0, 0.0);
            let (mut manifolds, mut workspace) = (Manifolds::new(), None);
            timed
                .contact_manifolds(&pos12, g1, &mesh, 0.1, &mut manifolds, &mut workspace)
                .unwrap();
        };
        ask(&mesh, 1.0);
        assert!(probe.take_answers().is_empty());
        probe.start_recording();
        ask(&mesh, 1.5);
        ask(&ball, 1.5);
        ask(&mesh, 5.0);
        let answers = probe.take_answers();
        let offsets: Vec<Real> = answers.iter().map(|a| a.question.pos12.translation.x).collect();
        assert_eq!(offsets, [1.5, 5.0]);
        assert!(!answers[0].reported.is_empty() && answers[1].reported.is_empty());
        ask(&mesh, 1.0);
        assert!(probe.take_answers().is_empty());
    }
}
