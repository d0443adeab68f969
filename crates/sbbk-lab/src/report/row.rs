//! One row of results.

use serde::Serialize;
use serde_json::{Map, Value};

/// What was measured, who answered, and the numbers.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Which part of which study.
    pub study: &'static str,
    /// Who answered: a backend, a hierarchy, a variant.
    pub backend: String,
    /// What was asked: the mesh, its size, the motion.
    #[serde(flatten)]
    pub keys: Map<String, Value>,
    /// Numbers by name, and objects and lists of numbers.
    #[serde(flatten)]
    pub values: Map<String, Value>,
}

/// One number in a CSV file.
#[derive(Debug, Serialize)]
pub(super) struct Measurement<'a> {
    study: &'a str,
    scene: String,
    contact_recycling: Option<bool>,
    backend: &'a str,
    quantity: &'a str,
    statistic: String,
    value: f64,
}

impl Row {
    /// A row without keys and values.
    pub fn new(study: &'static str, backend: impl ToString) -> Self {
        Self { study, backend: backend.to_string(), keys: Map::new(), values: Map::new() }
    }

    /// Adds a key.
    pub fn key(mut self, name: &str, value: impl Into<Value>) -> Self {
        self.keys.insert(name.to_owned(), value.into());
        self
    }

    /// Adds a value. NaN becomes nothing.
    pub fn with(mut self, name: &str, value: impl Serialize) -> Self {
        self.values.insert(name.to_owned(), serde_json::to_value(value).unwrap_or_default());
        self
    }

    /// The key or value at a path such as `time.min`.
    pub fn get(&self, path: &str) -> Option<&Value> {
        let mut names = path.split('.');
        let first = names.next()?;
        let found = self.keys.get(first).or_else(|| self.values.get(first))?;
        names.try_fold(found, |value, name| value.get(name))
    }

    /// Whether the backend or a key has this name.
    pub fn is(&self, key: &str, name: impl ToString) -> bool {
        let found = match key {
            "backend" => Some(&*self.backend),
            _ => self.get(key).and_then(Value::as_str),
        };
        found == Some(&*name.to_string())
    }

    /// The number at a path; NaN if there is none.
    pub fn number(&self, path: &str) -> f64 {
        self.get(path).and_then(Value::as_f64).unwrap_or(f64::NAN)
    }

    /// The count at a path; 0 if there is none.
    pub fn count(&self, path: &str) -> u64 {
        self.get(path).and_then(Value::as_u64).unwrap_or(0)
    }

    /// Wrong contacts of all kinds, of the object at `path`.
    pub fn wrong(&self, path: &str) -> u64 {
        let kinds = ["missed", "phantom", "wrong_depth", "wrong_normal"];
        kinds.map(|kind| self.count(&format!("{path}.{kind}"))).into_iter().sum()
    }

    /// Wrong contacts for each true one, of the object at `path`; `None` if there is no true one.
    pub fn error_share(&self, path: &str) -> Option<f64> {
        let true_pairs = self.number(&format!("{path}.true_pairs"));
        (true_pairs > 0.0).then(|| self.wrong(path) as f64 / true_pairs)
    }

    /// All numbers: the row's own, and those in its objects and lists, whose statistic is the path
    /// to the number.
    pub(super) fn measurements(&self) -> Vec<Measurement<'_>> {
        let keys = self.keys.iter().filter(|(name, _)| *name != "contact_recycling");
        let keys: Vec<String> =
            keys.map(|(name, value)| format!("{name} {}", text(value))).collect();
        let mut measurements = Vec::new();
        for (quantity, value) in &self.values {
            let mut found = Vec::new();
            collect(value, String::new(), &mut found);
            measurements.extend(found.into_iter().map(|(statistic, value)| Measurement {
                study: self.study,
                scene: keys.join(", "),
                contact_recycling: self.keys.get("contact_recycling").and_then(Value::as_bool),
                backend: &self.backend,
                quantity,
                statistic: if statistic.is_empty() { "value".to_owned() } else { statistic },
                value,
            }));
        }
        measurements
    }
}

/// A value without quotation marks.
pub(super) fn text(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
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

    /// Would catch numbers lost on the way to the file, or attributed to another scene or quantity.
    #[test]
    fn every_number_becomes_a_line() {
        let row = Row::new("study", "sbbk")
            .key("mesh", "ball")
            .key("contact_recycling", false)
            .with("steps", 3)
            .with("step", json!({ "min": 1.5, "median": 2.0 }))
            .with("counts", [7, 8])
            .with("steady", json!({ "time": { "min": 0.5 } }));
        let lines = row.measurements();
        assert!(lines.iter().all(|line| line.scene == "mesh ball" && line.backend == "sbbk"));
        assert!(lines.iter().all(|line| line.contact_recycling == Some(false)));
        let found: Vec<_> = lines.iter().map(|m| (m.quantity, &*m.statistic, m.value)).collect();
        let expected = [
            ("counts", "0", 7.0),
            ("counts", "1", 8.0),
            ("steady", "time.min", 0.5),
            ("step", "median", 2.0),
            ("step", "min", 1.5),
            ("steps", "value", 3.0),
        ];
        assert_eq!(found, expected);
        assert_eq!(row.number("steady.time.min"), 0.5);
    }
}
