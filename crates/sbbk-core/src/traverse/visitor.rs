use crate::tree::{LeafBatch, Slot};

/// How a descent goes on.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// To the children of this pair.
    Descend,
    /// Not below this pair.
    Prune,
    /// Nowhere: the whole descent ends.
    Stop,
}

/// A pair of nodes whose volumes meet.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct NodePair {
    /// The node of tree 1.
    pub slot1: Slot,
    /// The node of tree 2.
    pub slot2: Slot,
    /// Steps from the pair of roots.
    pub depth: u32,
}

/// What a descent is for.
pub trait Visitor {
    /// A pair of nodes, not both leaves, whose volumes come within the margin.
    fn nodes(&mut self, _pair: NodePair) -> Verdict {
        Verdict::Descend
    }

    /// A pair of leaves whose volumes come within the margin; `leaf1` and `leaf2` are their
    /// numbers. Only [`Verdict::Stop`] makes a difference.
    fn leaves(&mut self, leaf1: u32, batch1: &LeafBatch, leaf2: u32, batch2: &LeafBatch)
    -> Verdict;
}

/// Collects the pairs of leaf numbers.
#[derive(Clone, Debug, Default)]
pub struct LeafPairs(
    /// Pairs of leaf numbers, in the order of the descent.
    pub Vec<(u32, u32)>,
);

impl Visitor for LeafPairs {
    fn leaves(&mut self, leaf1: u32, _: &LeafBatch, leaf2: u32, _: &LeafBatch) -> Verdict {
        self.0.push((leaf1, leaf2));
        Verdict::Descend
    }
}
