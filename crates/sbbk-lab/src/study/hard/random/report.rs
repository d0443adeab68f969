//! Rows, tables and the verdict of random scenes.

use super::{Column, RandomPlan, Run};
use crate::prelude::*;
use crate::report::three_digits;

const SCENES: &str = "random scenes";
const LOST: &str = "random scenes: lost";
const FIGURES: &str = "random scenes: figures";

pub(super) fn results(plan: &RandomPlan, runs: &[Run]) -> Results {
    let mut rows = Vec::new();
    for family in &plan.families {
        for column in &plan.columns {
            let of = runs.iter().filter(|run| (run.family, run.column) == (*family, *column));
            let held = of.clone().filter(|run| run.wrong().is_none()).count();
            let lost = of.clone().filter(|run| is_lost(run, runs)).count();
            let row = Row::new(SCENES, column).key("family", family.to_string());
            rows.push(row.with("scenes", of.count()).with("held", held).with("lost", lost));
        }
    }
    let shown = runs.iter().filter(|run| is_lost(run, runs) || plan.shows_figures);
    rows.extend(shown.clone().filter_map(wrong_row));
    if plan.shows_figures {
        rows.extend(shown.flat_map(figure_rows));
    }
    let tables = tables(plan, &rows);
    Results::new(verdict(plan, &rows), rows, tables)
}

/// True if SBBK breaks a scene that stock holds, with the flag or without.
fn is_lost(run: &Run, runs: &[Run]) -> bool {
    let same = |other: &&Run| (other.family, other.number) == (run.family, run.number);
    let is_stock = |other: &Run| matches!(other.column, Column::Stock | Column::StockFlag);
    run.column == Column::Sbbk
        && run.wrong().is_some()
        && runs.iter().filter(same).any(|other| is_stock(other) && other.wrong().is_none())
}

fn row(study: &'static str, run: &Run) -> Row {
    let row = Row::new(study, run.column).key("family", run.family.to_string());
    row.key("number", run.number)
}

fn wrong_row(run: &Run) -> Option<Row> {
    let wrong = run.wrong()?;
    let row = row(LOST, run).key("about", &*run.about);
    let [low, high] = wrong.limits.map(three_digits);
    let limits = if wrong.limits[0].is_finite() { format!("{low} to {high}") } else { high };
    let reason = format!("{} {}, limit {limits}", wrong.name, three_digits(wrong.value));
    Some(row.with("value", wrong.value).with("limits", wrong.limits).with("reason", reason))
}

fn figure_rows(run: &Run) -> Vec<Row> {
    let figures = run.figures.0.iter();
    let rows = figures
        .map(|figure| row(FIGURES, run).key("figure", figure.name).with("value", figure.value));
    rows.collect()
}

fn tables(plan: &RandomPlan, rows: &[Row]) -> Vec<Table> {
    let count = plan.numbers.len();
    let held = plan.columns.iter().map(|c| number(&c.to_string(), "held").of(c));
    let lost = number("lost by sbbk", "lost").of(Column::Sbbk);
    let table = TableSpec::new(
        format!("Random scenes that hold, of {count} a family; seed {}", plan.seed),
        SCENES,
        &["family"],
        held.chain([lost]),
    );
    let mut tables = vec![
        table
            .total(0)
            .note("lost: SBBK breaks a scene that stock holds, with the flag or not")
            .of(rows),
    ];
    if rows.iter().any(|row| row.study == LOST) {
        let again =
            format!("again: --family FAMILY --number NUMBER --seed {} --verbose", plan.seed);
        let keys = &["family", "number", "backend"];
        let [reason, about] = ["reason", "about"].map(|path| number(path, path));
        let list = TableSpec::new("Scenes that break", LOST, keys, [reason, about]);
        tables.push(list.note(again).of(rows));
    }
    if plan.shows_figures {
        let values = plan.columns.iter().map(|c| number(&c.to_string(), "value").of(c));
        let keys = &["family", "number", "figure"];
        tables.push(TableSpec::new("All figures", FIGURES, keys, values).of(rows));
    }
    tables
}

fn verdict(plan: &RandomPlan, rows: &[Row]) -> String {
    let sum = |column: &Column, path: &str| -> u64 {
        let of = rows.iter().filter(|row| row.study == SCENES && row.is("backend", column));
        of.map(|row| row.count(path)).sum()
    };
    let held = plan.columns.iter().map(|column| format!("{column} {}", sum(column, "held")));
    let held = held.collect::<Vec<_>>().join(", ");
    let scenes = plan.numbers.len() * plan.families.len();
    let lost = sum(&Column::Sbbk, "lost");
    format!("of {scenes} random scenes hold: {held}; stock or flag hold {lost} that sbbk breaks")
}
