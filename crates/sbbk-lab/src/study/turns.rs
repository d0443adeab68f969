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

/// Times the contestants in turn, at least once; in seconds times `scale`.
pub(super) fn race<C>(
    contestants: &[C],
    repeats: usize,
    scale: f64,
    mut sweep: impl FnMut(&C) -> Duration,
) -> Vec<Summary> {
    let times =
        in_turn(contestants, repeats.max(1), |contestant| scale * sweep(contestant).as_secs_f64());
    times.into_iter().filter_map(Summary::of).collect()
}

/// Runs and times some work.
pub(super) fn timed<T>(work: impl FnOnce() -> T) -> (Duration, T) {
    let start = Instant::now();
    let result = work();
    (start.elapsed(), result)
}
