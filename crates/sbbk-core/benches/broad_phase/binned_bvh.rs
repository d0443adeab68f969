//! Binary tree by binned surface area heuristic, built afresh at every step, and a simultaneous
//! descent of the tree with itself.

use glamx::Vec3;
use sbbk_core::broad_phase::Bounds;

use crate::candidate::{Candidate, Columns, IndexPair};

const BIN_COUNT: usize = 8;
const LEAF_SIZE: usize = 8;

#[derive(Clone, Copy)]
struct Node {
    min: Vec3,
    max: Vec3,
    start: u32,
    end: u32,
    /// First of two children; 0 in a leaf.
    child: u32,
}

#[derive(Default)]
pub struct BinnedBvh {
    margin: f32,
    items: Vec<(Vec3, Vec3, u32)>,
    nodes: Vec<Node>,
    columns: Columns,
}

fn half_area(min: Vec3, max: Vec3) -> f32 {
    let side = (max - min).max(Vec3::ZERO);
    side.x * side.y + side.y * side.z + side.z * side.x
}

const EMPTY: (Vec3, Vec3) = (Vec3::INFINITY, Vec3::NEG_INFINITY);

impl BinnedBvh {
    pub fn new(margin: f32) -> Self {
        Self { margin, ..Self::default() }
    }

    fn build(&mut self, node_index: usize) {
        let Node { start, end, .. } = self.nodes[node_index];
        let items = &mut self.items[start as usize..end as usize];
        let (min, max) = items.iter().fold(EMPTY, |b, i| (b.0.min(i.0), b.1.max(i.1)));
        self.nodes[node_index].min = min;
        self.nodes[node_index].max = max;
        if items.len() <= LEAF_SIZE {
            return;
        }
        let middle = start + split(items) as u32;
        let child = self.nodes.len();
        self.nodes[node_index].child = child as u32;
        for (start, end) in [(start, middle), (middle, end)] {
            self.nodes.push(Node { min, max, start, end, child: 0 });
        }
        for side in 0..2 {
            self.build(child + side);
        }
    }

    fn descend(&self, a: usize, b: usize, pairs: &mut Vec<IndexPair>) {
        let (node1, node2) = (&self.nodes[a], &self.nodes[b]);
        if !(node1.min.cmple(node2.max) & node2.min.cmple(node1.max)).all() {
            return;
        }
        match (node1.child as usize, node2.child as usize) {
            (0, 0) => {
                for i in node1.start as usize..node1.end as usize {
                    let first = if a == b { i + 1 } else { node2.start as usize };
                    self.columns.pairs_in(i, first, node2.end as usize, pairs);
                }
            }
            (child, _) if a == b => {
                self.descend(child, child, pairs);
                self.descend(child + 1, child + 1, pairs);
                self.descend(child, child + 1, pairs);
            }
            (child, other) => {
                let is_first_larger =
                    half_area(node1.min, node1.max) >= half_area(node2.min, node2.max);
                for side in 0..2 {
                    if other == 0 || (child != 0 && is_first_larger) {
                        self.descend(child + side, b, pairs);
                    } else {
                        self.descend(a, other + side, pairs);
                    }
                }
            }
        }
    }
}

/// Partitions the items and returns how many are in the first part.
fn split(items: &mut [(Vec3, Vec3, u32)]) -> usize {
    let centre = |item: &(Vec3, Vec3, u32)| item.0 + item.1;
    let (lower, upper) = items.iter().fold(EMPTY, |b, i| (b.0.min(centre(i)), b.1.max(centre(i))));
    let axis = (upper - lower).max_position();
    let per_unit = BIN_COUNT as f32 * 0.9999 / (upper - lower)[axis];
    if !per_unit.is_finite() {
        return items.len() / 2;
    }
    let bin_of = |item: &(Vec3, Vec3, u32)| ((centre(item) - lower)[axis] * per_unit) as usize;
    let mut bins = [(EMPTY.0, EMPTY.1, 0); BIN_COUNT];
    for item in items.iter() {
        let bin = &mut bins[bin_of(item)];
        *bin = (bin.0.min(item.0), bin.1.max(item.1), bin.2 + 1);
    }
    let cost = |bins: &[(Vec3, Vec3, usize)]| {
        let (min, max, count) =
            bins.iter().fold((EMPTY.0, EMPTY.1, 0), |u, b| (u.0.min(b.0), u.1.max(b.1), u.2 + b.2));
        half_area(min, max) * count as f32
    };
    let best = (1..BIN_COUNT)
        .min_by(|&a, &b| {
            let total = |border: usize| cost(&bins[..border]) + cost(&bins[border..]);
            total(a).total_cmp(&total(b))
        })
        .unwrap();
    let mut middle = 0;
    for i in 0..items.len() {
        if bin_of(&items[i]) < best {
            items.swap(i, middle);
            middle += 1;
        }
    }
    if middle == 0 || middle == items.len() { items.len() / 2 } else { middle }
}

impl Candidate for BinnedBvh {
    fn step(&mut self, frame: &[Bounds], pairs: &mut Vec<IndexPair>) {
        let margin = Vec3::splat(self.margin);
        self.items.clear();
        let items = frame.iter().zip(0..).map(|(b, index)| (b.min, b.max + margin, index));
        self.items.extend(items);
        self.nodes.clear();
        let (min, max) = EMPTY;
        self.nodes.push(Node { min, max, start: 0, end: frame.len() as u32, child: 0 });
        self.build(0);
        self.columns.clear();
        for &(_, _, index) in &self.items {
            self.columns.push(index, &frame[index as usize], self.margin);
        }
        self.columns.pad();
        pairs.clear();
        self.descend(0, 0, pairs);
    }
}
