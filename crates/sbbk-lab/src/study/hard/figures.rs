//! Figures with limits, and the runs that have them.

use super::{Column, Settings};
use crate::prelude::*;
use crate::report::three_digits;

/// Figures of a run.
#[derive(Clone, Debug, Default)]
pub(super) struct Figures {
    pub all: Vec<Figure>,
    /// What the scene has in it, for notes.
    pub about: String,
}

/// A measurement, and the range in which the scene looks right to a user.
#[derive(Clone, Copy, Debug)]
pub(super) struct Figure {
    pub name: &'static str,
    pub value: f64,
    pub limits: [f64; 2],
}

impl Figure {
    /// True within the limits; NaN is not.
    pub fn is_right(&self) -> bool {
        (self.limits[0]..=self.limits[1]).contains(&self.value)
    }
}

impl Figures {
    /// Adds a figure with an upper limit.
    pub fn at_most(self, name: &'static str, value: impl Into<f64>, high: f64) -> Self {
        self.within(name, value, [f64::NEG_INFINITY, high])
    }

    /// Adds a count that must be zero.
    pub fn none(self, name: &'static str, count: usize) -> Self {
        self.at_most(name, count as f64, 0.0)
    }

    /// Adds a figure with limits on both sides.
    pub fn within(mut self, name: &'static str, value: impl Into<f64>, limits: [f64; 2]) -> Self {
        self.all.push(Figure { name, value: value.into(), limits });
        self
    }

    /// Adds a figure without limits.
    pub fn note(self, name: &'static str, value: impl Into<f64>) -> Self {
        self.at_most(name, value, f64::INFINITY)
    }
}

/// The greatest rise over an earlier number; NaN if any is NaN.
pub(super) fn greatest_rise(values: impl IntoIterator<Item = f64>) -> f64 {
    let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
    for value in values {
        least = least.min(value);
        let rise = value - least;
        most = if most.is_nan() || rise <= most { most } else { rise };
    }
    most
}

/// The largest number; NaN if any is NaN, 0 without numbers.
pub(super) fn largest(values: impl IntoIterator<Item = f32>) -> f32 {
    values.into_iter().reduce(|a, b| if a.is_nan() || b <= a { a } else { b }).unwrap_or(0.0)
}

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

/// Would catch a NaN that later numbers hide, and a fall that counts as a rise.
#[test]
fn nan_stays() {
    assert_eq!(greatest_rise([3.0, 1.0, 2.0, 0.5]), 1.0);
    assert!(greatest_rise([1.0, f64::NAN, 2.0]).is_nan());
    assert!(largest([1.0, f32::NAN, 2.0]).is_nan() && largest([f32::NAN, 2.0]).is_nan());
}
