//! The study of convex shapes as files and as a picture.

use std::path::Path;

use super::look::Look;
use super::panel::{Panel, Scale, Series};
use super::{ReportError, ResultRow, Results};
use crate::metrics::ratio;
use crate::study::contacts::{CONTESTANTS, FAST, SLOW};
use crate::study::convex::{Convex, ConvexRow, ConvexSide, Measured};

/// Stands for no wrong contact in the plot, in wrong contacts for 100 true ones.
const NONE_WRONG: f64 = 1e-3;

/// Writes an SVG picture of three diagrams, time against error over logarithmic axes: first queries, and slow and
/// faster motion. A point is one kind of shape.
///
/// Errors: the file cannot be written.
pub fn write_convex_plot(study: &Convex, path: &Path) -> Result<(), ReportError> {
    let panels = [
        panel("First queries".to_owned(), &study.rows, |side| side.fresh),
        panel(format!("{SLOW} prediction distances a step"), &study.rows, |side| side.slow),
        panel(format!("{FAST} prediction distances a step"), &study.rows, |side| side.fast),
    ];
    Panel::write_all(&panels, path)
}

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
        scale: Scale::Logarithmic { zero: NONE_WRONG },
        series: series.into(),
    }
}

impl Results for Convex {
    fn rows(&self) -> Vec<ResultRow> {
        let row = |row: &ConvexRow| {
            let scene = format!("{} and {}", self.mesh, row.kind);
            let side = |side| ResultRow::new("convex: queries, µs", scene.clone(), side);
            row.sides.iter().map(side).collect::<Vec<_>>()
        };
        self.rows.iter().flat_map(row).collect()
    }
}
