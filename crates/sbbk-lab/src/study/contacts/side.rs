//! What is measured of each contestant on the same queries.

use std::fmt;

use serde::Serialize;

use super::contest::CONTESTANTS;
use super::motion::{FAST, SLOW};
use crate::backend::Backend;
use crate::metrics::Summary;

/// Time and error of the same queries.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Measured<E> {
    /// Microseconds a query or nanoseconds a pair of triangles, summed up over the repeats.
    pub time: Summary,
    /// Errors of the answers that were judged.
    pub errors: E,
}

/// One contestant.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Side<E> {
    /// Who answered.
    pub backend: Backend,
    /// With nothing known of the pair; to free the manifolds is part of the time.
    pub fresh: Measured<E>,
    /// In motion by [`SLOW`] prediction distances a step, with what the query before left.
    pub slow: Measured<E>,
    /// In motion by [`FAST`] prediction distances a step, likewise.
    pub fast: Measured<E>,
}

/// How both are asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// For the first time.
    Fresh,
    /// In slow motion.
    Slow,
    /// In faster motion.
    Fast,
}

impl Mode {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Fresh, Self::Slow, Self::Fast];
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fresh => f.pad("fresh"),
            Self::Slow => write!(f, "steady, {SLOW} a step"),
            Self::Fast => write!(f, "steady, {FAST} a step"),
        }
    }
}

impl<E: Copy> Side<E> {
    /// Both sides from what was measured of both in each mode.
    pub(in crate::study) fn both([fresh, slow, fast]: [[Measured<E>; 2]; 3]) -> [Self; 2] {
        [0, 1].map(|i| Self {
            backend: CONTESTANTS[i],
            fresh: fresh[i],
            slow: slow[i],
            fast: fast[i],
        })
    }

    /// What was measured in one mode.
    pub fn measured(&self, mode: Mode) -> Measured<E> {
        match mode {
            Mode::Fresh => self.fresh,
            Mode::Slow => self.slow,
            Mode::Fast => self.fast,
        }
    }
}

impl<E: Copy> Measured<E> {
    /// Of times and errors of both sides.
    pub(in crate::study) fn both(times: [Summary; 2], errors: [E; 2]) -> [Self; 2] {
        [0, 1].map(|i| Self { time: times[i], errors: errors[i] })
    }
}
