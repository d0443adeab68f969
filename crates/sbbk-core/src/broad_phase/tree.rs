//! An implicit tree of eight children a node.
//!
//! Level 0 holds the boxes of the objects, eight to a group. Lane `l` of group `g` on level `k + 1`
//! is the box around group `8 g + l` of level `k`, up to one group at the top. There are no child
//! indices, and a refit is a sweep over arrays.
//!
//! Pairs come from a simultaneous descent of the tree with itself. Both nodes are always on one
//! level: SIMD tests one lane of the first group against all eight of the second. A pair of nodes
//! is pruned when their boxes do not overlap, or when nothing in either has changed.
//!
//! The order of objects decides only the speed. So objects move by refit, and are packed afresh
//! when too many boxes have grown too much.

use super::Bounds;
use super::lanes::{BoxLanes, LANE_COUNT, LaneMask, Lanes};
use crate::simd::bits;
use crate::volumes::Aabb;

/// Growth of the sum of a group's sides since packing, above which the group is worn. Lower: more
/// packing; higher: larger boxes.
const WORN_GROWTH: f32 = 1.2;

/// Packing is due when one group in this many is worn. Lower: more bad boxes; higher: more packing.
const WORN_SHARE: usize = 4;

/// A level: groups of eight boxes, and a mask of those with an object that changed.
#[derive(Clone, Debug, Default)]
struct Level {
    boxes: Vec<BoxLanes>,
    changed: Vec<LaneMask>,
}

impl Level {
    fn reset(&mut self, group_count: usize) {
        self.boxes.clear();
        self.boxes.resize(group_count, BoxLanes::EMPTY);
        self.changed.clear();
        self.changed.resize(group_count, 0);
    }

    fn set(&mut self, node: usize, node_box: &Aabb, has_changed: bool) {
        let (group, lane) = (node / LANE_COUNT, node % LANE_COUNT);
        self.boxes[group].set(lane, node_box);
        self.changed[group] |= LaneMask::from(has_changed) << lane;
    }
}

/// See the module's documentation.
#[derive(Clone, Debug, Default)]
pub(super) struct BlockTree {
    /// From the objects up; the last has at most one group.
    levels: Vec<Level>,
    /// Object by rank, its place in the order.
    objects: Vec<u32>,
    /// Rank by object.
    ranks: Vec<u32>,
    /// The least sum of sides of each group of objects since packing, arranged as level 1.
    least_sides: Vec<Lanes>,
}

impl BlockTree {
    /// Orders all objects by place.
    pub(super) fn pack(&mut self, reaches: &[Bounds], has_changed: &[bool]) {
        self.objects.clear();
        self.objects.extend(0..reaches.len() as u32);
        sort(&mut self.objects, reaches);
        self.ranks.resize(reaches.len(), 0);
        self.reset_levels();
        for rank in 0..self.objects.len() {
            let object = self.objects[rank] as usize;
            self.ranks[object] = rank as u32;
            self.levels[0].set(rank, &reaches[object].aabb(), has_changed[object]);
        }
        self.refit_groups(|_| true);
        self.least_sides.clear();
        if let Some(groups) = self.levels.get(1) {
            self.least_sides.extend(groups.boxes.iter().map(BoxLanes::side_sums));
        }
    }

    fn reset_levels(&mut self) {
        let mut group_count = self.objects.len().div_ceil(LANE_COUNT);
        let mut depth = 0;
        loop {
            if depth == self.levels.len() {
                self.levels.push(Level::default());
            }
            self.levels[depth].reset(group_count);
            depth += 1;
            if group_count <= 1 {
                break;
            }
            group_count = group_count.div_ceil(LANE_COUNT);
        }
        self.levels.truncate(depth);
    }

    /// Moves an object.
    pub(super) fn update(&mut self, object: usize, aabb: &Aabb) {
        self.levels[0].set(self.ranks[object] as usize, aabb, true);
    }

    /// Fits the boxes of all nodes around the objects that changed. Returns true if packing is due.
    pub(super) fn refit(&mut self) -> bool {
        self.refit_groups(|changed| changed != 0);
        let Some(groups) = self.levels.get(1) else {
            return false;
        };
        let worn_lanes = |(least, boxes): (&mut Lanes, &BoxLanes)| {
            let sides = boxes.side_sums();
            *least = least.fast_min(sides);
            sides.simd_gt(*least * Lanes::splat(WORN_GROWTH)).to_bitmask().count_ones() as usize
        };
        let worn: usize = self.least_sides.iter_mut().zip(&groups.boxes).map(worn_lanes).sum();
        WORN_SHARE * LANE_COUNT * worn > self.objects.len()
    }

    fn refit_groups(&mut self, is_due: impl Fn(LaneMask) -> bool) {
        for parent_level in 1..self.levels.len() {
            let (below, above) = self.levels.split_at_mut(parent_level);
            let (children, parents) = (&below[parent_level - 1], &mut above[0]);
            for (group, &changed) in children.changed.iter().enumerate() {
                if is_due(changed) {
                    parents.set(group, &children.boxes[group].union(), changed != 0);
                }
            }
        }
    }

    /// Reports each pair of overlapping boxes once, if one of the two has changed. Then marks all
    /// objects as unchanged.
    pub(super) fn take_pairs(&mut self, mut on_pair: impl FnMut(u32, u32)) {
        if !self.objects.is_empty() {
            self.descend(self.levels.len() - 1, [0, 0], &mut on_pair);
        }
        for level in &mut self.levels {
            level.changed.fill(0);
        }
    }

    /// Descends into the pairs between two groups of a level, `groups[0] <= groups[1]`.
    fn descend(&self, level: usize, groups: [usize; 2], on_pair: &mut impl FnMut(u32, u32)) {
        let nodes = &self.levels[level];
        let [boxes1, boxes2] = groups.map(|group| &nodes.boxes[group]);
        let [changed1, changed2] = groups.map(|group| nodes.changed[group]);
        for lane1 in bits(self.lanes_to_descend(level, groups).into()) {
            let mut lanes2 = boxes2.overlaps(&boxes1.lane(lane1));
            if changed1 & 1 << lane1 == 0 {
                lanes2 &= changed2;
            }
            if groups[0] == groups[1] {
                // Each pair once; on level 0 no object with itself.
                let first = lane1 + usize::from(level == 0);
                lanes2 &= LaneMask::MAX.checked_shl(first as u32).unwrap_or(0);
            }
            for lane2 in bits(lanes2.into()) {
                let [node1, node2] = [(groups[0], lane1), (groups[1], lane2)]
                    .map(|(group, lane)| group * LANE_COUNT + lane);
                match level.checked_sub(1) {
                    Some(below) => self.descend(below, [node1, node2], on_pair),
                    None => on_pair(self.objects[node1], self.objects[node2]),
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

/// Sorts objects into halves of halves along the axis on which the centres spread most.
///
/// Every cut falls between whole subtrees, so that all nodes except the last on each level are
/// full.
fn sort(objects: &mut [u32], reaches: &[Bounds]) {
    let group_count = objects.len().div_ceil(LANE_COUNT);
    if group_count <= 1 {
        return;
    }
    let centre = |object: &u32, axis: usize| reaches[*object as usize].centre[axis];
    let spread = [0, 1, 2].map(|axis| {
        let centres = objects.iter().map(|object| centre(object, axis));
        let ends = (f32::INFINITY, f32::NEG_INFINITY);
        let (low, high) = centres.fold(ends, |(low, high), x| (low.min(x), high.max(x)));
        high - low
    });
    let [x, y, z] = spread;
    let axis = if x >= y && x >= z { 0 } else { 1 + usize::from(z > y) };
    let mut subtree = 1;
    while subtree * LANE_COUNT < group_count {
        subtree *= LANE_COUNT;
    }
    let middle = LANE_COUNT * (group_count.div_ceil(subtree) / 2 * subtree);
    objects.select_nth_unstable_by(middle, |a, b| centre(a, axis).total_cmp(&centre(b, axis)));
    let (below, above) = objects.split_at_mut(middle);
    sort(below, reaches);
    sort(above, reaches);
}

#[cfg(test)]
mod tests {
    use super::*;
    use glamx::Vec3;

    const OBJECT_COUNT: usize = 1000;

    fn cube(centre: Vec3, radius: f32) -> Bounds {
        Bounds { centre, radius, min: centre - radius, max: centre + radius }
    }

    /// A place of a cubic lattice of ten by ten by ten.
    fn place(i: usize) -> Vec3 {
        Vec3::from_array([i % 10, i / 10 % 10, i / 100 % 10].map(|x| 2.0 * x as f32))
    }

    /// Returns true if packing is due once the lattice, with one object of another size, has moved.
    fn is_due_after(size: f32, moved: &[&dyn Fn(usize) -> Vec3]) -> bool {
        let size = |i: usize| if i == 500 { size } else { 1.0 };
        let reaches: Vec<_> = (0..OBJECT_COUNT).map(|i| cube(place(i), size(i))).collect();
        let mut tree = BlockTree::default();
        tree.pack(&reaches, &[true; OBJECT_COUNT]);
        moved.iter().fold(tree.refit(), |_, moved| {
            (0..OBJECT_COUNT).for_each(|i| tree.update(i, &cube(moved(i), size(i)).aabb()));
            tree.refit()
        })
    }

    /// Would catch a rule that packs at every step, or never, or that one large object or a world
    /// that shrinks deceives.
    #[test]
    fn packing_is_due_once_neighbours_part() {
        let far = |i: usize| place(i) + 1000.0;
        let jittered = |i: usize| place(i) + 0.2 * (i % 3) as f32;
        let scattered = |i: usize| place(i * 387);
        let shrunk = |i: usize| 0.1 * place(i);
        let both = |i: usize| shrunk(i * 387);
        assert!(!is_due_after(1.0, &[]) && !is_due_after(1.0, &[&far, &jittered]));
        assert!(is_due_after(1.0, &[&scattered]) && is_due_after(1e6, &[&scattered]));
        assert!(!is_due_after(1.0, &[&shrunk]) && is_due_after(1.0, &[&shrunk, &both]));
    }
}
