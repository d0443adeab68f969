//! Results for other programs.

use std::fs::File;
use std::path::Path;

use serde::Serialize;
use serde_json::Value;

use super::{Grid, Panel, ReportError};
use crate::metrics::Environment;

/// Creates an empty file, so that a path that cannot be written is noticed before the measurement
/// that is to be written there.
///
/// Errors: the file cannot be created.
pub fn reserve(path: &Path) -> Result<(), ReportError> {
    File::create(path).map_err(|cause| ReportError::new(path, cause))?;
    Ok(())
}

/// Results that can be shown, and become files.
pub trait Results: Serialize {
    /// Where they were measured.
    fn environment(&self) -> &Environment;
    /// For the terminal.
    fn tables(&self) -> Vec<Grid>;
    /// Their rows, of all tables.
    fn rows(&self) -> Vec<ResultRow>;
    /// Their picture, from left to right.
    fn panels(&self) -> Vec<Panel>;
}

/// One row of results, of which the numbers become lines of a CSV file.
#[derive(Clone, Debug)]
pub struct ResultRow {
    /// Which study.
    pub study: &'static str,
    /// What was measured.
    pub scene: String,
    /// Whether Rapier recycled contacts; `None` where Rapier had no part.
    pub contact_recycling: Option<bool>,
    /// An object; its numbers, and those of the objects and lists in it, count.
    pub values: Value,
}

impl ResultRow {
    pub(super) fn new(study: &'static str, scene: String, values: &impl Serialize) -> Self {
        let values = serde_json::to_value(values).unwrap_or_default();
        Self { study, scene, contact_recycling: None, values }
    }

    /// For what has no `backend` or `hierarchy` of its own, but a name.
    pub(super) fn named(
        study: &'static str,
        scene: String,
        name: String,
        values: &impl Serialize,
    ) -> Self {
        let mut row = Self::new(study, scene, values);
        if let Some(values) = row.values.as_object_mut() {
            values.insert("backend".to_owned(), Value::String(name));
        }
        row
    }

    pub(super) fn recycling(self, contact_recycling: bool) -> Self {
        Self { contact_recycling: Some(contact_recycling), ..self }
    }
}

/// Writes all results as one JSON object.
///
/// Errors: the file cannot be written.
pub fn write_json(results: &impl Results, path: &Path) -> Result<(), ReportError> {
    let file = File::create(path).map_err(|cause| ReportError::new(path, cause))?;
    serde_json::to_writer_pretty(file, results).map_err(|cause| ReportError::new(path, cause))
}

/// One number in the CSV file.
#[derive(Debug, PartialEq, Serialize)]
struct Measurement {
    study: &'static str,
    scene: String,
    contact_recycling: Option<bool>,
    backend: String,
    quantity: String,
    statistic: String,
    value: f64,
}

/// Writes all results as CSV, one number a line: study, scene, backend, quantity, statistic, value.
///
/// Errors: the file cannot be written.
pub fn write_csv(results: &impl Results, path: &Path) -> Result<(), ReportError> {
    let mut writer = csv::Writer::from_path(path).map_err(|e| ReportError::new(path, e))?;
    for measurement in results.rows().iter().flat_map(measurements) {
        writer.serialize(measurement).map_err(|e| ReportError::new(path, e))?;
    }
    writer.flush().map_err(|e| ReportError::new(path, e))
}

/// Draws all results into an SVG picture.
///
/// Errors: the file cannot be written.
pub fn write_plot(results: &impl Results, path: &Path) -> Result<(), ReportError> {
    Panel::write_all(&results.panels(), path)
}

/// The numbers of a row: its own, and those of the objects and lists in it, whose statistic is then
/// the path to the number.
fn measurements(row: &ResultRow) -> Vec<Measurement> {
    let text = |key| row.values.get(key).and_then(Value::as_str);
    let backend = text("backend").or(text("hierarchy")).unwrap_or_default();
    let mut numbers = Vec::new();
    for (quantity, value) in row.values.as_object().into_iter().flatten() {
        let mut found = Vec::new();
        collect(value, String::new(), &mut found);
        numbers.extend(found.into_iter().map(|(statistic, value)| Measurement {
            study: row.study,
            scene: row.scene.clone(),
            contact_recycling: row.contact_recycling,
            backend: backend.to_owned(),
            quantity: quantity.clone(),
            statistic: if statistic.is_empty() { "value".to_owned() } else { statistic },
            value,
        }));
    }
    numbers
}

/// Adds the numbers in `value`, each with its path below `path`.
fn collect(value: &Value, path: String, found: &mut Vec<(String, f64)>) {
    let below = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
    for (key, value) in value.as_object().into_iter().flatten() {
        collect(value, below(key), found);
    }
    for (index, value) in value.as_array().into_iter().flatten().enumerate() {
        collect(value, below(&index.to_string()), found);
    }
    found.extend(value.as_f64().map(|number| (path, number)));
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    /// Would catch numbers lost on the way to the file, or attributed to another backend.
    #[test]
    fn every_number_becomes_a_line() {
        let values = json!({
            "backend": "sbbk",
            "steps": 3,
            "step": { "min": 1.5, "median": 2.0 },
            "steady": { "time": { "min": 0.5 } },
            "counts": [7, 8],
        });
        let row = ResultRow::new("study", "scene".to_owned(), &values).recycling(false);
        let lines = measurements(&row);
        let found: Vec<_> =
            lines.iter().map(|m| (&*m.backend, &*m.quantity, &*m.statistic, m.value)).collect();
        let expected = [
            ("sbbk", "counts", "0", 7.0),
            ("sbbk", "counts", "1", 8.0),
            ("sbbk", "steady", "time.min", 0.5),
            ("sbbk", "step", "median", 2.0),
            ("sbbk", "step", "min", 1.5),
            ("sbbk", "steps", "value", 3.0),
        ];
        assert_eq!(found, expected);
    }
}
