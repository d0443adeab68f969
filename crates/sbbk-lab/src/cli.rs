//! What every example does around its work: printing, writing files, and ending without a panic.

use std::error::Error;
use std::fmt::Display;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;

use crate::metrics::Environment;
use crate::report::{Grid, ReportError, Results, reserve, write_csv, write_json};

/// Files for the results of a study.
#[derive(Args, Clone, Debug, Default)]
pub struct Output {
    /// Writes all numbers to a JSON file
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Writes all numbers to a CSV file, one a line
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Draws the results into an SVG file
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
}

impl Output {
    /// Makes sure, before the work begins, that the files can be written.
    ///
    /// Errors: one cannot.
    pub fn reserve(&self) -> Result<(), ReportError> {
        let Self { json, csv, plot } = self;
        [json, csv, plot].into_iter().flatten().try_for_each(|path| reserve(path))
    }

    /// Prints where and what was measured, and writes the files; `plot` draws the picture.
    ///
    /// Errors: the output or a file cannot be written.
    pub fn publish<R: Results>(
        &self,
        results: &R,
        environment: &Environment,
        tables: &[Grid],
        plot: impl FnOnce(&R, &Path) -> Result<(), ReportError>,
    ) -> Result<(), Box<dyn Error>> {
        print(environment)?;
        for table in tables {
            print(format_args!("\n{table}"))?;
        }
        if let Some(path) = &self.json {
            write_json(results, path)?;
        }
        if let Some(path) = &self.csv {
            write_csv(results, path)?;
        }
        if let Some(path) = &self.plot {
            plot(results, path)?;
        }
        Ok(())
    }
}

/// Prints a line. A reader that has gone away, as in `compare | head`, is no error.
///
/// Errors: the standard output cannot be written.
pub fn print(text: impl Display) -> io::Result<()> {
    match writeln!(io::stdout(), "{text}") {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}

/// The exit code of a program: 1 after printing the error, if there is one.
pub fn exit_code(result: Result<(), Box<dyn Error>>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
