//! When a front pays.

use crate::tree::Tree;

/// A front is given up when more than this share of its cells is to be tested. A test costs more
/// than one of a fresh descent, as it measures; besides, the front is lowered below some of them.
const WORTHWHILE: f64 = 0.5;
/// Motion from query to query at which a front is first tried, in sizes of a leaf. A wrong guess
/// costs one building of a front.
const FIRST_GUESS: f64 = 0.1;
/// Fresh descents after which twice the motion is tried. A try costs half a descent: one in a
/// hundred with this.
const TRY_AGAIN: u32 = 64;

/// What is known about which motion is slow enough.
#[derive(Clone, Debug, Default)]
pub(super) struct Policy {
    /// Motion up to which a front is tried; `None`: not tried yet.
    slow: Option<f64>,
    /// Queries without a front since the last try.
    waited: u32,
}

impl Policy {
    /// Whether to build a front, after a motion of `step` since the query before.
    pub(super) fn builds(&mut self, step: f64, tree2: &Tree) -> bool {
        let slow = self.slow.get_or_insert_with(|| {
            // The leaves of a surface of 4π·r², each about square.
            let leaf = f64::from(tree2.bounding_ball().radius)
                * (12.0 / f64::from(tree2.leaf_count())).sqrt();
            FIRST_GUESS * leaf
        });
        if step <= *slow {
            self.waited = 0;
            return true;
        }
        self.waited += 1;
        if self.waited == TRY_AGAIN {
            self.waited = 0;
            *slow *= 2.0;
        }
        false
    }

    /// Whether a front of `cells` cells, `due` of them to be tested after a motion of `step`, is
    /// not worth it.
    pub(super) fn gives_up(&mut self, step: f64, due: usize, cells: usize) -> bool {
        let gives_up = due as f64 > WORTHWHILE * cells as f64;
        if gives_up {
            self.slow = self.slow.map(|slow| slow.min(0.5 * step));
        }
        gives_up
    }
}
