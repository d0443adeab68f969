//! Descents that look farther than asked, so that what they find serves for several queries (Verlet, *Computer
//! "Experiments" on Classical Fluids*, 1967): the scheme of the dispatcher, over bare trees.

use glamx::Pose3;
use sbbk_core::traverse::Placement;
use sbbk_core::tree::Tree;

/// The dispatcher's constants: slack in steps of the present motion, and its least and greatest share of the prediction
/// distance.
const SLACK_STEPS: f64 = 8.0;
const LEAST_SLACK: f64 = 0.1;
const GREATEST_SLACK: f64 = 1.0;
/// Steps that the greatest slack must last.
const LEAST_STEPS: f64 = 6.0;

/// When the last descent is still good.
#[derive(Clone, Debug, Default)]
pub(super) struct Slack {
    last: Option<Placement>,
    descent: Option<(Placement, f64)>,
}

/// What a query has to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Plan {
    /// Take what was at most this far apart at the last descent.
    Reuse { reach: f64 },
    /// Descend with this margin.
    Descend { margin: f32 },
}

impl Slack {
    pub(super) fn plan(&mut self, tree2: &Tree, pos12: &Pose3, prediction: f32) -> Plan {
        let now = Placement::new(pos12);
        let prediction = f64::from(prediction);
        let ball = tree2.bounding_ball();
        let motion_since = |then: &Placement| now.motion_bound(then, ball.centre, ball.radius);
        let last = self.last.replace(now);
        if let Some((then, margin)) = &self.descent {
            let reach = prediction + motion_since(then);
            if reach <= *margin {
                return Plan::Reuse { reach };
            }
        }
        let slack = last.map_or(0.0, |last| slack(motion_since(&last), prediction));
        let margin = (prediction + slack) as f32;
        self.descent = (slack > 0.0).then_some((now, f64::from(margin)));
        Plan::Descend { margin }
    }
}

fn slack(step: f64, prediction: f64) -> f64 {
    let greatest = GREATEST_SLACK * prediction;
    if LEAST_STEPS * step <= greatest {
        (SLACK_STEPS * step).clamp(LEAST_SLACK * prediction, greatest)
    } else {
        0.0
    }
}
