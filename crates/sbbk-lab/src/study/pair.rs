//! Stock Parry and SBBK on the same pairs of shapes, in turn.
//!
//! Dispatchers are called directly, as the narrow phase calls them.

use std::time::Duration;

use rapier3d::geometry::SharedShape;

use super::turns::{race, timed};
use crate::backend::{Backend, Dispatcher, Memory, Primed, SharedDispatcher};
use crate::metrics::{ContactErrors, Sequence, Summary, Truth};

/// How dispatchers are called, for notes.
pub(super) const DIRECT_NOTE: &str =
    "dispatchers called directly, without contact recycling; all contacts of triangles";

/// Stock and SBBK, with the trees of all meshes.
pub(super) struct Contest {
    pub dispatchers: [Dispatcher; 2],
    _primed: [Primed; 2],
}

impl Contest {
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
        let queries = |sequence: &Sequence| (sequence.poses.len() - 1).max(1);
        let count = sequences.iter().map(queries).sum::<usize>() as f64;
        race(&self.dispatchers, repeats, 1e6 / count, |dispatcher| sweep(dispatcher, sequences))
    }

    /// Errors of both. `truth` returns the truth of a step of a sequence, or `None` if this step is
    /// not judged.
    pub fn errors(
        &self,
        sequences: &[Sequence],
        truth: impl Fn(usize, usize) -> Option<Truth> + Sync,
    ) -> [ContactErrors; 2] {
        let dispatchers = self.dispatchers.each_ref().map(|dispatcher| &dispatcher.shared);
        Sequence::errors(sequences, dispatchers, truth)
    }
}

/// Time of all queries but the first of each sequence. A single query counts, with the time to free
/// its manifolds.
fn sweep(dispatcher: &SharedDispatcher, sequences: &[Sequence]) -> Duration {
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
