//! Ways to find the pairs of a step after those of the step before.

use sbbk_core::front::{Front, FrontOptions, FrontOrder};
use serde::Serialize;

/// What is compared. Each of the middle ones has what the one before it has, and one thing more.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Variant {
    /// A descent from the roots at each query.
    Fresh,
    /// The front of the paper.
    Paper,
    /// A front that is raised as well.
    Raise,
    /// With cached axes, without the motion bound.
    CachedAxis,
    /// With the motion bound, without cached axes.
    MotionBound,
    /// With both.
    All,
    /// The default: with the motion bound, and fresh descents where they are cheaper.
    Adaptive,
    /// No front: descents look farther by a slack, and what they find serves until it is used up.
    Slack,
    /// The same, with an adaptive front for these descents.
    SlackAndFront,
}

impl Variant {
    /// All of them, the fresh descent first.
    pub const ALL: [Self; 9] = [
        Self::Fresh,
        Self::Paper,
        Self::Raise,
        Self::CachedAxis,
        Self::MotionBound,
        Self::All,
        Self::Adaptive,
        Self::Slack,
        Self::SlackAndFront,
    ];

    /// Its front, if it has one.
    pub(super) fn front(self) -> Option<Front> {
        let raise =
            FrontOptions { raise: true, order: FrontOrder::HighestFirst, ..FrontOptions::PAPER };
        let options = match self {
            Self::Fresh | Self::Slack => return None,
            Self::Paper => FrontOptions::PAPER,
            Self::Raise => raise,
            Self::CachedAxis => FrontOptions { cached_axis: true, ..raise },
            Self::MotionBound => FrontOptions { motion_bound: true, ..raise },
            Self::All => FrontOptions { motion_bound: true, cached_axis: true, ..raise },
            Self::Adaptive | Self::SlackAndFront => FrontOptions::ADAPTIVE,
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
            Self::Raise => "(c) + raising",
            Self::CachedAxis => "(d) c + cached axis",
            Self::MotionBound => "(e) c + motion bound",
            Self::All => "(f) c + axis + motion bound",
            Self::Adaptive => "(g) e + adaptive: default",
            Self::Slack => "(h) slack, no front",
            Self::SlackAndFront => "(i) slack + g",
        })
    }
}
