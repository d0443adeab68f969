//! Sweep and prune along the axis of largest variance; insertion sort keeps the order from step
//! to step, and eight objects are tested at once.

use sbbk_core::broad_phase::Bounds;

use crate::candidate::{Candidate, Columns, IndexPair};

#[derive(Default)]
pub struct Sweep {
    margin: f32,
    order: Vec<(f32, u32)>,
    axis: usize,
    columns: Columns,
}

impl Sweep {
    pub fn new(margin: f32) -> Self {
        Self { margin, ..Self::default() }
    }

    fn sort(&mut self, frame: &[Bounds]) {
        let axis = widest_axis(frame);
        let is_fresh = axis != self.axis || self.order.len() != frame.len();
        if is_fresh {
            self.axis = axis;
            self.order = (0..frame.len() as u32).map(|index| (0.0, index)).collect();
        }
        for (key, index) in &mut self.order {
            *key = frame[*index as usize].min[axis];
        }
        if is_fresh {
            self.order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        }
        for i in 1..self.order.len() {
            let moving = self.order[i];
            let mut hole = i;
            while hole > 0 && self.order[hole - 1].0 > moving.0 {
                self.order[hole] = self.order[hole - 1];
                hole -= 1;
            }
            self.order[hole] = moving;
        }
    }
}

fn widest_axis(frame: &[Bounds]) -> usize {
    let count = frame.len() as f64;
    let variance = [0, 1, 2].map(|axis| {
        let (mut sum, mut squares) = (0.0, 0.0);
        for bounds in frame {
            let position = f64::from(bounds.min[axis]);
            sum += position;
            squares += position * position;
        }
        squares / count - (sum / count) * (sum / count)
    });
    (0..3).max_by(|&a, &b| variance[a].total_cmp(&variance[b])).unwrap()
}

impl Candidate for Sweep {
    fn step(&mut self, frame: &[Bounds], pairs: &mut Vec<IndexPair>) {
        self.sort(frame);
        self.columns.clear();
        for &(_, index) in &self.order {
            self.columns.push(index, &frame[index as usize], self.margin);
        }
        self.columns.pad();
        pairs.clear();
        let lower = &self.columns.min[self.axis];
        for i in 0..self.order.len() {
            let end_of_reach = self.columns.max[self.axis][i];
            let mut end = i + 1;
            // The padding is at infinity.
            while lower[end] <= end_of_reach {
                end += 1;
            }
            self.columns.pairs_in(i, i + 1, end, pairs);
        }
    }
}
