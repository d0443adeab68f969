//! Shared counters of the time spent in contact queries, and a recorder of their answers.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use rapier3d::parry::shape::{Shape, TriMesh};

use super::Answer;

/// Kind of a pair of shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PairKind {
    MeshMesh,
    MeshOther,
    Other,
}

impl PairKind {
    pub fn of(shape1: &dyn Shape, shape2: &dyn Shape) -> Self {
        match [shape1, shape2].map(|shape| shape.as_shape::<TriMesh>().is_some()) {
            [true, true] => Self::MeshMesh,
            [false, false] => Self::Other,
            _ => Self::MeshOther,
        }
    }
}

/// Calls of one kind, and the time they took together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    pub calls: u64,
    /// Summed wall time, one [`clock_cost`] a call included; if only some calls are timed
    /// ([`Probe::time_every`]), as if the others took as long. With Rapier's `parallel` feature
    /// the sum runs over all threads.
    pub time: Duration,
}

/// Handle on the counters of one [`Timed`](super::Timed) dispatcher; clones share them.
#[derive(Clone, Debug, Default)]
pub struct Probe(Arc<Shared>);

#[derive(Debug, Default)]
struct Shared {
    /// Calls of a kind between two that are timed.
    untimed: AtomicU64,
    calls: [AtomicU64; 3],
    nanoseconds: [AtomicU64; 3],
    is_recording: AtomicBool,
    answers: Mutex<Vec<Answer>>,
}

impl Probe {
    /// Calls of a kind and their time since the last [`Self::reset`].
    pub fn tally(&self, kind: PairKind) -> Tally {
        let calls = self.0.calls[kind as usize].load(Relaxed);
        let timed = Duration::from_nanos(self.0.nanoseconds[kind as usize].load(Relaxed));
        let timed_calls = calls.div_ceil(self.stride()).max(1);
        Tally { calls, time: timed.mul_f64(calls as f64 / timed_calls as f64) }
    }

    /// Times one call in `stride` from the next [`Self::reset`] on; at first all are (0 is 1). Reading
    /// the clock takes time.
    pub fn time_every(&self, stride: u64) {
        self.0.untimed.store(stride.saturating_sub(1), Relaxed);
    }

    fn stride(&self) -> u64 {
        self.0.untimed.load(Relaxed) + 1
    }

    /// Sets time and calls to zero.
    pub fn reset(&self) {
        for counter in self.0.calls.iter().chain(&self.0.nanoseconds) {
            counter.store(0, Relaxed);
        }
    }

    /// Keeps the answer of each mesh-mesh call from now on, until [`Self::take_answers`]. Off at
    /// first: recording allocates, so steps that record are not steps to time.
    pub fn start_recording(&self) {
        self.0.is_recording.store(true, Relaxed);
    }

    /// Stops recording; the answers since [`Self::start_recording`], in the order of the calls.
    pub fn take_answers(&self) -> Vec<Answer> {
        self.0.is_recording.store(false, Relaxed);
        std::mem::take(&mut *self.0.answers.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Counts a call, and times it if it is its turn.
    pub(super) fn measure<T>(&self, kind: PairKind, call: impl FnOnce() -> T) -> T {
        let earlier = self.0.calls[kind as usize].fetch_add(1, Relaxed);
        if !earlier.is_multiple_of(self.stride()) {
            return call();
        }
        let start = Instant::now();
        let result = call();
        let time = start.elapsed().as_nanos() as u64;
        self.0.nanoseconds[kind as usize].fetch_add(time, Relaxed);
        result
    }

    pub(super) fn record(&self, answer: impl FnOnce() -> Answer) {
        if self.0.is_recording.load(Relaxed) {
            let answer = answer();
            self.0.answers.lock().unwrap_or_else(PoisonError::into_inner).push(answer);
        }
    }
}

/// Time that the clock adds to each call: the mean of 10,000 empty measurements.
pub fn clock_cost() -> Duration {
    const REPEATS: u32 = 10_000;
    let total: Duration = (0..REPEATS).map(|_| Instant::now().elapsed()).sum();
    total / REPEATS
}
