use std::cell::RefCell;
use std::collections::BTreeSet;

use glamx::Vec3;
use sbbk_core::field::HeightGrid;

use crate::support::Random;

/// A height field that notes what is asked of it.
#[derive(Clone, Debug)]
pub struct Grid {
    /// Along x and z.
    pub cells: [usize; 2],
    pub scale: Vec3,
    /// Line by line of x.
    pub heights: Vec<f32>,
    /// Of each cell, column by column: the triangles that are missing, bits 1 and 2, and the
    /// diagonal, bit 4.
    pub statuses: Vec<u8>,
    pub asked: RefCell<Asked>,
}

/// What was asked.
#[derive(Clone, Debug, Default)]
pub struct Asked {
    /// Lines of heights.
    pub lines: BTreeSet<usize>,
    /// Cells whose triangles were compared.
    pub cells: BTreeSet<[usize; 2]>,
}

impl Grid {
    /// Without holes.
    pub fn new(
        cells: [usize; 2],
        scale: Vec3,
        mut height: impl FnMut(usize, usize) -> f32,
    ) -> Self {
        let [columns, rows] = cells;
        let lines = (0..=columns).flat_map(|column| (0..=rows).map(move |row| (column, row)));
        let heights = lines.map(|(column, row)| height(column, row)).collect();
        let statuses = vec![0; columns * rows];
        Self { cells, scale, heights, statuses, asked: RefCell::default() }
    }

    /// Hills at random, one unit high at most, with holes and cells divided either way.
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
    fn corner(&self, column: usize, row: usize) -> Vec3 {
        let [x, z] = [(column, self.cells[0]), (row, self.cells[1])]
            .map(|(line, count)| line as f32 * (1.0 / count as f32) - 0.5);
        let y = self.heights[column * (self.cells[1] + 1) + row];
        Vec3::new(x, y, z) * self.scale
    }

    /// The triangles of a cell, without a note.
    pub fn triangles_at(&self, [column, row]: [usize; 2]) -> [Option<[Vec3; 3]>; 2] {
        let status = self.statuses[column * self.cells[1] + row];
        let [a, b] = [self.corner(column, row), self.corner(column, row + 1)];
        let [c, d] = [self.corner(column + 1, row), self.corner(column + 1, row + 1)];
        let both = if status & 4 == 0 { [[a, b, c], [b, d, c]] } else { [[a, b, d], [a, d, c]] };
        [0, 1].map(|side| (status >> side & 1 == 0).then_some(both[side]))
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
        self.asked.borrow_mut().lines.insert(column);
        let line = self.cells[1] + 1;
        &self.heights[column * line..(column + 1) * line]
    }

    fn triangles(&self, cell: [usize; 2]) -> [Option<[Vec3; 3]>; 2] {
        self.asked.borrow_mut().cells.insert(cell);
        self.triangles_at(cell)
    }
}
