//! Descents that look farther than asked, so that what they find serves for several queries.
//!
//! Bodies move little from query to query. A descent that looks farther than the prediction
//! distance `p`, by a *slack* `s`, finds all pairs that are at most `p + s` apart. While no point
//! of tree 2 has moved by more than `s` since, a pair that it did not find is farther than `p`
//! apart still: what it found is complete, and neither tree need be touched (Verlet, *Computer
//! "Experiments" on Classical Fluids*, 1967, does so for particles). How far points have moved is
//! bounded by [`Placement::motion_bound`] of a ball that holds them.
//!
//! More slack lasts longer and finds more pairs that do not touch. So it is chosen by the present
//! motion, and none is given where it would be used up at once.

use super::Placement;
use crate::volumes::Sphere;

/// Least slack as a share of the prediction distance, for bodies at rest that jitter. More: as
/// above; less: jitter that grows uses it up.
const LEAST_SLACK: f64 = 0.1;
/// A pair that would use up the greatest slack in fewer steps gets none: to look farther would not
/// pay (with 2, queries that move by half a prediction distance took up to twice as long; with 6,
/// those of a ball that rolls over a terrain 1.2 times).
const LEAST_STEPS: f64 = 3.0;

/// How much farther than asked descents may look.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SlackLimits {
    /// Slack in steps of the present motion. More: fewer descents, and more candidates that do not
    /// touch.
    pub steps: f64,
    /// Greatest slack as a share of the prediction distance. More: candidates that do not touch get
    /// an exact test; less: more descents.
    pub greatest: f64,
}

impl SlackLimits {
    /// Where what is found are pairs of triangles, that get an exact test.
    pub const TRIANGLES: Self = Self { steps: 8.0, greatest: 1.0 };
}

/// Plans the queries of one pair: when to descend, and how far to look.
///
/// What descents find is the caller's to keep, and to drop where a shape changes (then this is to
/// be replaced by the default, too).
#[derive(Clone, Debug, Default)]
pub struct Slack {
    /// The query before.
    last: Option<Placement>,
    /// The last descent and its margin, if it had slack.
    descent: Option<(Placement, f32)>,
    travel: f64,
}

/// What a query has to do.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum SlackPlan {
    /// Test what the last descent found.
    Reuse {
        /// That of the descent.
        margin: f32,
        /// What was farther apart than this at the descent is farther apart than the prediction
        /// distance now.
        reach: f64,
    },
    /// Descend, forget what was found before, and keep what is found now if [`Slack::margin`] is
    /// there.
    Descend {
        /// The prediction distance plus the slack.
        margin: f32,
        /// [`Slack::travel`] since the descent before.
        travel: f64,
    },
}

impl Slack {
    /// Plans a query, and remembers it. What moves is in `ball` of its own frame, and that is at
    /// `placement`. Constant time.
    ///
    /// If the placement or the prediction distance is not finite, it is a descent without slack.
    pub fn plan(
        &mut self,
        ball: Sphere,
        placement: &Placement,
        prediction: f32,
        limits: SlackLimits,
    ) -> SlackPlan {
        let motion_since =
            |then: &Placement| placement.motion_bound(then, ball.centre, ball.radius);
        let step = self.last.replace(*placement).map(|last| motion_since(&last));
        self.travel += step.unwrap_or(0.0);
        if let Some((then, margin)) = self.descent {
            let reach = f64::from(prediction) + motion_since(&then);
            if reach <= f64::from(margin) {
                return SlackPlan::Reuse { margin, reach };
            }
        }
        // Of the first query nothing is known, not even whether there will be another one.
        let slack = step.map_or(0.0, |step| slack(step, f64::from(prediction), limits));
        let wide = prediction + slack as f32;
        let margin = if wide.is_finite() { wide } else { prediction };
        self.descent = (margin > prediction).then_some((*placement, margin));
        SlackPlan::Descend { margin, travel: std::mem::take(&mut self.travel) }
    }

    /// The margin of the last descent, if what it found is to be kept.
    pub fn margin(&self) -> Option<f32> {
        self.descent.map(|(_, margin)| margin)
    }

    /// How far points have moved since the last descent, along their path: at most so much has a
    /// distance shrunk between any two queries since.
    pub fn travel(&self) -> f64 {
        self.travel
    }
}

/// How much farther than the prediction distance a descent should look, for a pair that moved by
/// `step` since the query before. Not finite motion gives none.
fn slack(step: f64, prediction: f64, limits: SlackLimits) -> f64 {
    let greatest = limits.greatest * prediction;
    if LEAST_STEPS * step <= greatest {
        (limits.steps * step).max(LEAST_SLACK * prediction).min(greatest)
    } else {
        0.0
    }
}
