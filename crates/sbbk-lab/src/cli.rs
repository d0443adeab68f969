//! What every example does around its work: printing, writing files, and ending without a panic.

use std::error::Error;
use std::fmt::Display;
use std::io::{self, ErrorKind, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;

use crate::report::{ReportError, Results, reserve, write_csv, write_json, write_plot};
use crate::study::{Progress, StudyError};

/// What every study can be asked for.
#[derive(Args, Clone, Debug, Default)]
pub struct StudyArguments {
    /// Measures less, within half a minute: for trying, not for quoting
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    output: Output,
}

impl StudyArguments {
    /// The plan that is wanted.
    pub fn plan<P>(&self, standard: fn() -> P, quick: fn() -> P) -> P {
        if self.quick { quick() } else { standard() }
    }

    /// Carries out a study under progress bars, prints what it found and writes the files, which
    /// are tried before the work begins.
    ///
    /// Errors: the study's own, or the output or a file cannot be written.
    pub fn run<P, R: Results>(
        &self,
        plan: &P,
        study: impl FnOnce(&P, &Progress) -> Result<R, StudyError>,
    ) -> Result<R, Box<dyn Error>> {
        self.output.reserve()?;
        let results = study(plan, &Progress::visible())?;
        self.output.publish(&results)?;
        Ok(results)
    }
}

/// Files for the results of a study.
#[derive(Args, Clone, Debug, Default)]
struct Output {
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
    fn reserve(&self) -> Result<(), ReportError> {
        let Self { json, csv, plot } = self;
        [json, csv, plot].into_iter().flatten().try_for_each(|path| reserve(path))
    }

    /// Prints where and what was measured, and writes the files.
    fn publish(&self, results: &impl Results) -> Result<(), Box<dyn Error>> {
        print(results.environment())?;
        for table in results.tables() {
            print(format_args!("\n{table}"))?;
        }
        if let Some(path) = &self.json {
            write_json(results, path)?;
        }
        if let Some(path) = &self.csv {
            write_csv(results, path)?;
        }
        if let Some(path) = &self.plot {
            write_plot(results, path)?;
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
pub fn exit_code<T>(result: Result<T, Box<dyn Error>>) -> ExitCode {
    match result {
        Ok(_) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
