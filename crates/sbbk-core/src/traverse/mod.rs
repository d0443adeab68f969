//! Two trees against each other, and one against a convex shape.
//!
//! [`PairFrame`] holds what depends on the pair's pose, computed once; [`descend`] goes down both trees at
//! once and hands pairs of leaves to a [`Visitor`]; [`Counters`] count the tests, or cost nothing.
//!
//! [`Slack`] says when a descent can be spared, as the last one looked far enough.
//!
//! One tree against a [`Convex`] shape: [`Probe`] is the shape as the tree sees it, [`descend_probe`] finds the leaves near it.

mod correspondence;
mod counters;
mod descend;
mod expand;
mod frame;
mod gaps;
#[cfg(test)]
mod noise;
mod ordered_overlap;
mod overlap;
mod placement;
mod probe;
mod probe_descend;
mod signed_gaps;
mod slack;
mod toward;
mod visitor;

pub use counters::{Counters, DescentCounts};
pub use descend::{Descent, DescentScratch, descend};
pub(crate) use expand::{Compare, Sides, expand};
pub use frame::PairFrame;
pub(crate) use gaps::GapFrame;
pub(crate) use ordered_overlap::OrderedOverlap;
pub(crate) use overlap::{Inner, Outer, Same, Spread};
pub use placement::Placement;
pub use probe::{Convex, Outline, Probe};
pub use probe_descend::{ProbeScratch, descend_probe};
pub(crate) use signed_gaps::{Cutoff, GapCounts, SignedGaps};
pub use slack::{GREATEST_SLACK, Slack, SlackPlan};
pub(crate) use toward::Toward;
pub use visitor::{LeafPairs, NodePair, Verdict, Visitor};
