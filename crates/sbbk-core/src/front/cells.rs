//! The pairs of nodes that a front consists of.
//!
//! They come in fours, as the descent compares them: a [`Cell`] is a pair of nodes that met, with
//! its four pairs of children. Each of these has parted, or is a pair of leaves, or leads to a cell
//! of its own. One SIMD test tests all four, and the pairs above the front, which tell when to
//! raise it, are at hand.
//!
//! Of cells that motion cannot have changed a query reads two numbers each, in arrays of their own.

use wide::f32x8;

use super::opening::{Opening, SlotPair};

/// Pairs that meet are not tested again before motion of this many times the least that can part
/// them. More: fewer tests, and more pairs of leaves that have parted are handed out. Slow motion
/// of 2596 triangles, node tests a query: 695 with 1, 527 with 2, 418 with 4 (a fifth less time
/// than 2).
pub(super) const PATIENCE: f32 = 4.0;

/// A pair of nodes that met.
#[derive(Copy, Clone, Debug)]
pub(super) struct Cell {
    pub(super) opening: Opening,
    /// Steps from the pair of roots, which has none.
    pub(super) depth: u32,
    /// Lanes whose pairs met when last asked.
    pub(super) met: u8,
    /// Of each lane that met: its cell, or its place among the pairs of leaves.
    below: [u32; 4],
}

const _: () = assert!(size_of::<Cell>() == 36);

/// A pair of leaves that met.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub(super) struct LeafPair {
    pub(super) leaves: (u32, u32),
    /// Four times the cell, plus the lane.
    owner: u32,
}

/// All cells, and the pairs of leaves that meet.
#[derive(Clone, Debug, Default)]
pub(super) struct Cells {
    cells: Vec<Cell>,
    /// While time plus margin is below this, no pair that has parted can meet. Infinite where no
    /// cell is.
    parted_until: Vec<f32>,
    /// While this is below `PATIENCE·margin - time`, all pairs that met are taken to meet. Minus
    /// infinity where no cell is.
    met_until: Vec<f32>,
    free: Vec<u32>,
    leaf_pairs: Vec<LeafPair>,
    stack: Vec<u32>,
}

impl Cells {
    /// Removes all.
    pub(super) fn clear(&mut self) {
        self.cells.clear();
        self.parted_until.clear();
        self.met_until.clear();
        self.free.clear();
        self.leaf_pairs.clear();
    }

    /// Number of cells.
    pub(super) fn len(&self) -> usize {
        self.cells.len() - self.free.len()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// Bytes held.
    pub(super) fn memory(&self) -> usize {
        self.cells.capacity() * size_of::<Cell>()
            + (self.parted_until.capacity() + self.met_until.capacity()) * size_of::<f32>()
            + (self.free.capacity() + self.stack.capacity()) * size_of::<u32>()
            + self.leaf_pairs.capacity() * size_of::<LeafPair>()
    }

    pub(super) fn get(&self, cell: u32) -> &Cell {
        &self.cells[cell as usize]
    }

    pub(super) fn leaf_pairs(&self) -> &[LeafPair] {
        &self.leaf_pairs
    }

    /// Whether the cell of this number exists.
    pub(super) fn is_cell(&self, cell: u32) -> bool {
        self.parted_until[cell as usize] != f32::INFINITY
    }

    /// A new cell, of which nothing is known yet.
    pub(super) fn add(&mut self, opening: Opening, depth: u32) -> u32 {
        let cell = Cell { opening, depth, met: 0, below: [0; 4] };
        if let Some(free) = self.free.pop() {
            self.cells[free as usize] = cell;
            self.set_lasting(free, f32::NEG_INFINITY, f32::INFINITY);
            return free;
        }
        self.cells.push(cell);
        self.parted_until.push(f32::NEG_INFINITY);
        self.met_until.push(f32::INFINITY);
        self.cells.len() as u32 - 1
    }

    /// Until when the lanes of a cell stay as they are.
    pub(super) fn set_lasting(&mut self, cell: u32, parted_until: f32, met_until: f32) {
        self.parted_until[cell as usize] = parted_until;
        self.met_until[cell as usize] = met_until;
    }

    /// A pair of leaves met.
    pub(super) fn meet_leaves(&mut self, cell: u32, lane: usize, leaves: (u32, u32)) {
        let place = self.leaf_pairs.len() as u32;
        self.leaf_pairs.push(LeafPair { leaves, owner: 4 * cell + lane as u32 });
        self.meet(cell, lane, place);
    }

    /// The pair of a lane met, and has the cell `below`.
    pub(super) fn meet(&mut self, cell: u32, lane: usize, below: u32) {
        let cell = &mut self.cells[cell as usize];
        cell.met |= 1 << lane;
        cell.below[lane] = below;
    }

    /// The pair of a lane has parted: removes everything below it.
    pub(super) fn part(&mut self, cell: u32, lane: usize) {
        self.remove_below(cell, lane);
        self.cells[cell as usize].met &= !(1 << lane);
        while let Some(removed) = self.stack.pop() {
            let met = self.cells[removed as usize].met;
            lanes(met).for_each(|lane| self.remove_below(removed, lane));
            self.set_lasting(removed, f32::INFINITY, f32::NEG_INFINITY);
            self.free.push(removed);
        }
    }

    /// Removes the pair of leaves of a lane, or puts its cell on the stack.
    fn remove_below(&mut self, cell: u32, lane: usize) {
        let Cell { opening, below, .. } = self.cells[cell as usize];
        if opening.leaves >> lane & 1 == 0 {
            self.stack.push(below[lane]);
            return;
        }
        let place = below[lane] as usize;
        self.leaf_pairs.swap_remove(place);
        if let Some(moved) = self.leaf_pairs.get(place) {
            let (owner, lane) = (moved.owner / 4, moved.owner % 4);
            self.cells[owner as usize].below[lane as usize] = place as u32;
        }
    }

    /// Appends the cells whose pairs may have changed, at this time with this margin.
    pub(super) fn due(&self, time: f64, margin: f32, due: &mut Vec<u32>) {
        let reached = ((time + f64::from(margin)) as f32).next_up();
        let patience = (f64::from(PATIENCE * margin) - time) as f32;
        let (parted, parted_rest) = self.parted_until.as_chunks::<8>();
        let (met, met_rest) = self.met_until.as_chunks::<8>();
        for (chunk, (parted, met)) in parted.iter().zip(met).enumerate() {
            let parted = f32x8::new(*parted).simd_le(f32x8::splat(reached));
            let met = f32x8::new(*met).simd_gt(f32x8::splat(patience));
            let mut mask = (parted | met).to_bitmask();
            while mask != 0 {
                due.push(8 * chunk as u32 + mask.trailing_zeros());
                mask &= mask - 1;
            }
        }
        let first = self.cells.len() - parted_rest.len();
        let rest = parted_rest.iter().zip(met_rest).enumerate();
        let is_due = |(&parted, &met): (&f32, &f32)| parted <= reached || met > patience;
        due.extend(rest.filter(|&(_, lasting)| is_due(lasting)).map(|(i, _)| (first + i) as u32));
    }

    /// Appends all cells.
    pub(super) fn all(&self, due: &mut Vec<u32>) {
        due.extend((0..self.cells.len() as u32).filter(|&cell| self.is_cell(cell)));
    }
}

/// The lanes in a mask.
pub(super) fn lanes(mask: u8) -> impl Iterator<Item = usize> {
    (0..4).filter(move |lane| mask >> lane & 1 != 0)
}

impl Cell {
    /// The pair of a lane.
    pub(super) fn pair(&self, lane: usize) -> SlotPair {
        self.opening.pair(lane)
    }
}
