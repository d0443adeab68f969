//! Arguments, output and errors of the examples.

use crate::prelude::*;
use std::error::Error;
use std::fmt::{self, Debug, Display};
use std::io::{self, ErrorKind, Write};

use clap::{Args, CommandFactory, FromArgMatches, Parser};

use crate::report::{check_outputs, write_file};

/// Arguments of every study.
#[derive(Clone, Debug, Default, Parser)]
pub struct StudyArguments {
    /// Measures less, within a minute: for trying, not for quoting
    #[arg(long)]
    quick: bool,
    /// Writes all numbers to a CSV file, one a line
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
}

impl StudyArguments {
    /// Chooses the plan.
    pub fn plan<P>(&self, standard: fn() -> P, quick: fn() -> P) -> P {
        if self.quick { quick() } else { standard() }
    }

    /// Runs a study, prints the verdict and the tables, and writes the file. `read` and
    /// `page` are other files of the run.
    ///
    /// Errors: those of the study; a file that cannot be written, which is found before the study.
    pub fn run(
        &self,
        read: Option<&Path>,
        page: Option<&Path>,
        study: impl FnOnce(&Progress) -> Result<Results, StudyError>,
    ) -> Outcome {
        let csv = self.csv.as_deref();
        let outputs: Vec<&Path> = csv.into_iter().chain(page).collect();
        check_outputs(read.as_slice(), &outputs)?;
        let progress = Progress::visible();
        let results = study(&progress)?;
        progress.finish();
        print(&results)?;
        if let Some(path) = csv {
            write_file(path, results.csv())?;
            print_path(path)?;
        }
        Ok(())
    }
}

/// Arguments of every run of a scene.
#[derive(Args, Clone, Debug, Default)]
pub struct ReplayArguments {
    /// Writes a page that plays a scene, the first of several, on backends side by side
    #[arg(long, value_name = "FILE")]
    pub replay: Option<PathBuf>,
}

impl ReplayArguments {
    /// Runs a scene on some backends and writes their page, if `--replay` was given.
    ///
    /// Errors: the file cannot be written.
    pub fn play(&self, scene: &dyn Scene, backends: &[Backend], steps: usize) -> Outcome {
        let Some(path) = &self.replay else { return Ok(()) };
        let progress = Progress::visible();
        replay::play(path, scene, backends, steps, &progress)?;
        progress.finish();
        self.print()
    }

    /// Prints the path of the page, if `--replay` was given.
    ///
    /// Errors: the standard output cannot be written.
    pub fn print(&self) -> Outcome {
        Ok(self.replay.as_deref().map_or(Ok(()), print_path)?)
    }
}

/// Is the `main` of a study without arguments of its own.
///
/// Errors: those of [`StudyArguments::run`].
pub fn run_study<P>(
    about: &'static str,
    standard: fn() -> P,
    quick: fn() -> P,
    study: fn(&P, &Progress) -> Results,
) -> Outcome {
    let matches = StudyArguments::command().about(about).get_matches();
    let arguments = StudyArguments::from_arg_matches(&matches)?;
    let plan = arguments.plan(standard, quick);
    arguments.run(None, None, |progress| Ok(study(&plan, progress)))
}

fn print_path(path: &Path) -> io::Result<()> {
    let hint =
        if path.extension().is_some_and(|e| e == "html") { ": open it in a browser" } else { "" };
    print(format_args!("wrote {}{hint}", path.display()))
}

/// Prints a line. A closed pipe, as in `compare | head`, is no error.
///
/// Errors: the standard output cannot be written.
pub fn print(text: impl Display) -> io::Result<()> {
    match writeln!(io::stdout(), "{text}") {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}

/// What `main` returns.
pub type Outcome = Result<(), Failure>;

/// An error, of which the message is shown.
pub struct Failure(Box<dyn Error>);

impl<E: Error + 'static> From<E> for Failure {
    fn from(error: E) -> Self {
        Self(Box::new(error))
    }
}

impl Debug for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Display::fmt(&self.0, f)
    }
}
