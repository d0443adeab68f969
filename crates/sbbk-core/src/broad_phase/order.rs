//! The order in which objects are packed into the tree: halves of halves along the axis on which
//! the centres spread most.
//!
//! Every cut falls between whole subtrees of the tree of eight, so that all nodes but the last on
//! each level are full.

use super::bounds::{Aabb, Reach};
use super::lanes::LANE_COUNT;

#[derive(Clone, Copy, Debug)]
struct Entry {
    centre: [f32; 3],
    index: u32,
}

/// Sorts object indices for packing. Keeps its memory from call to call.
#[derive(Clone, Debug, Default)]
pub(super) struct Order {
    entries: Vec<Entry>,
}

impl Order {
    /// The given indices into `reaches` in packing order; takes time `n log n`.
    pub(super) fn sorted(
        &mut self,
        indices: impl Iterator<Item = u32>,
        reaches: &[Reach],
    ) -> impl ExactSizeIterator<Item = u32> {
        self.entries.clear();
        self.entries.extend(
            indices.map(|index| Entry { centre: centre(&reaches[index as usize].aabb), index }),
        );
        sort(&mut self.entries);
        self.entries.iter().map(|entry| entry.index)
    }
}

fn centre(aabb: &Aabb) -> [f32; 3] {
    [0, 1, 2].map(|axis| 0.5 * aabb.min[axis] + 0.5 * aabb.max[axis])
}

fn sort(entries: &mut [Entry]) {
    let group_count = entries.len().div_ceil(LANE_COUNT);
    if group_count <= 1 {
        return;
    }
    let Some(axis) = widest_axis(entries) else {
        return;
    };
    let middle = LANE_COUNT * first_half(group_count);
    entries.select_nth_unstable_by(middle, |a, b| a.centre[axis].total_cmp(&b.centre[axis]));
    let (below, above) = entries.split_at_mut(middle);
    sort(below);
    sort(above);
}

/// `None` if no axis parts the centres. The margin may have pushed some to infinity; an axis on
/// which all are there has a spread of NaN and counts as equal.
fn widest_axis(entries: &[Entry]) -> Option<usize> {
    let mut lower = [f32::INFINITY; 3];
    let mut upper = [f32::NEG_INFINITY; 3];
    for entry in entries {
        for axis in 0..3 {
            lower[axis] = lower[axis].min(entry.centre[axis]);
            upper[axis] = upper[axis].max(entry.centre[axis]);
        }
    }
    let spread = [0, 1, 2].map(|axis| upper[axis] - lower[axis]);
    (0..3).filter(|&axis| spread[axis] > 0.0).max_by(|&a, &b| spread[a].total_cmp(&spread[b]))
}

/// How many of at least two groups go below the cut: half of the largest full subtrees that are
/// smaller than the whole.
fn first_half(group_count: usize) -> usize {
    let mut subtree = 1;
    while subtree * LANE_COUNT < group_count {
        subtree *= LANE_COUNT;
    }
    group_count.div_ceil(subtree) / 2 * subtree
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a cut through a subtree, which would give two nodes of one parent distant objects,
    /// and a cut that leaves one side empty, on which the recursion would not end.
    #[test]
    fn cuts_fall_between_whole_subtrees() {
        let cuts = [2, 3, 8, 9, 64, 65, 250, 512, 2500].map(first_half);
        assert_eq!(cuts, [1, 1, 4, 8, 32, 64, 128, 256, 1024]);
    }
}
