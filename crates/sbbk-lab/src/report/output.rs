//! Result files.

use std::fs;
use std::path::Path;

use super::Results;
use super::environment::said_by;
use crate::error::StudyError;

/// Checks before a measurement that the outputs can be written after it.
///
/// Errors: a folder is missing, an output is a folder, an input, or another output.
pub fn check_outputs(inputs: &[&Path], outputs: &[&Path]) -> Result<(), StudyError> {
    for (index, output) in outputs.iter().enumerate() {
        let folder = output.parent().filter(|folder| !folder.as_os_str().is_empty());
        let cause = match () {
            () if !folder.unwrap_or(Path::new(".")).is_dir() => "the folder does not exist",
            () if output.is_dir() => "it is a folder",
            () if inputs.contains(output) || outputs[..index].contains(output) => {
                "another file of this run has this name"
            }
            () => continue,
        };
        return Err(StudyError::file("write", output, cause));
    }
    Ok(())
}

/// Writes a file.
///
/// Errors: the file cannot be written; the message names it.
pub fn write_file(path: &Path, contents: impl AsRef<[u8]>) -> Result<(), StudyError> {
    fs::write(path, contents).map_err(|cause| StudyError::file("write", path, cause))
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
            for (quantity, statistic, value) in row.measurements() {
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
