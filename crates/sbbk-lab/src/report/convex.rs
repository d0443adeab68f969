//! The study of convex shapes as files and as a picture.

use super::look::Look;
use super::panel::{Panel, Scale, Series};
use super::{Grid, ResultRow, Results, tables};
use crate::metrics::{Environment, ratio};
use crate::study::contacts::{CONTESTANTS, FAST, SLOW};
use crate::study::convex::{Convex, ConvexRow, ConvexSide, Measured};

/// Stands for no wrong contact in the plot, in wrong contacts for 100 true ones.
const NONE_WRONG: f64 = 1e-3;

fn panel(title: String, rows: &[ConvexRow], measured: fn(&ConvexSide) -> Measured) -> Panel {
    let point = |side: &ConvexSide| {
        let Measured { time, errors } = measured(side);
        let share = ratio(errors.wrong() as f64, errors.true_pairs as f64)?;
        Some((time.median, 100.0 * share))
    };
    let series = [1, 0].map(|side| Series {
        label: CONTESTANTS[side].to_string(),
        look: Look::Backend(CONTESTANTS[side]),
        is_connected: false,
        points: rows.iter().filter_map(|row| point(&row.sides[side])).collect(),
    });
    Panel {
        title,
        x_label: "µs a query".to_owned(),
        y_label: "wrong contacts for 100 true ones".to_owned(),
        scale: Scale::Logarithmic { zero: Some(NONE_WRONG) },
        series: series.into(),
    }
}

impl Results for Convex {
    fn environment(&self) -> &Environment {
        &self.environment
    }

    fn tables(&self) -> Vec<Grid> {
        vec![tables::convex(self)]
    }

    fn rows(&self) -> Vec<ResultRow> {
        let row = |row: &ConvexRow| {
            let scene = format!("{} and {}", self.mesh, row.kind);
            let side = |side| ResultRow::new("convex: queries, µs", scene.clone(), side);
            row.sides.iter().map(side).collect::<Vec<_>>()
        };
        self.rows.iter().flat_map(row).collect()
    }

    /// Time against error over logarithmic axes: first queries, and slow and faster motion. A point is one kind of
    /// shape.
    fn panels(&self) -> Vec<Panel> {
        vec![
            panel("First queries".to_owned(), &self.rows, |side| side.fresh),
            panel(format!("{SLOW} prediction distances a step"), &self.rows, |side| side.slow),
            panel(format!("{FAST} prediction distances a step"), &self.rows, |side| side.fast),
        ]
    }
}
