//! Backends on the same pairs of shapes, in turn.
//!
//! Dispatchers are called directly, as the narrow phase calls them, for all contacts of triangles.

use crate::prelude::*;

/// Stock and SBBK, which most studies compare.
pub(super) const SIDES: [Backend; 2] = [Backend::Stock, Backend::Sbbk];

/// Dispatchers of some backends, with the trees of all meshes.
pub(super) struct Contest {
    backends: &'static [Backend],
    dispatchers: Vec<Dispatcher>,
}

impl Contest {
    pub fn new<'a>(
        backends: &'static [Backend],
        shapes: impl IntoIterator<Item = &'a SharedShape> + Clone,
    ) -> Self {
        let dispatchers = backends.iter().map(|backend| backend.per_triangle(shapes.clone()));
        Self { backends, dispatchers: dispatchers.collect() }
    }

    /// The dispatcher of the last backend.
    pub fn last(&self) -> &SharedDispatcher {
        &self.dispatchers[self.backends.len() - 1]
    }

    /// Rows of all backends, with microseconds a query and errors.
    pub fn rows(
        &self,
        row: &Row,
        repeats: usize,
        sequences: &[Sequence],
        errors: &[Errors],
    ) -> Vec<Row> {
        let queries = |sequence: &Sequence| (sequence.poses.len() - 1).max(1);
        let count = sequences.iter().map(queries).sum::<usize>() as f64;
        let times = self.times(repeats, sequences);
        let rows = self.backends.iter().zip(times).zip(errors).map(|((backend, times), errors)| {
            let times = times.iter().map(|time| 1e6 / count * time.as_secs_f64());
            let row = Row { backend: backend.to_string(), ..row.clone() };
            row.with("time", Summary::of(times)).with("errors", errors)
        });
        rows.collect()
    }

    /// Times of all queries, but for the first of each motion, by backend.
    pub fn times(&self, repeats: usize, sequences: &[Sequence]) -> Vec<Vec<Duration>> {
        in_turn(&self.dispatchers, repeats, |dispatcher| sweep(dispatcher, sequences))
    }

    /// Errors in the judged steps of sequences, by backend.
    pub fn errors(
        &self,
        sequences: &[Sequence],
        is_judged: impl Fn(usize) -> bool + Sync,
    ) -> Vec<Errors> {
        Sequence::errors(sequences, &self.dispatchers, is_judged)
    }
}

/// Time of all queries but the first of each sequence. A single query counts, with the time to free
/// its manifolds.
fn sweep(dispatcher: &SharedDispatcher, sequences: &[Sequence]) -> Duration {
    let time = |sequence: &Sequence| {
        let mut memory = Memory::default();
        let mut start = Instant::now();
        sequence.ask(&mut memory, dispatcher, 0);
        if sequence.poses.len() == 1 {
            drop(memory);
            return start.elapsed();
        }
        start = Instant::now();
        (1..sequence.poses.len()).for_each(|step| sequence.ask(&mut memory, dispatcher, step));
        start.elapsed()
    };
    sequences.iter().map(time).sum()
}

/// Calls `measure` for each contestant in turn, `repeats` times over, so that a slow spell of the
/// machine slows all of them. Returns the results by contestant.
pub(super) fn in_turn<C, T>(
    contestants: &[C],
    repeats: usize,
    mut measure: impl FnMut(&C) -> T,
) -> Vec<Vec<T>> {
    let mut results: Vec<Vec<T>> = contestants.iter().map(|_| Vec::new()).collect();
    for _ in 0..repeats {
        for (contestant, results) in contestants.iter().zip(&mut results) {
            results.push(measure(contestant));
        }
    }
    results
}
