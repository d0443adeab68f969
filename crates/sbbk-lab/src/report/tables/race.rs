//! Stock and SBBK on the same queries, row by row: how both are asked, times, their ratio, and the errors.

use std::iter::Sum;

use super::super::Grid;
use super::super::format::{min_median, times};
use super::{TIME_NOTE, cells};
use crate::metrics::{geometric_mean, ratio};
use crate::study::contacts::{FAST, Mode, SLOW, STEP_COUNT, Side};

/// What "fresh" means.
pub(super) const FRESH_NOTE: &str =
    "fresh: nothing known about the pair, trees built; to free the manifolds is part of it";

/// A row of a study in which both are asked in every [`Mode`].
pub(super) trait Raced {
    /// How wrong a side was.
    type Errors: Shown;

    /// What was measured.
    fn sides(&self) -> &[Side<Self::Errors>; 2];

    /// What was asked, in as many cells as the table has columns for it.
    fn description(&self, mode: Mode) -> Vec<String>;
}

/// Errors that can be summed up and shown.
pub(super) trait Shown: Copy + Sum {
    /// As a cell.
    fn shown(&self) -> String;
}

/// A row for each mode and row of the study, and one in each mode for the geometric mean of the ratios; without
/// title and notes. `columns` are those of the description, the first of text.
pub(super) fn race<R: Raced>(columns: &[&'static str], rows: &[R]) -> Grid {
    let results = ["stock", "sbbk", "ratio", "errors, stock", "errors, sbbk"];
    Grid {
        header: [&["query"], columns, &results].concat(),
        text_columns: 2,
        rows: Mode::ALL.into_iter().flat_map(|mode| in_mode(mode, columns.len(), rows)).collect(),
        ..Grid::default()
    }
}

fn in_mode<R: Raced>(mode: Mode, column_count: usize, rows: &[R]) -> Vec<Vec<String>> {
    let measured = |row: &R| row.sides().each_ref().map(|side| side.measured(mode));
    let ratio_of = |row: &R| {
        let [stock, sbbk] = measured(row);
        ratio(stock.time.min, sbbk.time.min)
    };
    let mut table: Vec<Vec<String>> = Vec::new();
    for row in rows {
        let [stock, sbbk] = measured(row);
        let results = cells![
            min_median(&stock.time),
            min_median(&sbbk.time),
            times(ratio_of(row)),
            stock.errors.shown(),
            sbbk.errors.shown(),
        ];
        table.push([cells![mode], row.description(mode), results].concat());
    }
    let total =
        |side: usize| rows.iter().map(|row| measured(row)[side].errors).sum::<R::Errors>().shown();
    let mean = times(geometric_mean(rows.iter().filter_map(ratio_of)));
    let blanks = vec![String::new(); column_count + 1];
    table.push([cells![mode, "mean, or all"], blanks, cells![mean, total(0), total(1)]].concat());
    table
}

/// What "steady" means; `judged` says of which answers the errors are.
pub(super) fn motion_note(judged: &str) -> String {
    format!(
        "steady: {STEP_COUNT} steps in a straight line while turning, which move the surface by up \
         to {SLOW} or {FAST} prediction distances each, with what the query before left; errors \
         of {judged}"
    )
}

/// What the columns of times and ratios hold.
pub(super) fn ratio_note() -> String {
    format!("{TIME_NOTE}, both in turn; ratio: of minima; mean: geometric")
}
