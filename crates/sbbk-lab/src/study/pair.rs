//! Stock Parry and SBBK on the same pairs of shapes, in turn.
//!
//! Dispatchers are called directly, as the narrow phase calls them, for all contacts of triangles.

use super::turns::{in_turn, timed};
use crate::prelude::*;

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

    /// Rows of both, with microseconds a query and errors.
    pub fn rows(
        &self,
        row: &Row,
        repeats: usize,
        sequences: &[Sequence],
        errors: [ContactErrors; 2],
    ) -> Vec<Row> {
        let rows = Self::BACKENDS.into_iter().zip(self.times(repeats, sequences)).zip(errors);
        let rows = rows.map(|((backend, time), errors)| {
            let row = Row { backend: backend.to_string(), ..row.clone() };
            row.with("time", time).with("errors", errors)
        });
        rows.collect()
    }

    /// Microseconds a query.
    fn times(&self, repeats: usize, sequences: &[Sequence]) -> Vec<Option<Summary>> {
        let queries = |sequence: &Sequence| (sequence.poses.len() - 1).max(1);
        let count = sequences.iter().map(queries).sum::<usize>() as f64;
        let times = in_turn(&self.dispatchers, repeats.max(1), |dispatcher| {
            1e6 / count * sweep(dispatcher, sequences).as_secs_f64()
        });
        times.into_iter().map(Summary::of).collect()
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

/// Rows of stock and of SBBK, in the same order.
pub(super) struct Sides<'a>(pub [Vec<&'a Row>; 2]);

impl<'a> Sides<'a> {
    pub fn of(rows: &'a [Row], counts: impl Fn(&Row) -> bool) -> Self {
        Self(Contest::BACKENDS.map(|backend| {
            rows.iter().filter(|row| row.is("backend", backend) && counts(row)).collect()
        }))
    }

    /// Numbers of stock over those of SBBK at a path.
    pub fn ratios(&self, path: &str) -> impl Iterator<Item = f64> {
        let [stock, sbbk] = &self.0;
        stock.iter().zip(sbbk).map(move |(a, b)| a.number(path) / b.number(path))
    }

    /// The geometric mean of the ratios.
    pub fn ratio(&self, path: &str) -> f64 {
        geometric_mean(self.ratios(path)).unwrap_or(f64::NAN)
    }

    /// Wrong contacts of both.
    pub fn wrong(&self, path: &str) -> [u64; 2] {
        self.0.each_ref().map(|rows| rows.iter().map(|row| row.wrong(path)).sum())
    }

    pub fn sbbk(&self) -> &[&'a Row] {
        &self.0[1]
    }
}
