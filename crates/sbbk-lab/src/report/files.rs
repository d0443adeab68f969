//! Results for other programs.

use std::fs::File;
use std::path::Path;

use serde::Serialize;
use serde_json::Value;

use super::ReportError;
use crate::study::Comparison;

/// Creates an empty file, so that a path that cannot be written is noticed before the measurement
/// that is to be written there.
///
/// Errors: the file cannot be created.
pub fn reserve(path: &Path) -> Result<(), ReportError> {
    File::create(path).map_err(|cause| ReportError::new(path, cause))?;
    Ok(())
}

/// Writes all results as one JSON object.
///
/// Errors: the file cannot be written.
pub fn write_json(comparison: &Comparison, path: &Path) -> Result<(), ReportError> {
    let file = File::create(path).map_err(|cause| ReportError::new(path, cause))?;
    serde_json::to_writer_pretty(file, comparison).map_err(|cause| ReportError::new(path, cause))
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
pub fn write_csv(comparison: &Comparison, path: &Path) -> Result<(), ReportError> {
    let mut writer = csv::Writer::from_path(path).map_err(|e| ReportError::new(path, e))?;
    for measurement in measurements(comparison) {
        writer.serialize(measurement).map_err(|e| ReportError::new(path, e))?;
    }
    writer.flush().map_err(|e| ReportError::new(path, e))
}

fn measurements(comparison: &Comparison) -> Vec<Measurement> {
    let mut all = Vec::new();
    let mut add = |study, scene: String, contact_recycling, row: Value| {
        all.extend(numbers(study, scene, contact_recycling, row));
    };
    for row in &comparison.helicopter {
        add("helicopter", format!("{} ball", row.ball), Some(true), json(row));
    }
    for pile in &comparison.piles {
        for row in &pile.runs {
            add("pile, whole runs", pile.scene.clone(), Some(pile.contact_recycling), json(row));
        }
        for row in &pile.same_poses {
            add("pile, same poses", pile.scene.clone(), None, json(row));
        }
    }
    for row in comparison.cut.iter().flat_map(|cut| &cut.rows) {
        add("cut at depth", "mesh ball".to_owned(), None, json(row));
    }
    for row in &comparison.meshes {
        add("trees and first queries", row.mesh.clone(), None, json(row));
    }
    all
}

fn json(row: &impl Serialize) -> Value {
    serde_json::to_value(row).unwrap_or_default()
}

/// The numbers of a row: its own, and those of the objects in it.
fn numbers(
    study: &'static str,
    scene: String,
    contact_recycling: Option<bool>,
    row: Value,
) -> Vec<Measurement> {
    let text = |key| row.get(key).and_then(Value::as_str);
    let backend = text("backend").or(text("hierarchy")).unwrap_or_default().to_owned();
    let mut numbers = Vec::new();
    for (quantity, value) in row.as_object().into_iter().flatten() {
        let own = value.as_f64().map(|value| ("value", value));
        let nested = value.as_object().into_iter().flatten();
        let nested = nested.filter_map(|(key, value)| Some((key.as_str(), value.as_f64()?)));
        numbers.extend(own.into_iter().chain(nested).map(|(statistic, value)| Measurement {
            study,
            scene: scene.clone(),
            contact_recycling,
            backend: backend.clone(),
            quantity: quantity.clone(),
            statistic: statistic.to_owned(),
            value,
        }));
    }
    numbers
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    /// Would catch numbers lost on the way to the file, or attributed to another backend.
    #[test]
    fn every_number_becomes_a_line() {
        let row = json!({
            "backend": "sbbk",
            "steps": 3,
            "step": { "min": 1.5, "median": 2.0 },
        });
        let lines = numbers("study", "scene".to_owned(), Some(false), row);
        let found: Vec<_> =
            lines.iter().map(|m| (&*m.backend, &*m.quantity, &*m.statistic, m.value)).collect();
        let expected = [
            ("sbbk", "step", "median", 2.0),
            ("sbbk", "step", "min", 1.5),
            ("sbbk", "steps", "value", 3.0),
        ];
        assert_eq!(found, expected);
    }
}
