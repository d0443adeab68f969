//! The structure that finds the pairs: an implicit tree of eight children a node, over the
//! objects in the order of [`order`](super::order).
//!
//! Level 0 holds the boxes of the objects, eight to a group; lane `l` of group `g` on level
//! `k + 1` is the box around group `8 g + l` of level `k`, up to one group at the top. There are
//! no child indices, and a refit is a sweep over arrays.
//!
//! Pairs come from a simultaneous descent of the tree with itself. Both nodes are always on one
//! level: one lane of the first group is tested against all eight of the second at once. A pair
//! of nodes is pruned when their boxes do not overlap, or when nothing in either has changed
//! since the last step, since then all their pairs are known.
//!
//! The order decides only the speed: a stale order gives larger boxes, not other pairs. So
//! objects move by refit, come by being appended, go by leaving their lane empty, and are packed
//! afresh when too many boxes have grown too much.

use super::bounds::{Aabb, Reach};
use super::lanes::{BoxLanes, LANE_COUNT, LaneMask, Lanes, SphereLanes, lanes_of};
use super::order::Order;

/// A group of objects is worn when the sum of its sides exceeds this multiple of its least value
/// since the objects were packed. Lower packs more often; higher descends through larger boxes.
/// The optimum is flat: between 1.1 and 1.3 the work of a stirred world differs by 3 %.
const WORN_GROWTH: f32 = 1.2;

/// The objects are packed afresh when one lane in so many is in a worn group, empty, or appended.
/// Lower descends through more bad boxes; higher packs more often.
const WORN_SHARE: usize = 4;

/// Rank of an object that is not in the tree, and above all others.
const NO_RANK: u32 = u32::MAX;

/// One level: groups of eight boxes, and which of them hold an object that changed.
#[derive(Clone, Debug, Default)]
struct Level {
    boxes: Vec<BoxLanes>,
    changed: Vec<LaneMask>,
}

impl Level {
    fn clear(&mut self) {
        self.boxes.clear();
        self.changed.clear();
    }

    fn grow_to(&mut self, group_count: usize) {
        self.boxes.resize(group_count, BoxLanes::EMPTY);
        self.changed.resize(group_count, 0);
    }

    fn set(&mut self, node: usize, node_box: &Aabb, has_changed: bool) {
        let (group, lane) = (node / LANE_COUNT, node % LANE_COUNT);
        self.boxes[group].set(lane, node_box);
        self.changed[group] |= LaneMask::from(has_changed) << lane;
    }
}

/// See the module's documentation.
#[derive(Clone, Debug)]
pub(super) struct BlockTree {
    /// From the objects up; those beyond `depth` are empty and kept for their memory.
    levels: Vec<Level>,
    /// Count of levels in use, at least one; the last one has at most one group.
    depth: usize,
    spheres: Vec<SphereLanes>,
    /// Object index by rank, the place in the order.
    indices: Vec<u32>,
    /// Rank by object index.
    ranks: Vec<u32>,
    /// For each group of the packed objects, arranged as level 1: the least sum of its sides
    /// since they were packed.
    least_sides: Vec<Lanes>,
    packed_count: usize,
    removed_count: usize,
    order: Order,
}

impl BlockTree {
    pub(super) fn new() -> Self {
        Self {
            levels: vec![Level::default()],
            depth: 1,
            spheres: Vec::new(),
            indices: Vec::new(),
            ranks: Vec::new(),
            least_sides: Vec::new(),
            packed_count: 0,
            removed_count: 0,
            order: Order::default(),
        }
    }

    /// Packs the given objects afresh, and forgets all others.
    pub(super) fn pack(
        &mut self,
        objects: impl Iterator<Item = u32>,
        reaches: &[Reach],
        has_changed: &[bool],
    ) {
        self.indices.clear();
        self.indices.extend(self.order.sorted(objects, reaches));
        self.packed_count = self.indices.len();
        self.removed_count = 0;
        self.ranks.clear();
        self.ranks.resize(reaches.len(), NO_RANK);
        self.clear_levels();
        for rank in 0..self.packed_count {
            let index = self.indices[rank] as usize;
            self.ranks[index] = rank as u32;
            self.place(rank, &reaches[index], has_changed[index]);
        }
        self.refit_groups(|_| true);
        self.least_sides.clear();
        if let Some(groups) = self.levels.get(1) {
            self.least_sides.extend(groups.boxes.iter().map(BoxLanes::side_sums));
        }
    }

    fn clear_levels(&mut self) {
        self.levels.iter_mut().for_each(Level::clear);
        self.spheres.clear();
        self.depth = 1;
        while self.capacity() < self.packed_count {
            self.depth += 1;
        }
        if self.levels.len() < self.depth {
            self.levels.resize_with(self.depth, Level::default);
        }
        self.grow();
    }

    /// Count of ranks for which the levels in use suffice.
    fn capacity(&self) -> usize {
        LANE_COUNT.pow(self.depth as u32)
    }

    /// Makes room for all ranks on all levels.
    fn grow(&mut self) {
        let mut group_count = self.indices.len().div_ceil(LANE_COUNT);
        self.spheres.resize(group_count, SphereLanes::ZERO);
        for level in &mut self.levels[..self.depth] {
            level.grow_to(group_count);
            group_count = group_count.div_ceil(LANE_COUNT);
        }
    }

    fn place(&mut self, rank: usize, reach: &Reach, has_changed: bool) {
        self.levels[0].set(rank, &reach.aabb, has_changed);
        self.spheres[rank / LANE_COUNT].set(rank % LANE_COUNT, reach);
    }

    /// Moves an object, or appends it if it is new. Returns false where there is no room for it
    /// before all objects are packed afresh.
    pub(super) fn update(&mut self, index: usize, reach: &Reach) -> bool {
        if self.ranks.len() <= index {
            self.ranks.resize(index + 1, NO_RANK);
        }
        if self.ranks[index] == NO_RANK {
            if self.indices.len() >= self.capacity().min(NO_RANK as usize) {
                return false;
            }
            self.ranks[index] = self.indices.len() as u32;
            self.indices.push(index as u32);
            self.grow();
        }
        self.place(self.ranks[index] as usize, reach, true);
        true
    }

    /// Empties the lane of an object; nothing to do for one that is not in the tree.
    pub(super) fn remove(&mut self, index: usize) {
        let Some(rank) = self.ranks.get_mut(index) else {
            return;
        };
        let rank = std::mem::replace(rank, NO_RANK);
        if rank != NO_RANK {
            self.levels[0].set(rank as usize, &Aabb::EMPTY, true);
            self.removed_count += 1;
        }
    }

    /// Fits the boxes of all nodes around the objects that changed. Returns whether the objects
    /// should be packed afresh.
    pub(super) fn refit(&mut self) -> bool {
        self.refit_groups(|changed| changed != 0);
        let appended_count = self.indices.len() - self.packed_count;
        let worn_count = LANE_COUNT * self.worn_group_count();
        WORN_SHARE * (worn_count + appended_count + self.removed_count) > self.indices.len()
    }

    fn refit_groups(&mut self, is_due: impl Fn(LaneMask) -> bool) {
        for parent_level in 1..self.depth {
            let (below, above) = self.levels.split_at_mut(parent_level);
            let (children, parents) = (&below[parent_level - 1], &mut above[0]);
            for (group, &changed) in children.changed.iter().enumerate() {
                if is_due(changed) {
                    parents.set(group, &children.boxes[group].union(), changed != 0);
                }
            }
        }
    }

    fn worn_group_count(&mut self) -> usize {
        let Some(groups) = self.levels.get(1) else {
            return 0;
        };
        let worn_lanes = |(least, boxes): (&mut Lanes, &BoxLanes)| {
            let sides = boxes.side_sums();
            *least = least.fast_min(sides);
            sides.simd_gt(*least * Lanes::splat(WORN_GROWTH)).to_bitmask().count_ones() as usize
        };
        self.least_sides.iter_mut().zip(&groups.boxes).map(worn_lanes).sum()
    }

    /// Reports each overlapping pair of objects of which at least one has changed, once, in no
    /// useful order; then counts all objects as unchanged.
    pub(super) fn take_pairs(&mut self, mut on_pair: impl FnMut(u32, u32)) {
        if !self.indices.is_empty() {
            self.descend(self.depth - 1, [0, 0], &mut on_pair);
        }
        for level in &mut self.levels {
            level.changed.fill(0);
        }
    }

    /// Descends into the pairs between two groups of a level, `groups[0] <= groups[1]`. Recursion
    /// is as deep as the tree, at most eleven levels for 2³² objects.
    fn descend(&self, level: usize, groups: [usize; 2], on_pair: &mut impl FnMut(u32, u32)) {
        let nodes = &self.levels[level];
        let [boxes1, boxes2] = groups.map(|group| &nodes.boxes[group]);
        let [changed1, changed2] = groups.map(|group| nodes.changed[group]);
        for lane1 in lanes_of(self.lanes_to_descend(level, groups)) {
            let mut lanes2 = boxes2.overlaps(&boxes1.lane(lane1));
            if changed1 & 1 << lane1 == 0 {
                lanes2 &= changed2;
            }
            if groups[0] == groups[1] {
                // Each pair once; on level 0 no object with itself.
                let first = lane1 + usize::from(level == 0);
                lanes2 &= LaneMask::MAX.checked_shl(first as u32).unwrap_or(0);
            }
            if level == 0 && lanes2 != 0 {
                lanes2 &= self.spheres[groups[1]].overlaps(&self.spheres[groups[0]], lane1);
            }
            for lane2 in lanes_of(lanes2) {
                let [node1, node2] = [(groups[0], lane1), (groups[1], lane2)]
                    .map(|(group, lane)| group * LANE_COUNT + lane);
                match level.checked_sub(1) {
                    Some(below) => self.descend(below, [node1, node2], on_pair),
                    None => on_pair(self.indices[node1], self.indices[node2]),
                }
            }
        }
    }

    /// The lanes of the first group that may have a pair in the second.
    #[inline]
    fn lanes_to_descend(&self, level: usize, groups: [usize; 2]) -> LaneMask {
        let nodes = &self.levels[level];
        let [changed1, changed2] = groups.map(|group| nodes.changed[group]);
        let candidates = if changed2 == 0 { changed1 } else { LaneMask::MAX };
        if groups[0] == groups[1] {
            return candidates;
        }
        let parent = &self.levels[level + 1].boxes[groups[1] / LANE_COUNT];
        candidates & nodes.boxes[groups[0]].overlaps(&parent.lane(groups[1] % LANE_COUNT))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OBJECT_COUNT: usize = 1000;

    fn cube(centre: [f32; 3], half_extent: f32) -> Reach {
        Reach {
            aabb: Aabb {
                min: centre.map(|x| x - half_extent),
                max: centre.map(|x| x + half_extent),
            },
            centre,
            radius: half_extent,
        }
    }

    /// Place `i` of a cubic lattice of ten by ten by ten.
    fn place(i: usize) -> [f32; 3] {
        [i % 10, i / 10 % 10, i / 100 % 10].map(|x| 2.0 * x as f32)
    }

    fn packed(reaches: &[Reach]) -> BlockTree {
        let mut tree = BlockTree::new();
        let objects = 0..reaches.len() as u32;
        tree.pack(objects, reaches, &vec![true; reaches.len()]);
        tree
    }

    /// The lattice, and one object that is far larger if `outlier_size` is.
    fn lattice(outlier_size: f32) -> Vec<Reach> {
        let mut reaches: Vec<_> = (0..OBJECT_COUNT).map(|i| cube(place(i), 1.0)).collect();
        reaches[500] = cube(place(500), outlier_size);
        reaches
    }

    fn is_due_after(tree: &mut BlockTree, placement: impl Fn(usize) -> [f32; 3]) -> bool {
        for i in (0..OBJECT_COUNT).filter(|&i| i != 500) {
            assert!(tree.update(i, &cube(placement(i), 1.0)));
        }
        tree.refit()
    }

    /// Catches a rule that packs at every step, which would cost more than the descent.
    #[test]
    fn packing_is_not_due_while_neighbours_stay_neighbours() {
        let mut tree = packed(&lattice(1.0));
        assert!(!tree.refit());
        let far = |i: usize| place(i).map(|x| x + 1000.0);
        assert!(!is_due_after(&mut tree, far));
        let jittered = |i: usize| place(i).map(|x| x + 0.2 * (i % 3) as f32);
        assert!(!is_due_after(&mut tree, jittered));
    }

    /// Catches a rule that never packs, or that one large object, such as a floor, deceives: all
    /// results would be right and each step slow.
    #[test]
    fn packing_is_due_when_neighbours_part() {
        for outlier_size in [1.0, 1e6] {
            let mut tree = packed(&lattice(outlier_size));
            let scattered = |i: usize| place(i * 387);
            assert!(is_due_after(&mut tree, scattered));
        }
    }

    /// Catches a measure of wear that a world which shrinks in the meantime resets.
    #[test]
    fn packing_is_due_when_neighbours_part_in_a_world_that_has_shrunk() {
        let mut tree = packed(&lattice(1.0));
        let shrunk = |i: usize| place(i).map(|x| 0.1 * x);
        assert!(!is_due_after(&mut tree, shrunk));
        assert!(is_due_after(&mut tree, |i| shrunk(i * 387)));
    }

    /// Catches lanes of removed objects that stay for ever, and appended objects that are never
    /// sorted in.
    #[test]
    fn packing_is_due_when_many_objects_came_or_went() {
        let reaches = lattice(1.0);
        let mut tree = packed(&reaches);
        (0..100).for_each(|i| tree.remove(i));
        assert!(!tree.refit());
        (100..300).for_each(|i| tree.remove(i));
        assert!(tree.refit());

        let mut tree = packed(&reaches);
        let mut append = |indices: std::ops::Range<usize>| {
            for i in indices {
                assert!(tree.update(i, &cube(place(i), 1.0)));
            }
            tree.refit()
        };
        assert!(!append(1000..1100));
        assert!(append(1100..1500));
    }
}
