//! Arguments, output and errors of the examples.

use crate::prelude::*;
use std::fmt::Display;
use std::io::{ErrorKind, Write};

use clap::{CommandFactory, FromArgMatches, Parser};

use crate::report::{check_output, write_file};

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

    /// Runs a study, prints the verdict and the tables, and writes the file.
    ///
    /// Returns the errors of the study. A file that cannot be written is an error before the study
    /// starts.
    pub fn run(&self, study: impl FnOnce(&Progress) -> io::Result<Results>) -> Outcome {
        if let Some(path) = &self.csv {
            check_output(path)?;
        }
        let results = study(&Progress::visible())?;
        show(&results, self.csv.as_deref())
    }
}

/// Prints the verdict and the tables, and writes the file, if any.
///
/// Errors: the file or the standard output cannot be written.
pub fn show(results: &Results, csv: Option<&Path>) -> Outcome {
    print(results)?;
    if let Some(path) = csv {
        write_file(path, results.csv())?;
        print(format_args!("wrote {}", path.display()))?;
    }
    Ok(())
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
    arguments.run(|progress| Ok(study(&plan, progress)))
}

/// Tells where the page of a replay is.
///
/// Errors: the standard output cannot be written.
pub fn print_page(page: &Path) -> io::Result<()> {
    print(format_args!("wrote {}: open it in a browser", page.display()))
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
pub type Outcome = anyhow::Result<()>;

/// Implements `Display` for choices of arguments, by their names there.
macro_rules! shown_by_name {
    ($($choice:ty),*) => {$(
        impl std::fmt::Display for $choice {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                let name = clap::ValueEnum::to_possible_value(self).expect("none is hidden");
                f.pad(name.get_name())
            }
        }
    )*};
}

shown_by_name!(
    crate::backend::Backend,
    crate::study::hard::Column,
    crate::study::hard::Group,
    crate::study::hard::random::Family
);
