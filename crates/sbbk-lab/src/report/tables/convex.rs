//! A mesh against convex shapes.

use super::super::Grid;
use super::super::format::{errors, min_median, times};
use super::{TIME_NOTE, cells};
use crate::metrics::{ErrorCount, geometric_mean, ratio};
use crate::study::contacts::{FAST, SLOW, STEP_COUNT};
use crate::study::convex::{Convex, ConvexRow, ConvexSide, Measured};

/// A way to ask, and its measurement.
type Mode = (String, fn(&ConvexSide) -> Measured);

/// Times and errors of first and steady queries, kind by kind.
pub fn convex(study: &Convex) -> Grid {
    let modes: [Mode; 3] = [
        ("fresh".to_owned(), |side| side.fresh),
        (format!("steady, {SLOW} a step"), |side| side.slow),
        (format!("steady, {FAST} a step"), |side| side.fast),
    ];
    let Convex { mesh, triangle_count, prediction, rows, .. } = study;
    Grid {
        title: format!(
            "A mesh against convex shapes: {mesh} of {triangle_count} triangles, prediction \
             distance {prediction}; microseconds a query"
        ),
        header: vec![
            "query",
            "shape",
            "places or motions",
            "stock",
            "sbbk",
            "ratio",
            "errors, stock",
            "errors, sbbk",
        ],
        text_columns: 2,
        rows: modes.iter().flat_map(|mode| lines(mode, rows)).collect(),
        notes: vec![
            "fresh: nothing known of the pair, tree built; to free the manifolds is part of it"
                .to_owned(),
            format!(
                "steady: {STEP_COUNT} steps in a straight line while turning, which move the \
                 surface by up to {SLOW} or {FAST} prediction distances each, with what the query \
                 before left"
            ),
            "every other place or motion is asked with the mesh first".to_owned(),
            format!("{TIME_NOTE}, both in turn; ratio: of minima; mean: geometric"),
            "errors: lost + added + wrong depth, of the true contacts in all answers, against \
             Parry's routine run afresh on every triangle; 1 % of the prediction distance may go \
             either way, depths are wrong from 5 % on"
                .to_owned(),
        ],
    }
}

/// A row for each kind, and one for the geometric mean of the ratios.
fn lines((name, measured): &Mode, rows: &[ConvexRow]) -> Vec<Vec<String>> {
    let both = |row: &ConvexRow| row.sides.each_ref().map(measured);
    let ratio_of = |row: &ConvexRow| {
        let [stock, sbbk] = both(row);
        ratio(stock.time.min, sbbk.time.min)
    };
    let line = |row: &ConvexRow| {
        let [stock, sbbk] = both(row);
        cells![
            name,
            row.kind,
            row.place_count,
            min_median(&stock.time),
            min_median(&sbbk.time),
            times(ratio_of(row)),
            errors(&stock.errors),
            errors(&sbbk.errors),
        ]
    };
    let total = |side: usize| rows.iter().map(|row| both(row)[side].errors).sum::<ErrorCount>();
    let mean = times(geometric_mean(rows.iter().filter_map(ratio_of)));
    let sums = [errors(&total(0)), errors(&total(1))];
    let last = cells![name, "mean, or all", "", "", "", mean, sums[0], sums[1]];
    rows.iter().map(line).chain([last]).collect()
}
