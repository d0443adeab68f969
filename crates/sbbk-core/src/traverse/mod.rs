//! Two trees against each other.
//!
//! [`PairFrame`] holds what depends on the pair's pose, computed once; [`descend`] goes down both trees at
//! once and hands pairs of leaves to a [`Visitor`]; [`Counters`] count the tests, or cost nothing.

mod correspondence;
mod counters;
mod descend;
mod expand;
mod frame;
mod gap;
mod overlap;
mod placement;
mod visitor;

pub use counters::{Counters, DescentCounts};
pub use descend::{Descent, DescentScratch, descend};
pub(crate) use expand::{Compare, Sides, expand};
pub use frame::PairFrame;
pub use gap::GapCounts;
pub(crate) use gap::Gaps;
pub(crate) use overlap::Spread;
pub use placement::Placement;
pub use visitor::{LeafPairs, NodePair, Verdict, Visitor};
