//! Result files.

use std::fs::{self, OpenOptions};
use std::path::Path;

use super::Results;
use super::environment::said_by;
use crate::error::FileError;

/// Checks before a measurement that its output can be written after it.
///
/// Errors: the file cannot be written; the message names it.
pub fn check_output(path: &Path) -> Result<(), FileError> {
    let file = OpenOptions::new().create(true).append(true).open(path);
    file.map(drop).map_err(|cause| FileError::new("write", path, cause))
}

/// Writes a file.
///
/// Errors: the file cannot be written; the message names it.
pub fn write_file(path: &Path, contents: impl AsRef<[u8]>) -> Result<(), FileError> {
    fs::write(path, contents).map_err(|cause| FileError::new("write", path, cause))
}

impl Results {
    /// All numbers as CSV, one a line, below comments with date, commit, machine and verdict.
    pub fn csv(&self) -> String {
        let commit = said_by("git", &["describe", "--always", "--dirty"]);
        let date = said_by("date", &["-u", "+%F"]);
        let mut text = format!(
            "# {date}, commit {commit}\n# {}\n# {}\n\
             study,scene,backend,quantity,statistic,value\n",
            self.environment, self.verdict
        );
        for row in &self.rows {
            let [study, scene, backend] = [row.study, &row.scene(), &row.backend].map(quoted);
            for (path, value) in &row.values {
                let (quantity, statistic) = path.split_once('.').unwrap_or((path, "value"));
                let value: f64 = format!("{value:.5e}").parse().unwrap_or(f64::NAN);
                text.push_str(&format!(
                    "{study},{scene},{backend},{},{statistic},{value}\n",
                    quoted(quantity)
                ));
            }
        }
        text
    }
}

fn quoted(cell: &str) -> String {
    match cell.contains([',', '"', '\n']) {
        true => format!("\"{}\"", cell.replace('"', "\"\"")),
        false => cell.to_owned(),
    }
}
