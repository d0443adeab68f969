//! The study of convex shapes as files and as a picture.

use super::against::time_against_error;
use super::{Grid, Panel, ResultRow, Results, tables};
use crate::metrics::Environment;
use crate::study::contacts::{FAST, Mode, SLOW};
use crate::study::convex::{Convex, ConvexRow};

impl Results for Convex {
    fn environment(&self) -> &Environment {
        &self.environment
    }

    fn tables(&self) -> Vec<Grid> {
        tables::convex(self).into()
    }

    fn rows(&self) -> Vec<ResultRow> {
        let row = |row: &ConvexRow| {
            let scene = format!("{} and {}", self.mesh, row.kind);
            let side = |side| ResultRow::new("convex: queries, µs", scene.clone(), side);
            row.sides.iter().map(side).collect::<Vec<_>>()
        };
        self.rows.iter().flat_map(row).collect()
    }

    /// Time against error: first queries, and slow and faster motion. A point is one kind of shape.
    fn panels(&self) -> Vec<Panel> {
        let panel = |mode: Mode| {
            let title = match mode {
                Mode::Fresh => "First queries".to_owned(),
                Mode::Slow => format!("{SLOW} prediction distances a step"),
                Mode::Fast => format!("{FAST} prediction distances a step"),
            };
            time_against_error(title, |side| {
                let rows = self.rows.iter().map(|row| row.sides[side].measured(mode));
                rows.map(|measured| (measured.time, measured.errors.share())).collect()
            })
        };
        Mode::ALL.map(panel).into()
    }
}
