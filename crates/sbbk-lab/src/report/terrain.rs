//! The study of terrains as files.

use super::{ResultRow, Results};
use crate::study::terrain::{Terrain, TerrainRow};

impl Results for Terrain {
    fn rows(&self) -> Vec<ResultRow> {
        let row = |row: &TerrainRow| {
            let scene = format!("{} cells a side, {}", row.cells, row.way);
            ResultRow::new("terrain: queries, µs", scene, row)
        };
        self.rows.iter().map(row).collect()
    }
}
