//! What every example does around its work: printing, writing files, and ending without a panic.

use std::error::Error;
use std::fmt::Display;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;

use crate::backend::Backend;
use crate::replay;
use crate::report::{Results, check_files};
use crate::scene::Scene;
use crate::study::{Progress, StudyError};

/// What every study can be asked for.
#[derive(Args, Clone, Debug, Default)]
pub struct StudyArguments {
    /// Measures less, within a minute: for trying, not for quoting
    #[arg(long)]
    quick: bool,
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

impl StudyArguments {
    /// The plan that is wanted.
    pub fn plan<P>(&self, standard: fn() -> P, quick: fn() -> P) -> P {
        if self.quick { quick() } else { standard() }
    }

    /// Carries out a study under progress bars, prints what it found and writes the files. Before
    /// the work begins, they are tried together with the `others` that the run reads or writes.
    ///
    /// Errors: the output or a file cannot be written.
    pub fn run<P>(
        &self,
        plan: &P,
        study: impl FnOnce(&P, &Progress) -> Results,
        others: OtherFiles,
    ) -> Result<Results, Box<dyn Error>> {
        self.try_run(plan, |plan, progress| Ok(study(plan, progress)), others)
    }

    /// The same with a study that may fail.
    ///
    /// Errors: the study's own, or the output or a file cannot be written.
    pub fn try_run<P>(
        &self,
        plan: &P,
        study: impl FnOnce(&P, &Progress) -> Result<Results, StudyError>,
        others: OtherFiles,
    ) -> Result<Results, Box<dyn Error>> {
        let Self { json, csv, plot, .. } = self;
        let outputs = [json, csv, plot].into_iter().map(Option::as_deref).chain([others.written]);
        let outputs: Vec<&Path> = outputs.flatten().collect();
        check_files(others.read.as_slice(), &outputs)?;
        let results = study(plan, &Progress::visible())?;
        print(&results)?;
        json.as_deref().map(|path| results.write_json(path)).transpose()?;
        csv.as_deref().map(|path| results.write_csv(path)).transpose()?;
        plot.as_deref().map(|path| results.write_plot(path)).transpose()?;
        Ok(results)
    }
}

/// What every run of a scene can be asked for.
#[derive(Args, Clone, Debug, Default)]
pub struct ReplayArguments {
    /// Writes a page that plays a scene, the first of several, on backends side by side
    #[arg(long, value_name = "FILE")]
    pub replay: Option<PathBuf>,
}

impl ReplayArguments {
    /// Runs a scene on some backends and writes their page, if it is wanted.
    ///
    /// Errors: the file cannot be written.
    pub fn play(
        &self,
        scene: &dyn Scene,
        backends: &[Backend],
        steps: usize,
    ) -> Result<(), Box<dyn Error>> {
        let path = self.replay.as_deref();
        Ok(path.map_or(Ok(()), |path| replay::play(path, scene, backends, steps))?)
    }
}

/// Files of a run besides its results.
#[derive(Clone, Copy, Debug, Default)]
pub struct OtherFiles<'a> {
    /// A mesh or a robot.
    pub read: Option<&'a Path>,
    /// A page.
    pub written: Option<&'a Path>,
}

impl<'a> OtherFiles<'a> {
    /// The page of a replay.
    pub fn written(replay: &'a ReplayArguments) -> Self {
        Self { read: None, written: replay.replay.as_deref() }
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
