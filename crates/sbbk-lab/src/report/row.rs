//! Rows of results.

use std::collections::BTreeMap;

use serde::Serialize;
use serde_json::Value;

/// Kinds of wrong contacts, as values of a row.
pub(super) const WRONG: [&str; 4] = ["missed", "phantom", "wrong_depth", "wrong_normal"];

/// Numbers of one backend about one question.
#[derive(Clone, Debug)]
pub struct Row {
    /// Part of the study.
    pub study: &'static str,
    /// Name of the backend.
    pub backend: String,
    /// The question: the mesh, its size, the motion.
    pub keys: BTreeMap<&'static str, String>,
    /// Numbers by path: a quantity, or one with a statistic, such as `time.min`.
    pub values: BTreeMap<String, f64>,
}

impl Row {
    /// Makes a row without keys and values.
    pub fn new(study: &'static str, backend: impl ToString) -> Self {
        let (keys, values) = Default::default();
        Self { study, backend: backend.to_string(), keys, values }
    }

    /// Adds a key.
    pub fn key(mut self, name: &'static str, value: impl ToString) -> Self {
        self.keys.insert(name, value.to_string());
        self
    }

    /// Adds all numbers of a value that are finite.
    pub fn with(mut self, name: &str, value: impl Serialize) -> Self {
        self.collect(name, &serde_json::to_value(value).unwrap_or_default());
        self
    }

    fn collect(&mut self, path: &str, value: &Value) {
        for (key, value) in value.as_object().into_iter().flatten() {
            self.collect(&format!("{path}.{key}"), value);
        }
        for (index, value) in value.as_array().into_iter().flatten().enumerate() {
            self.collect(&format!("{path}.{index}"), value);
        }
        self.values.extend(value.as_f64().map(|number| (path.to_owned(), number)));
    }

    /// The number at a path, or NaN.
    pub fn number(&self, path: &str) -> f64 {
        self.values.get(path).copied().unwrap_or(f64::NAN)
    }

    pub fn count(&self, path: &str) -> u64 {
        self.number(path) as u64
    }

    /// Number of wrong contacts at a path.
    pub fn wrong(&self, path: &str) -> u64 {
        WRONG.map(|kind| self.count(&format!("{path}.{kind}"))).into_iter().sum()
    }

    /// All keys as text: "mesh ball, size 2".
    pub fn scene(&self) -> String {
        let keys = self.keys.iter().map(|(name, value)| format!("{name} {value}"));
        keys.collect::<Vec<_>>().join(", ")
    }
}
