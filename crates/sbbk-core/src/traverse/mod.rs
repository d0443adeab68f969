//! Two trees against each other.
//!
//! [`PairFrame`] holds what depends on the pair's pose, computed once, and the kernel that compares
//! boxes; [`descend`] goes down both trees at once and hands pairs of leaves to a [`Visitor`];
//! [`Counters`] count the tests, or cost nothing.
//!
//! [`Slack`] says when a descent can be spared, as the last one looked far enough.
//!
//! [`BoxTest`] compares boxes of other hierarchies, or of a hierarchy and a single body, one pair at
//! a time.

#[cfg(test)]
mod allowances;
mod boxes;
mod correspondence;
mod counters;
mod descend;
mod expand;
mod frame;
mod gaps;
mod overlap;
mod placement;
mod side;
mod slack;
mod toward;

pub use boxes::{BoxTest, NearBox, TestedBox};
pub use counters::{Counters, DescentCounts};
pub use descend::{DescentScratch, descend};
pub(crate) use expand::{Compare, Sides, expand};
pub(crate) use frame::Along;
pub use frame::PairFrame;
pub(crate) use gaps::{Cutoff, GapCounts, SignedGaps};
pub(crate) use overlap::{OrderedOverlap, Overlap};
pub use placement::Placement;
pub(crate) use side::Side;
pub use slack::{Slack, SlackLimits, SlackPlan};
pub(crate) use toward::Toward;
