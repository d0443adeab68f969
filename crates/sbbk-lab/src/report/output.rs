//! Result files, and machine and build of a measurement.

use std::env::consts::ARCH;
use std::fmt::Display;
use std::fs::{self, OpenOptions};
use std::io;
use std::path::Path;
use std::process::Command;

use super::{Results, Row};
use crate::parallel::threads;

/// Says what could not be done with a file, and why.
pub(crate) fn file_error(task: &str, path: &Path, cause: impl Display) -> io::Error {
    io::Error::other(format!("cannot {task} {}: {cause}", path.display()))
}

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

/// Processor, threads, compiler, profile and vector instructions of this process.
pub(super) fn environment() -> String {
    let info = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find(|line| line.starts_with("model name"));
    let model = model.and_then(|line| Some(line.split_once(':')?.1.trim()));
    let rapier = if cfg!(feature = "parallel") { "on its threads" } else { "on one thread" };
    // The compiler in the path, which built this program if nothing was changed since.
    let rustc = said_by("rustc", &["--version"]);
    let profile = if cfg!(debug_assertions) { "debug assertions" } else { "release" };
    let simd = match () {
        () if cfg!(target_feature = "avx512f") => "avx512f",
        () if cfg!(target_feature = "avx2") => "avx2",
        () if cfg!(target_feature = "sse2") => "sse2",
        () if cfg!(target_feature = "neon") => "neon",
        () => "no simd",
    };
    let (cpu, cores) = (model.unwrap_or(ARCH), threads());
    format!("{cpu}, {cores} cores; Rapier {rapier}; {rustc}; {profile}, {simd}")
}

/// Returns what a program prints. Empty if there is no such program.
fn said_by(program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).output();
    let text = output.ok().and_then(|output| String::from_utf8(output.stdout).ok());
    text.map_or_else(String::new, |text| text.trim().to_owned())
}
