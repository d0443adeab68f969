use std::ops::AddAssign;

/// The work of one or more descents.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct DescentCounts {
    /// Pairs of nodes compared by their boxes.
    pub aabb_tests: u64,
    /// Pairs of leaves handed to the visitor.
    pub leaf_pairs: u64,
    /// Reads of cells of height fields.
    pub cells: u64,
}

impl AddAssign for DescentCounts {
    fn add_assign(&mut self, other: Self) {
        let Self { aabb_tests, leaf_pairs, cells } = other;
        self.aabb_tests += aabb_tests;
        self.leaf_pairs += leaf_pairs;
        self.cells += cells;
    }
}
