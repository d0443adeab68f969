//! Dynamic tree of fattened boxes with insertion by surface area. An object is inserted anew, and
//! asks for its partners, only when it leaves its fat box; the pairs of fat boxes are kept and
//! tested exactly at every step.

use std::collections::HashSet;
use std::hash::{BuildHasherDefault, Hasher};

use glamx::Vec3;
use sbbk_core::broad_phase::Bounds;

use crate::candidate::{Candidate, Columns, IndexPair, index_pair};

/// Fattening as a share of the object's size.
const FATTENING: f32 = 0.1;
const NONE: u32 = u32::MAX;

#[derive(Clone, Copy)]
struct Node {
    min: Vec3,
    max: Vec3,
    parent: u32,
    /// Both `NONE` in a leaf; leaf `i` is node `2 i`.
    children: [u32; 2],
}

#[derive(Default, Clone)]
struct PairHasher(u64);

impl Hasher for PairHasher {
    fn finish(&self) -> u64 {
        self.0
    }
    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.write_u64(u64::from(byte));
        }
    }
    fn write_u64(&mut self, value: u64) {
        self.0 = (self.0 ^ value).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(26);
    }
}

pub struct DynamicTree {
    margin: f32,
    root: u32,
    nodes: Vec<Node>,
    /// Inner nodes out of use; inner nodes are odd, and there is one for each leaf.
    free: Vec<u32>,
    fat_pairs: Vec<IndexPair>,
    known: HashSet<u64, BuildHasherDefault<PairHasher>>,
    columns: Columns,
    stack: Vec<u32>,
}

fn key(pair: IndexPair) -> u64 {
    u64::from(pair[0]) << 32 | u64::from(pair[1])
}

fn half_area(min: Vec3, max: Vec3) -> f32 {
    let side = max - min;
    side.x * side.y + side.y * side.z + side.z * side.x
}

impl DynamicTree {
    pub fn new(margin: f32) -> Self {
        Self {
            margin,
            root: NONE,
            nodes: Vec::new(),
            free: Vec::new(),
            fat_pairs: Vec::new(),
            known: HashSet::default(),
            columns: Columns::default(),
            stack: Vec::new(),
        }
    }

    fn node(&self, index: u32) -> &Node {
        &self.nodes[index as usize]
    }

    fn overlap(&self, a: u32, b: u32) -> bool {
        let (a, b) = (self.node(a), self.node(b));
        (a.min.cmple(b.max) & b.min.cmple(a.max)).all()
    }

    /// The node beside which the leaf adds the least area, found by greedy descent.
    fn sibling_for(&self, leaf: u32) -> u32 {
        let Node { min, max, .. } = *self.node(leaf);
        let grown = |n: &Node| half_area(n.min.min(min), n.max.max(max));
        let mut current = self.root;
        loop {
            let node = self.node(current);
            if node.children[0] == NONE {
                return current;
            }
            let inherited = 2.0 * (grown(node) - half_area(node.min, node.max));
            let cost = |child: u32| {
                let c = self.node(child);
                let own = if c.children[0] == NONE { 0.0 } else { half_area(c.min, c.max) };
                grown(c) - own + inherited
            };
            let costs = node.children.map(cost);
            if 2.0 * grown(node) < costs[0].min(costs[1]) {
                return current;
            }
            current = node.children[usize::from(costs[1] < costs[0])];
        }
    }

    fn insert(&mut self, leaf: u32) {
        if self.root == NONE {
            self.root = leaf;
            self.nodes[leaf as usize].parent = NONE;
            return;
        }
        let sibling = self.sibling_for(leaf);
        let above = self.free.pop().unwrap();
        let parent = self.node(sibling).parent;
        self.nodes[above as usize].children = [sibling, leaf];
        self.nodes[above as usize].parent = parent;
        self.replace_child(parent, sibling, above);
        for child in [sibling, leaf] {
            self.nodes[child as usize].parent = above;
        }
        self.refit_from(above);
    }

    fn replace_child(&mut self, parent: u32, old: u32, new: u32) {
        if parent == NONE {
            self.root = new;
        } else {
            let children = &mut self.nodes[parent as usize].children;
            *children.iter_mut().find(|c| **c == old).unwrap() = new;
        }
    }

    fn remove(&mut self, leaf: u32) {
        let parent = self.node(leaf).parent;
        if parent == NONE {
            self.root = NONE;
            return;
        }
        let Node { children, parent: grandparent, .. } = *self.node(parent);
        let sibling = children[usize::from(children[0] == leaf)];
        self.replace_child(grandparent, parent, sibling);
        self.nodes[sibling as usize].parent = grandparent;
        self.refit_from(grandparent);
        self.free.push(parent);
    }

    fn refit_from(&mut self, mut index: u32) {
        while index != NONE {
            self.rotate(index);
            let [a, b] = self.node(index).children.map(|c| *self.node(c));
            let node = &mut self.nodes[index as usize];
            node.min = a.min.min(b.min);
            node.max = a.max.max(b.max);
            index = node.parent;
        }
    }

    /// Swaps a child with a grandchild on the other side where that saves most area.
    fn rotate(&mut self, index: u32) {
        let children = self.node(index).children;
        let mut best = (0.0, None);
        for side in 0..2 {
            let (child, other) = (children[side], children[1 - side]);
            for grandchild_side in 0..2 {
                let inner = *self.node(other);
                if inner.children[0] == NONE {
                    continue;
                }
                let stays = self.node(inner.children[1 - grandchild_side]);
                let moved = self.node(child);
                let area = half_area(stays.min.min(moved.min), stays.max.max(moved.max));
                let saved = half_area(inner.min, inner.max) - area;
                if saved > best.0 {
                    best = (saved, Some((child, other, inner.children[grandchild_side])));
                }
            }
        }
        if let (_, Some((child, other, grandchild))) = best {
            self.replace_child(index, child, grandchild);
            self.replace_child(other, grandchild, child);
            self.nodes[grandchild as usize].parent = index;
            self.nodes[child as usize].parent = other;
            let [a, b] = self.node(other).children.map(|c| *self.node(c));
            self.nodes[other as usize].min = a.min.min(b.min);
            self.nodes[other as usize].max = a.max.max(b.max);
        }
    }

    /// Inserts the leaf anew if its object has left its fat box. Returns whether it did.
    fn relocate(&mut self, index: usize, bounds: &Bounds) -> bool {
        let max = bounds.max + self.margin;
        let leaf = 2 * index as u32;
        let is_new = self.nodes.len() <= leaf as usize;
        if is_new {
            let node = Node { min: Vec3::ZERO, max: Vec3::ZERO, parent: NONE, children: [NONE; 2] };
            self.nodes.extend([node, node]);
            self.free.push(leaf + 1);
        } else if (self.node(leaf).min.cmple(bounds.min) & max.cmple(self.node(leaf).max)).all() {
            return false;
        } else {
            self.remove(leaf);
        }
        let fattening = FATTENING * (bounds.max - bounds.min);
        self.nodes[leaf as usize].min = bounds.min - fattening;
        self.nodes[leaf as usize].max = max + fattening;
        self.insert(leaf);
        true
    }

    fn find_fat_pairs(&mut self, leaf: u32) {
        self.stack.push(self.root);
        while let Some(index) = self.stack.pop() {
            if !self.overlap(index, leaf) {
                continue;
            }
            let children = self.node(index).children;
            if children[0] != NONE {
                self.stack.extend(children);
            } else if index != leaf {
                let pair = index_pair(index / 2, leaf / 2);
                if self.known.insert(key(pair)) {
                    self.fat_pairs.push(pair);
                }
            }
        }
    }
}

impl Candidate for DynamicTree {
    fn step(&mut self, frame: &[Bounds], pairs: &mut Vec<IndexPair>) {
        self.columns.clear();
        let mut relocated = Vec::new();
        for (index, bounds) in frame.iter().enumerate() {
            self.columns.push(index as u32, bounds, self.margin);
            if self.relocate(index, bounds) {
                relocated.push(2 * index as u32);
            }
        }
        self.columns.pad();
        for leaf in relocated {
            self.find_fat_pairs(leaf);
        }
        let mut fat_pairs = std::mem::take(&mut self.fat_pairs);
        pairs.clear();
        fat_pairs.retain(|&pair| {
            let is_kept = self.overlap(2 * pair[0], 2 * pair[1]);
            if !is_kept {
                self.known.remove(&key(pair));
            } else if self.columns.is_pair(pair) {
                pairs.push(pair);
            }
            is_kept
        });
        self.fat_pairs = fat_pairs;
    }
}
