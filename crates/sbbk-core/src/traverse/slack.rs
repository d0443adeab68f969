//! Descents with a larger margin, so that their candidates serve for several queries.
//!
//! Bodies move little from query to query. A descent whose margin exceeds the reach
//! `p` by a *slack* `s` finds all pairs that are at most `p + s` apart. While no point of tree 2
//! has moved by more than `s`, all other pairs are still farther than `p` apart. The candidates are
//! complete, and neither tree need be read (Verlet, *Computer "Experiments" on Classical Fluids*,
//! 1967, does this for particles). [`Placement::motion_bound`] of a ball around the points bounds
//! their motion.
//!
//! More slack lasts longer and finds more pairs that do not touch. So the present motion determines
//! it, and fast motion gets none.

use super::Placement;
use crate::volumes::Sphere;

/// Least slack in units of [`SlackLimits`], for bodies at rest that jitter. Higher: more
/// candidates; lower: more descents.
const LEAST_SLACK: f64 = 0.1;
/// Share of the moving body's radius that a unit of [`SlackLimits`] is at most. Higher: all of a
/// small body becomes a candidate; lower: more descents.
const SMALL: f64 = 0.1;
/// Least number of queries for which the greatest slack must last; else there is none. Higher: more
/// descents; lower: wide descents for a single query.
const LEAST_STEPS: f64 = 3.0;

/// Limits of the slack. Their unit is the reach, or less for small bodies.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SlackLimits {
    /// Slack in steps of the present motion. Higher: fewer descents, and more candidates that do
    /// not touch; lower: more descents.
    pub steps: f64,
    /// Greatest slack in units. Higher: exact tests of candidates that
    /// do not touch; lower: more descents.
    pub greatest: f64,
}

impl SlackLimits {
    /// Limits for candidates that are pairs of triangles.
    pub const TRIANGLES: Self = Self { steps: 8.0, greatest: 1.0 };
}

/// The body of a pair whose motion limits how long candidates serve.
#[derive(Copy, Clone, Debug)]
pub struct MovingBody {
    /// A ball around the body, in the body's frame.
    pub ball: Sphere,
    /// True if the body is this ball, whose spin moves no surface.
    pub is_ball: bool,
}

impl MovingBody {
    /// An upper bound of the motion of the body's surface from an earlier placement.
    pub fn motion(&self, now: &Placement, earlier: &Placement) -> f64 {
        let radius = if self.is_ball { 0.0 } else { self.ball.radius };
        now.motion_bound(earlier, self.ball.centre, radius)
    }
}

/// Plans the queries of one pair: when to descend, and with which margin.
///
/// The caller keeps the candidates. When a shape changes, it drops these and starts with a new
/// `Slack`.
#[derive(Clone, Debug, Default)]
pub struct Slack {
    /// Placement of the last query.
    last: Option<Placement>,
    /// The last descent and its margin, if it had slack.
    descent: Option<(Placement, f32)>,
    travel: f64,
}

/// The next action of a query.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum SlackPlan {
    /// Test the candidates of the last descent.
    Reuse {
        /// The margin of that descent.
        margin: f32,
    },
    /// Descend, and keep the candidates instead of those found before.
    Descend {
        /// The reach plus the slack.
        margin: f32,
    },
}

impl Slack {
    /// Plans a query and stores its placement, in constant time. The frame of the moving body is at
    /// `placement`.
    ///
    /// If the placement or the reach is not finite, plans a descent without slack.
    pub fn plan(
        &mut self,
        body: MovingBody,
        placement: &Placement,
        reach: f32,
        limits: SlackLimits,
    ) -> SlackPlan {
        let motion_since = |then: &Placement| body.motion(placement, then);
        let step = self.last.as_ref().map(motion_since);
        self.last = Some(*placement);
        self.travel += step.unwrap_or(0.0);
        if let Some((then, margin)) = self.descent
            && f64::from(reach) + motion_since(&then) <= f64::from(margin)
        {
            return SlackPlan::Reuse { margin };
        }
        // The first query gets no slack: its motion is unknown.
        let unit = f64::from(reach).min(SMALL * f64::from(body.ball.radius));
        let slack = step.map_or(0.0, |step| slack(step, unit, limits));
        let wide = reach + slack as f32;
        let margin = if wide.is_finite() { wide } else { reach };
        self.descent = (margin > reach).then_some((*placement, margin));
        self.travel = 0.0;
        SlackPlan::Descend { margin }
    }

    /// Returns true before the first query.
    pub fn is_new(&self) -> bool {
        self.last.is_none()
    }

    /// Notes that nothing was within `margin` at the last query. The next queries then plan no
    /// descent.
    pub fn note_clear(&mut self, margin: f32) {
        self.descent = self.last.map(|placement| (placement, margin));
    }

    /// Returns how much farther the body may move before the candidates no longer serve; 0 without
    /// any.
    pub fn rest(&self, body: MovingBody, placement: &Placement, reach: f32) -> f64 {
        self.descent.map_or(0.0, |(then, margin)| {
            f64::from(margin) - f64::from(reach) - body.motion(placement, &then)
        })
    }

    /// Takes note of the placement of a query that needs no plan.
    pub fn note_placement(&mut self, placement: &Placement) {
        self.last = Some(*placement);
    }

    /// Length of the path of points since the last descent, an upper bound: distances have shrunk
    /// by at most this much between any two queries since.
    pub fn travel(&self) -> f64 {
        self.travel
    }
}

/// The slack of a descent for a pair that moved by `step` since the last query. Zero for motion
/// that is not finite.
fn slack(step: f64, unit: f64, limits: SlackLimits) -> f64 {
    let greatest = limits.greatest * unit;
    if LEAST_STEPS * step <= greatest {
        (limits.steps * step).max(LEAST_SLACK * unit).min(greatest)
    } else {
        0.0
    }
}
