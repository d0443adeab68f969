use crate::prelude::*;
use sbbk_core::field::{FieldTriangle, HeightGrid};

/// A height field with holes.
#[derive(Clone, Debug)]
pub struct Grid {
    /// Along x and z.
    pub cells: [usize; 2],
    pub scale: Vec3,
    /// Line by line of x.
    pub heights: Vec<f32>,
    /// For each cell, column by column: bits 1 and 2 for missing triangles, bit 4 for the diagonal.
    pub statuses: Vec<u8>,
}

impl Grid {
    /// A field without holes.
    pub fn new(
        cells: [usize; 2],
        scale: Vec3,
        mut height: impl FnMut(usize, usize) -> f32,
    ) -> Self {
        let [columns, rows] = cells;
        let lines = (0..=columns).flat_map(|column| (0..=rows).map(move |row| (column, row)));
        let heights = lines.map(|(column, row)| height(column, row)).collect();
        Self { cells, scale, heights, statuses: vec![0; columns * rows] }
    }

    /// Random hills, one unit high at most, with holes and cells divided either way.
    pub fn hills(random: &mut Random, cells: [usize; 2], scale: Vec3) -> Self {
        Self::new(cells, scale, |_, _| random.range(-0.5, 0.5)).with_holes(random)
    }

    /// Steps and plains: cells of one unit, heights of 0, 1 or 2.
    pub fn lattice(random: &mut Random, cells: [usize; 2]) -> Self {
        let scale = Vec3::new(cells[0] as f32, 1.0, cells[1] as f32);
        Self::new(cells, scale, |_, _| (random.bits() % 3) as f32).with_holes(random)
    }

    fn with_holes(mut self, random: &mut Random) -> Self {
        for status in &mut self.statuses {
            let missing = if random.bits().is_multiple_of(6) { random.bits() % 4 } else { 0 };
            *status = (missing | (random.bits() % 2) << 2) as u8;
        }
        self
    }

    /// The corner on these lines, in f32 as a host computes it.
    pub fn corner(&self, column: usize, row: usize) -> Vec3 {
        let [x, z] = [(column, self.cells[0]), (row, self.cells[1])]
            .map(|(line, count)| line as f32 * (1.0 / count as f32) - 0.5);
        let y = self.heights[column * (self.cells[1] + 1) + row];
        Vec3::new(x, y, z) * self.scale
    }

    /// All triangles without those that have corners that are NaN or infinite.
    pub fn all_triangles(&self) -> impl Iterator<Item = (FieldTriangle, [DVec3; 3])> {
        let rows = self.cells[1];
        let cells = (0..self.cells[0]).flat_map(move |c| (0..rows).map(move |r| [c, r]));
        let triangles = cells.flat_map(|cell| {
            let sides = (0..).zip(self.triangles(cell));
            sides.filter_map(move |(side, corners)| Some((FieldTriangle { cell, side }, corners?)))
        });
        let finite = triangles.filter(|(_, corners)| corners.iter().all(|x| x.is_finite()));
        finite.map(|(triangle, corners)| (triangle, corners.map(Vec3::as_dvec3)))
    }

    pub fn has(&self, FieldTriangle { cell, side }: FieldTriangle) -> bool {
        let is_inside = cell[0] < self.cells[0] && cell[1] < self.cells[1];
        is_inside && self.triangles(cell)[side].is_some()
    }
}

impl HeightGrid for Grid {
    fn cell_counts(&self) -> [usize; 2] {
        self.cells
    }

    fn scale(&self) -> Vec3 {
        self.scale
    }

    fn heights(&self, column: usize) -> &[f32] {
        let line = self.cells[1] + 1;
        &self.heights[column * line..(column + 1) * line]
    }

    fn triangles(&self, [column, row]: [usize; 2]) -> [Option<[Vec3; 3]>; 2] {
        let status = self.statuses[column * self.cells[1] + row];
        let [a, b] = [self.corner(column, row), self.corner(column, row + 1)];
        let [c, d] = [self.corner(column + 1, row), self.corner(column + 1, row + 1)];
        let both = if status & 4 == 0 { [[a, b, c], [b, d, c]] } else { [[a, b, d], [a, d, c]] };
        [0, 1].map(|side| (status >> side & 1 == 0).then_some(both[side]))
    }
}
