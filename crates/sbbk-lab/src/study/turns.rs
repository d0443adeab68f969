//! Fair repeats.

use crate::prelude::*;

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

/// Runs and times some work.
pub(super) fn timed<T>(work: impl FnOnce() -> T) -> (Duration, T) {
    let start = Instant::now();
    let result = work();
    (start.elapsed(), result)
}
