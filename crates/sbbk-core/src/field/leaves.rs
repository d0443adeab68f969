use glamx::{DVec3, Vec3};

use super::{FieldFrame, FieldTriangle, HeightGrid};
use crate::leaf::PlacedTest;
use crate::simd::bits;
use crate::tree::LeafBatch;

/// Finds the triangles of a field near batches of triangles of a mesh. Made once a query.
pub struct FieldLeaves<'a, F> {
    frame: &'a FieldFrame<'a, F>,
    test: PlacedTest,
}

impl<'a, F: HeightGrid> FieldLeaves<'a, F> {
    /// For a mesh around `centre`, with coordinates up to `magnitude`.
    pub fn new(frame: &'a FieldFrame<'a, F>, centre: Vec3, magnitude: f32) -> Self {
        let margin = (frame.reach as f32).next_up();
        let test = PlacedTest::new(&frame.placement, centre, magnitude, margin);
        Self { frame, test }
    }

    /// Calls `found` with triangles of the field and indices of triangles of `batch`: all pairs
    /// within the margin, and a few others.
    pub fn visit(&self, batch: &LeafBatch, mut found: impl FnMut(FieldTriangle, u32)) {
        let Self { frame, test } = self;
        let corners = (0..batch.count()).flat_map(|lane| batch.corners(lane));
        let (low, high) = corners
            .map(|corner| frame.placed(corner))
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), corner| {
                (low.min(corner), high.max(corner))
            });
        let Some(cells) = frame.cells_between(low, high) else {
            return;
        };
        let placed = test.place(batch);
        for column in cells.columns.clone() {
            frame.count_reads(cells.rows.len());
            let lines = [column, column + 1].map(|line| frame.field.heights(line));
            for row in cells.rows.clone() {
                let [a, b] = lines.map(|line| [line[row], line[row + 1]]);
                if !cells.is_met([a[0], a[1], b[0], b[1]]) {
                    continue;
                }
                let cell = [column, row];
                for (side, triangle) in frame.field.triangles(cell).iter().enumerate() {
                    let is_finite = |triangle: &&[Vec3; 3]| triangle.iter().all(|x| x.is_finite());
                    let Some(triangle) = triangle.as_ref().filter(is_finite) else {
                        continue;
                    };
                    for lane in bits(placed.near(triangle)) {
                        found(FieldTriangle { cell, side }, batch.triangles()[lane]);
                    }
                }
            }
        }
    }
}
