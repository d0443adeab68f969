//! Stock Parry and SBBK, answering the same questions in turn.

use std::convert::Infallible;
use std::time::Duration;

use glamx::Pose3;
use rapier3d::geometry::{ContactManifold, SharedShape};
use rapier3d::math::Real;
use rapier3d::parry::query::ContactManifoldsWorkspace;
use rapier3d::parry::shape::Shape;

use super::super::turns::in_turn;
use crate::backend::{Backend, Primed, SharedDispatcher};
use crate::metrics::Summary;

/// Who is compared. Whatever comes in twos is in this order.
pub const CONTESTANTS: [Backend; 2] = [Backend::Stock, Backend::Sbbk];

/// Both dispatchers, the trees of all meshes built.
pub(in crate::study) struct Contest {
    pub dispatchers: [SharedDispatcher; 2],
    _primed: [Primed; 2],
}

impl Contest {
    pub fn new<'a>(shapes: impl Iterator<Item = &'a SharedShape> + Clone) -> Self {
        let dispatchers = CONTESTANTS.map(Backend::dispatcher);
        let primed = dispatchers.each_ref().map(|d| Primed::new(d, shapes.clone()));
        Self { dispatchers, _primed: primed }
    }

    /// The dispatcher whose contacts place the meshes.
    pub fn sbbk(&self) -> &SharedDispatcher {
        &self.dispatchers[1]
    }

    /// Microseconds of each of the `count` queries that `sweep` makes and times. Both dispatchers
    /// sweep in turn, `repeats` times.
    pub fn race(
        &self,
        repeats: usize,
        count: usize,
        sweep: impl Fn(&SharedDispatcher) -> Duration,
    ) -> [Summary; 2] {
        race(&self.dispatchers, repeats, 1e6 / count as f64, sweep)
    }
}

/// Times of the sweeps of both contestants, taken in turn, `repeats` times (at least once);
/// seconds times `scale`.
pub(super) fn race<C>(
    contestants: &[C; 2],
    repeats: usize,
    scale: f64,
    sweep: impl Fn(&C) -> Duration,
) -> [Summary; 2] {
    let Ok(times) = in_turn(contestants, repeats.max(1), |contestant, _| {
        Ok::<_, Infallible>(scale * sweep(contestant).as_secs_f64())
    });
    let mut times = times.into_iter().flat_map(Summary::of);
    [(); 2].map(|()| times.next().expect("both contestants had at least one turn"))
}

/// What a host keeps of a pair of shapes from query to query.
#[derive(Default)]
pub(in crate::study) struct Memory {
    pub manifolds: Vec<ContactManifold>,
    workspace: Option<ContactManifoldsWorkspace>,
}

impl Memory {
    /// Brings the manifolds of two equal meshes up to date.
    pub fn ask(
        &mut self,
        dispatcher: &SharedDispatcher,
        shape: &SharedShape,
        pos12: &Pose3,
        prediction: Real,
    ) {
        self.ask_pair(dispatcher, [&**shape; 2], pos12, prediction);
    }

    /// Brings the manifolds of two shapes up to date.
    pub fn ask_pair(
        &mut self,
        dispatcher: &SharedDispatcher,
        [shape1, shape2]: [&dyn Shape; 2],
        pos12: &Pose3,
        prediction: Real,
    ) {
        let Self { manifolds, workspace } = self;
        dispatcher
            .contact_manifolds(pos12, shape1, shape2, prediction, manifolds, workspace)
            .expect("every backend answers for a mesh and any shape of these studies");
    }
}
