//! Simultaneous traversal of two trees.
//!
//! * [`PairFrame`] holds the relative pose, and the kernel that compares boxes.
//! * [`descend`] traverses both trees and calls a closure with pairs of leaves.
//! * [`DescentCounts`] count the tests.
//! * [`Slack`] plans when the candidates of the last descent serve again.
//! * [`BoxTest`] compares boxes of other hierarchies, one pair at a time.

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
pub use counters::DescentCounts;
pub use descend::{DescentScratch, begin_descent, descend, descend_from};
pub use expand::NodePair;
pub(crate) use expand::{Compare, Opening, Sides, expand, leaves_at};
pub(crate) use frame::Along;
pub use frame::PairFrame;
pub(crate) use overlap::Overlap;
pub use placement::Placement;
pub(crate) use side::NodeLanes;
pub use slack::{MovingBody, Slack, SlackLimits, SlackPlan};
pub(crate) use toward::Toward;
