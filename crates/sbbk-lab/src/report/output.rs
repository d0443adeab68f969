//! Result files.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

use thiserror::Error;

use super::Results;

/// A file cannot be written.
#[derive(Debug, Error)]
#[error("cannot write `{}`: {cause}", path.display())]
pub struct ReportError {
    path: PathBuf,
    cause: String,
}

impl ReportError {
    fn new(path: &Path, cause: impl ToString) -> Self {
        Self { path: path.to_owned(), cause: cause.to_string() }
    }
}

/// Checks before a measurement that the outputs can be written after it.
///
/// Errors: a folder is missing, an output is a folder, an input, or another output.
pub fn check_outputs(inputs: &[&Path], outputs: &[&Path]) -> Result<(), ReportError> {
    for (index, output) in outputs.iter().enumerate() {
        let folder = output.parent().filter(|folder| !folder.as_os_str().is_empty());
        if !folder.unwrap_or(Path::new(".")).is_dir() {
            return Err(ReportError::new(output, "the folder does not exist"));
        }
        if output.is_dir() {
            return Err(ReportError::new(output, "it is a folder"));
        }
        if inputs.contains(output) || outputs[..index].contains(output) {
            return Err(ReportError::new(output, "another file of this run has this name"));
        }
    }
    Ok(())
}

/// Writes a file.
///
/// Errors: the file cannot be written; the message names it.
pub fn write_file(path: &Path, contents: impl AsRef<[u8]>) -> Result<(), ReportError> {
    fs::write(path, contents).map_err(|cause| ReportError::new(path, cause))
}

impl Results {
    /// All results as one JSON object.
    pub fn json(&self) -> String {
        serde_json::to_string_pretty(self).expect("all keys of the results are text")
    }

    /// All numbers as CSV, one a line, below comments with date, commit, machine and verdict.
    pub fn csv(&self) -> String {
        let mut text = format!(
            "# {}, commit {}\n# {}\n# {}\n",
            date(),
            commit(),
            self.environment,
            self.verdict
        );
        text.push_str("study,scene,contact_recycling,backend,quantity,statistic,value\n");
        for row in &self.rows {
            let recycling = row.keys.get("contact_recycling").map(ToString::to_string);
            for (quantity, statistic, value) in row.measurements() {
                let cells = [
                    quoted(row.study),
                    quoted(&row.scene()),
                    recycling.clone().unwrap_or_default(),
                    quoted(&row.backend),
                    quoted(quantity),
                    statistic,
                    six_digits(value).to_string(),
                ];
                text.push_str(&cells.join(","));
                text.push('\n');
            }
        }
        text
    }
}

fn six_digits(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(f64::NAN)
}

fn quoted(cell: &str) -> String {
    match cell.contains([',', '"', '\n']) {
        true => format!("\"{}\"", cell.replace('"', "\"\"")),
        false => cell.to_owned(),
    }
}

/// The commit of the working directory, with `-dirty` if files were changed.
fn commit() -> String {
    let output = Command::new("git").args(["describe", "--always", "--dirty"]).output();
    let text = output.ok().and_then(|output| String::from_utf8(output.stdout).ok());
    text.map_or_else(String::new, |text| text.trim().to_owned())
}

/// Today in UTC, as `2026-11-24` (H. Hinnant, "chrono-compatible low-level date algorithms").
fn date() -> String {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs());
    let days = seconds / 86_400 + 719_468;
    let (era, day_of_era) = (days / 146_097, days % 146_097);
    let year_of_era =
        (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * shifted + 2) / 5 + 1;
    let month = if shifted < 10 { shifted + 3 } else { shifted - 9 };
    let year = year_of_era + era * 400 + u64::from(month <= 2);
    format!("{year}-{month:02}-{day:02}")
}
