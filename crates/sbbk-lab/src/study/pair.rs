//! Stock Parry and SBBK, asked about the same pairs of shapes in turn: of two meshes, for the contacts
//! of each two triangles.
//!
//! Dispatchers are called as the narrow phase calls them, but directly: contact skins, soft-CCD
//! margins and contact recycling are Rapier's, and have no part in it.

use std::time::Duration;

use rapier3d::geometry::SharedShape;

use super::turns::{race, timed};
use crate::backend::{Backend, Dispatcher, Memory, Primed, SharedDispatcher};
use crate::metrics::{ContactErrors, Sequence, Summary, Truth};

/// How dispatchers are called, for notes.
pub(super) const DIRECT_NOTE: &str = "dispatchers called directly: contact skins and contact \
                                      recycling, which are Rapier's, have no part in it; all \
                                      contacts of triangles, not those of surfaces alone";

/// Stock and SBBK, the trees built that SBBK builds unasked.
pub(super) struct Contest {
    pub dispatchers: [Dispatcher; 2],
    _primed: [Primed; 2],
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

    /// Errors of both, where `truth` tells it of a step of a sequence, both by their numbers.
    pub fn errors(
        &self,
        sequences: &[Sequence],
        truth: impl Fn(usize, usize) -> Option<Truth> + Sync,
    ) -> [ContactErrors; 2] {
        let dispatchers = self.dispatchers.each_ref().map(|dispatcher| &dispatcher.shared);
        Sequence::errors(sequences, dispatchers, truth)
    }

    /// Errors of both in some steps of sequences of meshes.
    pub fn mesh_errors(
        &self,
        sequences: &[Sequence],
        is_judged: impl Fn(usize) -> bool + Sync,
    ) -> [ContactErrors; 2] {
        self.errors(sequences, |index, step| is_judged(step).then(|| sequences[index].truth(step)))
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
        if sequence.poses.len() == 1 {
            return timed(|| sequence.ask(&mut Memory::default(), dispatcher, 0)).0;
        }
        sequence.ask(&mut memory, dispatcher, 0);
        let steps = 1..sequence.poses.len();
        timed(|| steps.for_each(|step| sequence.ask(&mut memory, dispatcher, step))).0
    };
    sequences.iter().map(time).sum()
}
