//! Chunks of a heavy pair on the threads of the host's pool.
//!
//! Rapier hands out pairs in blocks of 64, so few heavy pairs would run on one thread. With the feature `parallel`, a
//! heavy pair is split. Results are joined in the order of chunks, so they have the same bits on any number of threads.

/// The result of a chunk.
pub(super) trait ChunkResult: Default + Send {
    /// Adds the result of the next chunk.
    fn append(&mut self, next: Self);
}

/// Returns true if work may run on other threads.
pub(super) fn has_threads() -> bool {
    #[cfg(feature = "parallel")]
    return rayon::current_num_threads() > 1;
    #[cfg(not(feature = "parallel"))]
    false
}

/// Calls both, maybe on two threads.
fn join(first: impl FnOnce() + Send, second: impl FnOnce() + Send) {
    #[cfg(feature = "parallel")]
    rayon::join(first, second);
    #[cfg(not(feature = "parallel"))]
    {
        first();
        second();
    }
}

/// Calls `work` with all items: at once, or in chunks of at least `least` items on several threads.
pub(super) fn in_chunks<T: Send, R: ChunkResult>(
    items: &mut [T],
    least: usize,
    result: &mut R,
    work: &(impl Fn(&mut [T], &mut R) + Sync),
) {
    if items.len() < 2 * least || !has_threads() {
        return work(items, result);
    }
    let (first, second) = items.split_at_mut(items.len() / 2);
    let mut next = R::default();
    join(|| in_chunks(first, least, result, work), || in_chunks(second, least, &mut next, work));
    result.append(next);
}
