//! Backends on the same pairs of shapes, in turn.
//!
//! Dispatchers are called directly, as the narrow phase calls them, for all contacts of triangles.

use crate::prelude::*;

/// Stock and SBBK, which most studies compare.
pub(super) const SIDES: [Backend; 2] = [Backend::Stock, Backend::Sbbk];

/// Rows of all dispatchers, with microseconds a query and errors.
pub(super) fn rows(
    dispatchers: &[Dispatcher],
    row: &Row,
    repeats: usize,
    sequences: &[Sequence],
    errors: &[Errors],
) -> Vec<Row> {
    let rows = timed_rows(dispatchers, row, repeats, sequences);
    rows.into_iter().zip(errors).map(|(row, errors)| row.with("errors", errors)).collect()
}

/// Rows of all dispatchers, with microseconds a query.
pub(super) fn timed_rows(
    dispatchers: &[Dispatcher],
    row: &Row,
    repeats: usize,
    sequences: &[Sequence],
) -> Vec<Row> {
    let queries = |sequence: &Sequence| (sequence.poses.len() - 1).max(1);
    let count = sequences.iter().map(queries).sum::<usize>() as f64;
    let times = times(dispatchers, repeats, sequences);
    let rows = dispatchers.iter().zip(times).map(|(dispatcher, times)| {
        let times = times.iter().map(|time| 1e6 / count * time.as_secs_f64());
        let row = Row { backend: dispatcher.backend.to_string(), ..row.clone() };
        row.with("time", Summary::of(times))
    });
    rows.collect()
}

/// Times of all queries by dispatcher, without the first query of each motion.
pub(super) fn times(
    dispatchers: &[Dispatcher],
    repeats: usize,
    sequences: &[Sequence],
) -> Vec<Vec<Duration>> {
    in_turn(dispatchers, repeats, |dispatcher| sweep(dispatcher, sequences))
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
