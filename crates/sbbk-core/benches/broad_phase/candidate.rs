//! What each candidate structure does, and the pair test they share.

use sbbk_core::broad_phase::{Bounds, BroadPhase, ObjectHandle};
use wide::f32x8;

/// Two object indices, the lower one first.
pub type IndexPair = [u32; 2];

/// A structure that finds all pairs of a frame.
pub trait Candidate {
    /// Takes the bounds of the same objects as before, moved, and leaves all pairs in `pairs`,
    /// in any order.
    fn step(&mut self, frame: &[Bounds], pairs: &mut Vec<IndexPair>);
}

pub fn index_pair(index1: u32, index2: u32) -> IndexPair {
    [index1.min(index2), index1.max(index2)]
}

/// The structure that was kept. It does more than the others: it checks the bounds, sorts the
/// pairs and reports events.
pub struct Kept {
    broad_phase: BroadPhase,
    handles: Vec<ObjectHandle>,
}

impl Kept {
    pub fn new(margin: f32) -> Self {
        let broad_phase = BroadPhase::new(margin).unwrap();
        Self { broad_phase, handles: Vec::new() }
    }
}

impl Candidate for Kept {
    fn step(&mut self, frame: &[Bounds], pairs: &mut Vec<IndexPair>) {
        for bounds in &frame[self.handles.len()..] {
            self.handles.push(self.broad_phase.insert(bounds).unwrap());
        }
        for (&handle, bounds) in self.handles.iter().zip(frame) {
            self.broad_phase.update(handle, bounds).unwrap();
        }
        let mut event_count = 0;
        self.broad_phase.step(|_| event_count += 1);
        std::hint::black_box(event_count);
        let index_pairs = self.broad_phase.pairs().map(|pair| pair.map(|h| h.index() as u32));
        pairs.clear();
        pairs.extend(index_pairs);
    }
}

/// Objects by coordinate, margin included, in an order of the candidate's choice.
#[derive(Default)]
pub struct Columns {
    pub min: [Vec<f32>; 3],
    pub max: [Vec<f32>; 3],
    centre: [Vec<f32>; 3],
    radius: Vec<f32>,
    pub index: Vec<u32>,
}

impl Columns {
    pub fn clear(&mut self) {
        for column in self.min.iter_mut().chain(&mut self.max).chain(&mut self.centre) {
            column.clear();
        }
        self.radius.clear();
        self.index.clear();
    }

    pub fn push(&mut self, index: u32, bounds: &Bounds, margin: f32) {
        for axis in 0..3 {
            self.min[axis].push(bounds.min[axis]);
            self.max[axis].push(bounds.max[axis] + margin);
            self.centre[axis].push(bounds.centre[axis]);
        }
        self.radius.push(bounds.radius + 0.5 * margin);
        self.index.push(index);
    }

    /// Room to read eight objects from the last one on; these extra objects overlap nothing.
    pub fn pad(&mut self) {
        let far = Bounds {
            centre: glamx::Vec3::ZERO,
            radius: 0.0,
            min: glamx::Vec3::INFINITY,
            max: glamx::Vec3::NEG_INFINITY,
        };
        for _ in 0..8 {
            self.push(u32::MAX, &far, 0.0);
        }
    }

    pub fn is_pair(&self, pair: IndexPair) -> bool {
        self.overlaps(pair[0] as usize, pair[1] as usize) & 1 == 1
    }

    /// Which of the eight objects from `start` on pair with object `i`.
    pub fn overlaps(&self, i: usize, start: usize) -> u32 {
        let load =
            |column: &[f32]| f32x8::from(<[f32; 8]>::try_from(&column[start..start + 8]).unwrap());
        let mut overlap = f32x8::splat(self.min[0][i]).simd_le(load(&self.max[0]))
            & load(&self.min[0]).simd_le(f32x8::splat(self.max[0][i]));
        for axis in 1..3 {
            overlap &= f32x8::splat(self.min[axis][i]).simd_le(load(&self.max[axis]))
                & load(&self.min[axis]).simd_le(f32x8::splat(self.max[axis][i]));
        }
        let mask = overlap.to_bitmask();
        if mask == 0 {
            return 0;
        }
        let [x, y, z] = [0, 1, 2].map(|a| load(&self.centre[a]) - f32x8::splat(self.centre[a][i]));
        let reach = load(&self.radius) + f32x8::splat(self.radius[i]);
        let limit = reach * reach * f32x8::splat(1.0 + 8.0 * f32::EPSILON)
            + f32x8::splat(f32::MIN_POSITIVE);
        mask & (x * x + y * y + z * z).simd_le(limit).to_bitmask()
    }

    /// Reports the pairs of object `i` with objects `start` to `end - 1`.
    pub fn pairs_in(&self, i: usize, start: usize, end: usize, pairs: &mut Vec<IndexPair>) {
        for base in (start..end).step_by(8) {
            let mut mask = self.overlaps(i, base) & (0xff >> (8 - (end - base).min(8)));
            while mask != 0 {
                let j = base + mask.trailing_zeros() as usize;
                pairs.push(index_pair(self.index[i], self.index[j]));
                mask &= mask - 1;
            }
        }
    }
}
