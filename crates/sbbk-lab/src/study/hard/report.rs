//! Rows, tables and a picture of hard scenes.

use super::figures::{Figure, Figures};
use super::kit::Kit;
use super::{Column, HardPlan, Trial};
use crate::prelude::*;
use crate::report::three_digits;

const VERDICTS: &str = "hard scenes";
const FIGURES: &str = "hard scenes: figures";
/// Name of the figure in the table of times.
pub(super) const STEP_TIME: &str = "ms a step";

/// The rows of one scene. All runs of a column and a setting of recycling stand together; they
/// have the same figures in the same order.
pub(super) fn rows(trial: &Trial, runs: &[(&Kit, &Figures)]) -> Vec<Row> {
    let mut rows = Vec::new();
    for runs in runs.chunk_by(|(a, _), (b, _)| (a.column, a.recycling) == (b.column, b.recycling)) {
        let kit = runs[0].0;
        let row = |study| {
            let row = Row::new(study, kit.column).key("scene", &*trial.name);
            row.key("contact_recycling", kit.recycling)
        };
        let count = runs[0].1.0.len();
        let worst: Vec<Figure> = (0..count).map(|index| worst_of(runs, index)).collect();
        let passed =
            runs.iter().filter(|(_, figures)| figures.0.iter().all(Figure::is_right)).count();
        rows.push(
            row(VERDICTS)
                .with("runs", runs.len())
                .with("passed", passed)
                .with("verdict", verdict(passed, runs.len(), &worst)),
        );
        rows.extend(worst.into_iter().map(|Figure { name, value, limits }| {
            row(FIGURES).key("figure", name).with("worst", value).with("limits", limits)
        }));
    }
    rows
}

fn worst_of(runs: &[(&Kit, &Figures)], index: usize) -> Figure {
    let of_runs = runs.iter().map(|(_, figures)| figures.0[index]);
    of_runs.reduce(|a, b| if b.excess() > a.excess() { b } else { a }).unwrap_or(runs[0].1.0[index])
}

/// Cell of a table, with the first wrong figure, or else the first one.
fn verdict(passed: usize, runs: usize, worst: &[Figure]) -> String {
    let wrong = worst.iter().find(|figure| !figure.is_right());
    let shown = wrong.or(worst.first()).map_or_else(String::new, |figure| {
        format!("{} {}", figure.name, three_digits(figure.value))
    });
    match (passed == runs, runs) {
        (true, _) => format!("ok: {shown}"),
        (false, 1) => format!("FAILS: {shown}"),
        (false, _) => format!("FAILS {} of {runs}: {shown}", runs - passed),
    }
}

pub(super) fn tables(plan: &HardPlan, rows: &[Row]) -> Vec<Table> {
    let keys = &["scene", "contact_recycling"];
    let columns = |path| plan.columns.iter().map(move |c| number(&c.to_string(), path).of(c));
    let verdicts = TableSpec::new("Hard scenes: how each ends", VERDICTS, keys, columns("verdict"))
        .note(format!("runs of a scene where chaos decides: {}; the worst is shown", plan.seeds))
        .note(
            "flag: FIX_INTERNAL_EDGES on all meshes; control: stock Rapier with convex shapes in \
             place of the meshes",
        );
    let stock = plan.columns.contains(&Column::Stock).then(|| {
        let others = plan.columns.iter().filter(|&&c| c != Column::Stock && c != Column::Control);
        others.map(|c| faster(&format!("{c} vs stock"), "worst", Column::Stock).of(c))
    });
    let times = TableSpec::new(
        "Piles and the tray: median of the steps' times, milliseconds",
        FIGURES,
        keys,
        columns("worst").chain(stock.into_iter().flatten()),
    )
    .note("each on its own trajectory; the slowest run is shown");
    let times_of: Vec<Row> =
        rows.iter().filter(|row| row.is("figure", STEP_TIME)).cloned().collect();
    let figures = TableSpec::new(
        "All figures: the worst of the runs",
        FIGURES,
        &["scene", "figure", "contact_recycling"],
        columns("worst"),
    );
    let mut tables = vec![verdicts.of(rows)];
    if !times_of.is_empty() {
        tables.push(times.of(&times_of));
    }
    if plan.shows_figures {
        tables.push(figures.of(rows));
    }
    tables
}

pub(super) fn verdict_of_all(plan: &HardPlan, rows: &[Row]) -> String {
    let counts = plan.columns.iter().map(|column| {
        let of = rows.iter().filter(|row| row.study == VERDICTS && row.is("backend", column));
        let (mut failed, mut count) = (0, 0);
        for row in of {
            count += 1;
            failed += usize::from(row.count("passed") < row.count("runs"));
        }
        format!("{column} {failed} of {count}")
    });
    format!("scenes that fail: {}", counts.collect::<Vec<_>>().join(", "))
}
