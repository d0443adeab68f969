//! Result files.

use std::fs::{self, OpenOptions};
use std::io;
use std::path::Path;

use super::environment::said_by;
use super::{Results, Row};
use crate::error::file_error;

/// Checks before a measurement that its output can be written after it.
///
/// Errors: the file cannot be written; the message names it.
pub fn check_output(path: &Path) -> io::Result<()> {
    let file = OpenOptions::new().create(true).append(true).open(path);
    file.map(drop).map_err(|cause| file_error("write", path, cause))
}

/// Writes a file.
///
/// Errors: the file cannot be written; the message names it.
pub fn write_file(path: &Path, contents: impl AsRef<[u8]>) -> io::Result<()> {
    fs::write(path, contents).map_err(|cause| file_error("write", path, cause))
}

impl Results {
    /// All numbers as CSV, one a line, below comments with date, commit, machine and verdict.
    pub fn csv(&self) -> String {
        let commit = said_by("git", &["describe", "--always", "--dirty"]);
        let date = said_by("date", &["-u", "+%F"]);
        let Self { environment, verdict, rows, .. } = self;
        let numbers = numbers(rows);
        format!("# {date}, commit {commit}\n# {environment}\n# {verdict}\n{numbers}")
    }
}

/// All numbers of rows as CSV, one a line, below a header.
pub(super) fn numbers(rows: &[Row]) -> String {
    let mut text = "study,scene,backend,quantity,statistic,value\n".to_owned();
    for row in rows {
        let [study, scene, backend] = [row.study, &row.scene(), &row.backend].map(quoted);
        for (path, value) in &row.values {
            let (quantity, statistic) = path.split_once('.').unwrap_or((path, "value"));
            let value: f64 = format!("{value:.5e}").parse().unwrap_or(f64::NAN);
            let quantity = quoted(quantity);
            text += &format!("{study},{scene},{backend},{quantity},{statistic},{value}\n");
        }
    }
    text
}

fn quoted(cell: &str) -> String {
    match cell.contains([',', '"', '\n']) {
        true => format!("\"{}\"", cell.replace('"', "\"\"")),
        false => cell.to_owned(),
    }
}
