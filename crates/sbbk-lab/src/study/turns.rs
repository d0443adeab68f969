//! Fair repeats.

use std::time::{Duration, Instant};

use crate::metrics::Summary;

/// Calls `measure` for each contestant in turn, `repeats` times over, so that a slow spell of the
/// machine meets all of them; the results by contestant.
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

/// Times of the contestants, taken in turn, at least once; seconds times `scale`.
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

/// What some work takes, and its result.
pub(super) fn timed<T>(work: impl FnOnce() -> T) -> (Duration, T) {
    let start = Instant::now();
    let result = work();
    (start.elapsed(), result)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Would catch repeats in blocks, which a slow spell would turn into a difference.
    #[test]
    fn contestants_alternate() {
        let mut order = Vec::new();
        let results = in_turn(&["a", "b"], 2, |&name| {
            order.push(name);
            order.len()
        });
        assert_eq!(order, ["a", "b", "a", "b"]);
        assert_eq!(results, [[1, 3], [2, 4]]);
    }
}
