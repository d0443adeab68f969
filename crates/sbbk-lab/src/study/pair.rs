//! Stock Parry and SBBK, asked about the same pairs of shapes in turn: of two meshes, for the contacts
//! of each two triangles.
//!
//! Dispatchers are called as the narrow phase calls them, but directly: contact skins, soft-CCD
//! margins and contact recycling are Rapier's, and have no part in it.

use std::time::Duration;

use glamx::Pose3;
use rapier3d::geometry::{ContactManifold, SharedShape};
use rapier3d::math::Real;
use rapier3d::parry::query::ContactManifoldsWorkspace;
use rapier3d::parry::shape::Shape;

use super::turns::{race, timed};
use crate::backend::{Backend, Dispatcher, Primed, SharedDispatcher};
use crate::metrics::Summary;

/// How dispatchers are called, for notes.
pub(super) const DIRECT_NOTE: &str = "dispatchers called directly: contact skins and contact \
                                      recycling, which are Rapier's, have no part in it; all \
                                      contacts of triangles, not those of surfaces alone";

/// Stock and SBBK, the trees built that SBBK builds unasked.
pub(super) struct Contest {
    pub dispatchers: [Dispatcher; 2],
    _primed: [Primed; 2],
}

/// Two shapes, asked for their contacts at one pose after the other, each with what the query
/// before left.
pub(super) struct Sequence<'a> {
    pub shapes: [&'a SharedShape; 2],
    pub poses: Vec<Pose3>,
    pub prediction: Real,
}

/// What a host keeps of a pair of shapes from query to query.
#[derive(Default)]
pub(super) struct Memory {
    pub manifolds: Vec<ContactManifold>,
    workspace: Option<ContactManifoldsWorkspace>,
}

impl Contest {
    /// Whom the dispatchers are of.
    pub const BACKENDS: [Backend; 2] = [Backend::Stock, Backend::Sbbk];

    pub fn new<'a>(shapes: impl IntoIterator<Item = &'a SharedShape> + Clone) -> Self {
        let dispatchers = Self::BACKENDS.map(Backend::per_triangle);
        let primed = dispatchers.each_ref().map(|d| Primed::new(d, shapes.clone()));
        Self { dispatchers, _primed: primed }
    }

    pub fn sbbk(&self) -> &SharedDispatcher {
        &self.dispatchers[1]
    }

    /// Microseconds a query of both.
    pub fn race(&self, repeats: usize, sequences: &[Sequence]) -> Vec<Summary> {
        race(&self.dispatchers, repeats, 1e6 / query_count(sequences), |dispatcher| {
            sweep(dispatcher, sequences)
        })
    }
}

/// Number of queries that [`sweep`] times.
pub(super) fn query_count(sequences: &[Sequence]) -> f64 {
    sequences.iter().map(|sequence| (sequence.poses.len() - 1).max(1)).sum::<usize>() as f64
}

/// Time of all queries but the first of each sequence; of that, if it is the only one, and then
/// with the time to free the manifolds.
pub(super) fn sweep(dispatcher: &SharedDispatcher, sequences: &[Sequence]) -> Duration {
    let time = |sequence: &Sequence| {
        let mut memory = Memory::default();
        let mut ask = |pose: &Pose3| sequence.ask(&mut memory, dispatcher, pose);
        match &sequence.poses[..] {
            [pose] => timed(|| sequence.ask(&mut Memory::default(), dispatcher, pose)).0,
            [first, rest @ ..] => {
                ask(first);
                timed(|| rest.iter().for_each(ask)).0
            }
            [] => Duration::ZERO,
        }
    };
    sequences.iter().map(time).sum()
}

impl Sequence<'_> {
    fn ask(&self, memory: &mut Memory, dispatcher: &SharedDispatcher, pose: &Pose3) {
        memory.ask(dispatcher, self.shapes.map(|shape| &**shape), pose, self.prediction);
    }

    /// Asks everything, and shows the manifolds after each query, by its number.
    pub fn walk(
        &self,
        dispatcher: &SharedDispatcher,
        mut seen: impl FnMut(usize, &[ContactManifold]),
    ) {
        let mut memory = Memory::default();
        for (index, pose) in self.poses.iter().enumerate() {
            self.ask(&mut memory, dispatcher, pose);
            seen(index, &memory.manifolds);
        }
    }
}

impl Memory {
    /// Brings the manifolds up to date.
    pub fn ask(
        &mut self,
        dispatcher: &SharedDispatcher,
        [shape1, shape2]: [&dyn Shape; 2],
        pos12: &Pose3,
        prediction: Real,
    ) {
        let Self { manifolds, workspace } = self;
        dispatcher
            .contact_manifolds(pos12, shape1, shape2, prediction, manifolds, workspace)
            .expect("every backend answers for a mesh and the shapes of these studies");
    }
}
