//! Rows of results.

use serde::Serialize;
use serde_json::{Map, Value};

/// Numbers of one backend about one question.
#[derive(Clone, Debug)]
pub struct Row {
    /// Part of the study.
    pub study: &'static str,
    /// Name of the backend.
    pub backend: String,
    /// The question: the mesh, its size, the motion.
    pub keys: Map<String, Value>,
    /// Numbers by name, and objects and lists of numbers.
    pub values: Map<String, Value>,
}

impl Row {
    /// Makes a row without keys and values.
    pub fn new(study: &'static str, backend: impl ToString) -> Self {
        Self { study, backend: backend.to_string(), keys: Map::new(), values: Map::new() }
    }

    /// Adds a key.
    pub fn key(mut self, name: &str, value: impl Into<Value>) -> Self {
        self.keys.insert(name.to_owned(), value.into());
        self
    }

    /// Adds a value. NaN becomes null.
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

    /// True if the backend or a key has this name.
    pub fn is(&self, key: &str, name: impl ToString) -> bool {
        let found = match key {
            "backend" => Some(&*self.backend),
            _ => self.get(key).and_then(Value::as_str),
        };
        found == Some(&*name.to_string())
    }

    /// The number at a path, or NaN.
    pub fn number(&self, path: &str) -> f64 {
        self.get(path).and_then(Value::as_f64).unwrap_or(f64::NAN)
    }

    pub fn count(&self, path: &str) -> u64 {
        self.get(path).and_then(Value::as_u64).unwrap_or(0)
    }

    /// Number of wrong contacts in the object at `path`.
    pub fn wrong(&self, path: &str) -> u64 {
        let kinds = ["missed", "phantom", "wrong_depth", "wrong_normal"];
        kinds.map(|kind| self.count(&format!("{path}.{kind}"))).into_iter().sum()
    }

    /// All keys as text: "mesh ball, size 2".
    pub fn scene(&self) -> String {
        let keys = self.keys.iter().map(|(name, value)| format!("{name} {}", text(value)));
        keys.collect::<Vec<_>>().join(", ")
    }

    /// All numbers, each with its quantity and the path below this quantity.
    pub(super) fn measurements(&self) -> Vec<(&str, String, f64)> {
        let measurements = self.values.iter().flat_map(|(quantity, value)| {
            let mut found = Vec::new();
            collect(value, String::new(), &mut found);
            found.into_iter().map(|(path, number)| {
                let statistic = if path.is_empty() { "value".to_owned() } else { path };
                (&**quantity, statistic, number)
            })
        });
        measurements.collect()
    }
}

/// Shows a value without quotation marks.
fn text(value: &Value) -> String {
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
