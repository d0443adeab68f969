//! Uniform grid, hashed, cells twice the median size; an object is listed in each cell it
//! touches, and one that touches too many is tested against all.

use sbbk_core::broad_phase::Bounds;

use crate::candidate::{Candidate, Columns, IndexPair, index_pair};

/// An object that touches more cells than this is tested against all objects.
const CELL_LIMIT: i64 = 64;

#[derive(Default)]
pub struct Grid {
    margin: f32,
    columns: Columns,
    large: Vec<u32>,
    /// Bucket and object, one entry a cell an object touches.
    entries: Vec<(u32, [i32; 3], u32)>,
    starts: Vec<u32>,
    bucketed: Vec<([i32; 3], u32)>,
}

type Cells = [[i32; 2]; 3];

impl Grid {
    pub fn new(margin: f32) -> Self {
        Self { margin, ..Self::default() }
    }

    fn cells(&self, i: usize, per_unit: f32) -> Cells {
        [0, 1, 2].map(|axis| {
            [self.columns.min[axis][i], self.columns.max[axis][i]]
                .map(|bound| (bound * per_unit).floor() as i32)
        })
    }

    fn list(&mut self, count: usize, per_unit: f32) {
        self.entries.clear();
        self.large.clear();
        let bucket_mask = (2 * count).next_power_of_two() as u32 - 1;
        for i in 0..count {
            let [x, y, z] = self.cells(i, per_unit);
            let cell_count: i64 =
                [x, y, z].iter().map(|c| i64::from(c[1]) - i64::from(c[0]) + 1).product();
            if cell_count > CELL_LIMIT {
                self.large.push(i as u32);
                continue;
            }
            for cx in x[0]..=x[1] {
                for cy in y[0]..=y[1] {
                    for cz in z[0]..=z[1] {
                        let cell = [cx, cy, cz];
                        self.entries.push((hash(cell) & bucket_mask, cell, i as u32));
                    }
                }
            }
        }
        self.bucket(bucket_mask as usize + 1);
    }

    fn bucket(&mut self, bucket_count: usize) {
        self.starts.clear();
        self.starts.resize(bucket_count + 1, 0);
        for &(bucket, ..) in &self.entries {
            self.starts[bucket as usize + 1] += 1;
        }
        for bucket in 0..bucket_count {
            self.starts[bucket + 1] += self.starts[bucket];
        }
        self.bucketed.resize(self.entries.len(), Default::default());
        let mut next = self.starts.clone();
        for &(bucket, cell, i) in &self.entries {
            self.bucketed[next[bucket as usize] as usize] = (cell, i);
            next[bucket as usize] += 1;
        }
    }

    /// A pair is reported in the cell of the lower corner of its common box, hence once.
    fn pairs_in_bucket(&self, bucket: usize, per_unit: f32, pairs: &mut Vec<IndexPair>) {
        let members =
            &self.bucketed[self.starts[bucket] as usize..self.starts[bucket + 1] as usize];
        for (k, &(cell1, i)) in members.iter().enumerate() {
            for &(cell2, j) in &members[k + 1..] {
                let (i, j) = (i as usize, j as usize);
                let is_lower_corner = || {
                    (0..3).all(|axis| {
                        let lower = self.columns.min[axis][i].max(self.columns.min[axis][j]);
                        (lower * per_unit).floor() as i32 == cell1[axis]
                    })
                };
                let pair = index_pair(i as u32, j as u32);
                if cell1 == cell2 && is_lower_corner() && self.columns.is_pair(pair) {
                    pairs.push(pair);
                }
            }
        }
    }
}

fn hash([x, y, z]: [i32; 3]) -> u32 {
    let mixed = (x as u32).wrapping_mul(0x8da6_b343)
        ^ (y as u32).wrapping_mul(0xd816_3841)
        ^ (z as u32).wrapping_mul(0xcb1a_b31f);
    mixed ^ mixed >> 15
}

impl Candidate for Grid {
    fn step(&mut self, frame: &[Bounds], pairs: &mut Vec<IndexPair>) {
        self.columns.clear();
        for (index, bounds) in frame.iter().enumerate() {
            self.columns.push(index as u32, bounds, self.margin);
        }
        self.columns.pad();
        let mut extents: Vec<f32> = frame.iter().map(|b| (b.max - b.min).max_element()).collect();
        let median = *extents.select_nth_unstable_by(frame.len() / 2, f32::total_cmp).1;
        let per_unit = 0.5 / (median + self.margin);
        self.list(frame.len(), per_unit);
        pairs.clear();
        for bucket in 0..self.starts.len() - 1 {
            self.pairs_in_bucket(bucket, per_unit, pairs);
        }
        let mut is_large = vec![false; frame.len()];
        for &i in &self.large {
            is_large[i as usize] = true;
        }
        let mut found = Vec::new();
        for &i in &self.large {
            self.columns.pairs_in(i as usize, 0, frame.len(), &mut found);
            pairs.extend(found.drain(..).filter(|&[a, b]| {
                let other = if a == i { b } else { a };
                other != i && (!is_large[other as usize] || i < other)
            }));
        }
    }
}
