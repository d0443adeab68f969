//! Rows, tables and the verdict of random scenes.

use super::{Column, RandomPlan, Run};
use crate::prelude::*;
use crate::report::three_digits;

const SCENES: &str = "random scenes";
const BROKEN: &str = "random scenes: broken";
const FIGURES: &str = "random scenes: figures";

pub(super) fn results(plan: &RandomPlan, runs: &[Run]) -> Results {
    let mut rows = Vec::new();
    for (family, column) in
        plan.families.iter().flat_map(|f| plan.columns.iter().map(move |c| (f, c)))
    {
        let of = runs.iter().filter(|run| (run.family, run.column) == (*family, *column));
        let held = of.clone().filter(|run| run.wrong().is_none()).count();
        let lost = of.clone().filter(|run| is_lost(run, runs)).count();
        let row = Row::new(SCENES, column).key("family", family.to_string());
        rows.push(row.with("scenes", of.count()).with("held", held).with("lost", lost));
    }
    let broken = runs.iter().filter(|run| run.column == Column::Sbbk || plan.shows_figures);
    rows.extend(broken.filter_map(|run| wrong_row(run, runs)));
    if plan.shows_figures {
        rows.extend(runs.iter().flat_map(figure_rows));
    }
    let tables = tables(plan, &rows);
    Results::new(verdict(plan, &rows), rows, tables)
}

/// Columns other than this one that hold the scene.
fn held_by(run: &Run, runs: &[Run]) -> Vec<Column> {
    let same = |other: &&Run| (other.family, other.number) == (run.family, run.number);
    let held = runs.iter().filter(same).filter(|other| other.wrong().is_none());
    held.map(|other| other.column).collect()
}

/// True if SBBK breaks a scene that stock holds, with the flag or without.
fn is_lost(run: &Run, runs: &[Run]) -> bool {
    let is_stock = |column: &Column| matches!(column, Column::Stock | Column::StockFlag);
    let is_broken = run.column == Column::Sbbk && run.wrong().is_some();
    is_broken && held_by(run, runs).iter().any(is_stock)
}

fn row(study: &'static str, run: &Run) -> Row {
    let row = Row::new(study, run.column).key("family", run.family.to_string());
    row.key("number", run.number)
}

fn wrong_row(run: &Run, runs: &[Run]) -> Option<Row> {
    let wrong = run.wrong()?;
    let [low, high] = wrong.limits.map(three_digits);
    let limits = if wrong.limits[0].is_finite() { format!("{low} to {high}") } else { high };
    let reason = format!("{} {}, limit {limits}", wrong.name, three_digits(wrong.value));
    let held: Vec<String> = held_by(run, runs).iter().map(Column::to_string).collect();
    let row = row(BROKEN, run).key("about", &*run.about).with("value", wrong.value);
    Some(row.with("limits", wrong.limits).with("reason", reason).with("held", held.join(", ")))
}

fn figure_rows(run: &Run) -> impl Iterator<Item = Row> {
    let figures = run.figures.0.iter();
    figures.map(|figure| row(FIGURES, run).key("figure", figure.name).with("value", figure.value))
}

fn tables(plan: &RandomPlan, rows: &[Row]) -> Vec<Table> {
    let of_columns =
        |path| plan.columns.iter().map(move |column| number(&column.to_string(), path).of(column));
    let lost = number("lost by sbbk", "lost").of(Column::Sbbk);
    let held = of_columns("held").chain([lost]);
    let title = format!("Scenes that hold, of {} a family; seed {}", plan.numbers.len(), plan.seed);
    let held = TableSpec::new(title, SCENES, &["family"], held).total(0);
    let held = held.note("lost: SBBK breaks a scene that stock holds, with the flag or without");
    let scene = ["family", "number", "backend"];
    let columns = [("reason", "reason"), ("held by", "held"), ("about", "about")];
    let columns = columns.map(|(header, path)| number(header, path));
    let again = format!("again: --family FAMILY --number NUMBER --seed {} --verbose", plan.seed);
    let broken = TableSpec::new("Scenes that break", BROKEN, &scene, columns).note(again);
    let keys = ["family", "number", "figure"];
    let figures = TableSpec::new("All figures", FIGURES, &keys, of_columns("value"));
    let mut tables = vec![held.of(rows), broken.of(rows), figures.of(rows)];
    tables.retain(|table| !table.lines.is_empty());
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
