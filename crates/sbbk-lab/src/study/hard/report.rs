//! Rows and notes of hard and random scenes.

use super::figures::{Figure, Figures};
use super::{Column, Settings};
use crate::prelude::*;
use crate::report::three_digits;

/// A scene that ran in one column.
pub(super) struct Run {
    /// Kind of the scene.
    pub group: String,
    pub scene: String,
    pub column: Column,
    pub figures: Figures,
}

impl Run {
    /// The first figure beyond its limits.
    pub fn wrong(&self) -> Option<&Figure> {
        self.figures.all.iter().find(|figure| !figure.is_right())
    }

    /// Columns that hold the scene.
    pub fn held_by(&self, runs: &[Self]) -> Vec<Column> {
        let held = runs.iter().filter(|run| run.scene == self.scene && run.wrong().is_none());
        held.map(|run| run.column).collect()
    }

    /// A row for each figure.
    pub fn rows(&self, study: &'static str) -> Vec<Row> {
        let row = |figure: &Figure| {
            let row = Row::new(study, self.column).key("scene", &self.scene);
            let row = row.key("figure", figure.name);
            row.with("worst", figure.value).with("limits", figure.limits)
        };
        self.figures.all.iter().map(row).collect()
    }

    /// Says which figure is wrong, and which columns hold the scene.
    fn complaint(&self, runs: &[Self]) -> Option<String> {
        let Figure { name, value, limits: [low, high] } = *self.wrong()?;
        let limit = if low.is_finite() && value < low { low } else { high };
        let held: Vec<String> = self.held_by(runs).iter().map(Column::to_string).collect();
        Some(format!(
            "{} breaks {}: {name} {}, limit {}; held by: {}{}",
            self.column,
            self.scene,
            three_digits(value),
            three_digits(limit),
            held.join(", "),
            self.figures.about
        ))
    }

    fn figures(&self) -> String {
        let figures = self.figures.all.iter();
        let figures =
            figures.map(|figure| format!("{} {}", figure.name, three_digits(figure.value)));
        let figures = figures.collect::<Vec<_>>().join(", ");
        format!("{}, {}: {figures}{}", self.scene, self.column, self.figures.about)
    }
}

/// Scenes that SBBK breaks; all that break, and all figures, if the settings say so.
pub(super) fn notes(settings: &Settings, runs: &[Run]) -> Vec<String> {
    let shows_all = settings.verbose;
    let broken = runs.iter().filter(|run| shows_all || run.column == Column::Sbbk);
    let figures = runs.iter().filter(|_| shows_all).map(Run::figures);
    broken.filter_map(|run| run.complaint(runs)).chain(figures).collect()
}
