//! Ways to find the pairs of a step after those of the step before.

use sbbk_core::front::{Front, FrontOptions};
use serde::Serialize;

/// What is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Variant {
    /// A descent from the roots at each query.
    Fresh,
    /// The front of the paper.
    Paper,
    /// The default front: raised, with the motion bound, and fresh descents where they are cheaper.
    Adaptive,
    /// No front: descents look farther by a slack, and what they find serves until it is used up.
    Slack,
    /// The same, with an adaptive front for these descents.
    SlackAndFront,
}

impl Variant {
    /// All of them, the fresh descent first.
    pub const ALL: [Self; 5] =
        [Self::Fresh, Self::Paper, Self::Adaptive, Self::Slack, Self::SlackAndFront];

    /// Its front, if it has one.
    pub(super) fn front(self) -> Option<Front> {
        let options = match self {
            Self::Fresh | Self::Slack => return None,
            Self::Paper => FrontOptions::Paper,
            Self::Adaptive | Self::SlackAndFront => FrontOptions::Adaptive,
        };
        Some(Front::new(options))
    }

    /// Whether descents look farther than asked.
    pub(super) fn has_slack(self) -> bool {
        matches!(self, Self::Slack | Self::SlackAndFront)
    }
}

impl std::fmt::Display for Variant {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Self::Fresh => "(a) fresh descent",
            Self::Paper => "(b) front of the paper",
            Self::Adaptive => "(c) adaptive front",
            Self::Slack => "(d) slack, no front",
            Self::SlackAndFront => "(e) slack + c",
        })
    }
}
