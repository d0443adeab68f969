//! Candidates kept from query to query.
//!
//! Bodies move little between steps. So a descent may look farther than the prediction distance, by a slack: what it
//! finds stays complete until a point has moved farther than that (Verlet, *Computer "Experiments" on Classical
//! Fluids*, 1967, does so for particles). Until then no tree and no leaf is touched, and candidates that were too far
//! apart to have come within the prediction distance are not looked at either. Every candidate that could
//! touch gets the exact test, so the contacts are those of a descent.

use parry3d::math::{Pose, Real};
use sbbk_core::traverse::Placement;
use sbbk_core::volumes::Sphere;

/// Slack in steps of the present motion. More: fewer descents, and more candidates that do not touch.
const SLACK_STEPS: f64 = 8.0;
/// Least slack as a share of the prediction distance, for bodies at rest that jitter.
const LEAST_SLACK: f64 = 0.1;
/// The candidates of a descent and when they are still good.
#[derive(Clone, Debug)]
pub(super) struct Coherence<T> {
    /// The query before this one.
    last: Option<Seen>,
    /// The descent that found the candidates, and its margin.
    descent: Option<Seen>,
    candidates: Vec<KnownCandidate<T>>,
}

/// A candidate and how far apart it was at the time of the descent, at least.
#[derive(Copy, Clone, Debug)]
pub(super) struct KnownCandidate<T> {
    pub(super) candidate: T,
    pub(super) distance: f64,
}

#[derive(Copy, Clone, Debug)]
struct Seen {
    pos12: Pose,
    placement: Placement,
    margin: Real,
}

/// What a query has to do.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(super) enum Plan {
    /// Nothing: same pose, same prediction distance.
    Nothing,
    /// Test the known candidates whose triangles were at most this far apart.
    Reuse {
        /// The prediction distance plus the motion since the descent.
        reach: f64,
    },
    /// Descend, with this margin.
    Descend {
        /// The prediction distance plus the slack.
        margin: Real,
    },
}

impl<T> Default for Coherence<T> {
    fn default() -> Self {
        Self { last: None, descent: None, candidates: Vec::new() }
    }
}

impl<T> Coherence<T> {
    /// Forgets everything: a shape changed.
    pub(super) fn clear(&mut self) {
        *self = Self::default();
    }

    /// Decides how to answer for this pose, and remembers it. One of the shapes is in `ball` of its own frame, and that
    /// is at `placement`, as `pos12` says, in the frame of the other. `greatest_slack` is a share of the prediction
    /// distance. A pair that would use it up in fewer than two steps gets none: looking farther would not pay.
    pub(super) fn plan(
        &mut self,
        ball: Sphere,
        (pos12, placement): (&Pose, Placement),
        prediction: Real,
        greatest_slack: f64,
    ) -> Plan {
        let now = Seen { pos12: *pos12, placement, margin: prediction };
        let last = self.last.replace(now);
        if last.is_some_and(|last| last.pos12 == *pos12 && last.margin == prediction) {
            return Plan::Nothing;
        }
        let motion_since =
            |seen: Seen| now.placement.motion_bound(&seen.placement, ball.centre, ball.radius);
        if let Some(descent) = self.descent {
            let reach = f64::from(prediction) + motion_since(descent);
            if reach <= f64::from(descent.margin) {
                return Plan::Reuse { reach };
            }
        }
        let slack = last
            .map_or(0.0, |last| slack(motion_since(last), f64::from(prediction), greatest_slack));
        let margin = prediction + slack as Real;
        self.candidates.clear();
        self.descent = (margin > prediction).then_some(Seen { margin, ..now });
        Plan::Descend { margin }
    }

    /// Keeps a candidate of the descent under way.
    pub(super) fn keep(&mut self, candidate: T, distance: f64) {
        if self.descent.is_some() {
            self.candidates.push(KnownCandidate { candidate, distance });
        }
    }

    /// The candidates of the last descent, in stock order.
    pub(super) fn candidates(&self) -> &[KnownCandidate<T>] {
        &self.candidates
    }

    /// The same, to raise distances that turned out to be larger.
    pub(super) fn candidates_mut(&mut self) -> &mut [KnownCandidate<T>] {
        &mut self.candidates
    }
}

/// How much farther than the prediction distance a descent should look, for a pair that moved by `step` since the
/// query before. Not finite motion gives none.
fn slack(step: f64, prediction: f64, greatest_slack: f64) -> f64 {
    let greatest = greatest_slack * prediction;
    if 2.0 * step <= greatest {
        (SLACK_STEPS * step).clamp(LEAST_SLACK * prediction, greatest)
    } else {
        0.0
    }
}
