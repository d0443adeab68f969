//! Candidates kept from query to query.
//!
//! Bodies move little between steps. So a descent may look farther than the prediction distance, by a slack: what it
//! finds stays complete until a point has moved farther than that (Verlet, *Computer "Experiments" on Classical
//! Fluids*, 1967, does so for particles). Until then no tree and no leaf is touched, and candidates that were too far
//! apart to have come within the prediction distance are not looked at either. Every candidate that could
//! touch gets the exact test, so the contacts are those of a descent.

use parry3d::math::{Pose, Real};
use sbbk_core::contact::TriangleContact;
use sbbk_core::traverse::Placement;
use sbbk_core::tree::Tree;

use super::candidates::Candidate;

/// Slack in steps of the present motion. More: fewer descents, and more candidates that do not touch.
const SLACK_STEPS: f64 = 8.0;
/// Least slack as a share of the prediction distance, for bodies at rest that jitter.
const LEAST_SLACK: f64 = 0.1;
/// Greatest slack, likewise. A pair that would use it up in fewer than two steps gets none: looking farther
/// would not pay.
const GREATEST_SLACK: f64 = 1.0;

/// The candidates of a descent and when they are still good.
#[derive(Clone, Debug, Default)]
pub(super) struct Coherence {
    /// The query before this one.
    last: Option<Seen>,
    /// The descent that found the candidates, and its margin.
    descent: Option<Seen>,
    candidates: Vec<KnownCandidate>,
}

/// A candidate and how far apart its triangles were at the time of the descent.
#[derive(Copy, Clone, Debug)]
pub(super) struct KnownCandidate {
    pub(super) candidate: Candidate,
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

impl Coherence {
    /// Forgets everything: the meshes changed.
    pub(super) fn clear(&mut self) {
        *self = Self::default();
    }

    /// Decides how to answer for this pose, and remembers it.
    pub(super) fn plan(&mut self, tree2: &Tree, pos12: &Pose, prediction: Real) -> Plan {
        let now = Seen { pos12: *pos12, placement: Placement::new(pos12), margin: prediction };
        let last = self.last.replace(now);
        if last.is_some_and(|last| last.pos12 == *pos12 && last.margin == prediction) {
            return Plan::Nothing;
        }
        let motion_since = |seen: Seen| {
            let ball = tree2.bounding_ball();
            now.placement.motion_bound(&seen.placement, ball.centre, ball.radius)
        };
        if let Some(descent) = self.descent {
            let reach = f64::from(prediction) + motion_since(descent);
            if reach <= f64::from(descent.margin) {
                return Plan::Reuse { reach };
            }
        }
        let slack = last.map_or(0.0, |last| slack(motion_since(last), f64::from(prediction)));
        let margin = prediction + slack as Real;
        self.candidates.clear();
        self.descent = (margin > prediction).then_some(Seen { margin, ..now });
        Plan::Descend { margin }
    }

    /// Keeps a candidate of the descent under way.
    pub(super) fn keep(&mut self, candidate: &Candidate, contact: &TriangleContact) {
        if self.descent.is_some() {
            let candidate = Candidate { features: Some(contact.features), ..*candidate };
            self.candidates.push(KnownCandidate { candidate, distance: contact.distance });
        }
    }

    /// The candidates of the last descent, in stock order.
    pub(super) fn candidates(&self) -> &[KnownCandidate] {
        &self.candidates
    }
}

/// How much farther than the prediction distance a descent should look, for a pair that moved by `step` since the
/// query before. Not finite motion gives none.
fn slack(step: f64, prediction: f64) -> f64 {
    let greatest = GREATEST_SLACK * prediction;
    if 2.0 * step <= greatest {
        (SLACK_STEPS * step).clamp(LEAST_SLACK * prediction, greatest)
    } else {
        0.0
    }
}
