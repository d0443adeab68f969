//! Results: rows, tables and files.

mod bars;
mod output;
mod row;
mod tables;

use std::fmt;

pub(crate) use output::file_error;
pub use output::{check_output, write_file};
pub use row::Row;
pub use tables::{Table, tables, three_digits};

/// Findings of a study.
#[derive(Clone, Debug)]
pub struct Results {
    /// Name of the data of the study, by which the documentation asks for them.
    pub study: &'static str,
    /// Machine and build.
    pub environment: String,
    /// The main finding, in one sentence.
    pub verdict: String,
    /// All numbers.
    pub rows: Vec<Row>,
    /// What tables do not show.
    pub notes: Vec<String>,
}

impl Results {
    /// Findings of this machine, with the verdict that the documentation describes, if any.
    pub fn new(study: &'static str, rows: Vec<Row>) -> Self {
        let (environment, verdict) =
            (output::environment(), tables::verdict(study, &output::numbers(&rows)));
        Self { study, environment, verdict, rows, notes: Vec::new() }
    }
}

impl fmt::Display for Results {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "VERDICT: {}\n\n{}", self.verdict, self.environment)?;
        let numbers = output::numbers(&self.rows);
        tables(self.study, &numbers).iter().try_for_each(|table| write!(f, "\n{table}"))?;
        write!(f, "{}", tables::picture(self.study, &numbers))?;
        let mut notes = self.notes.iter();
        notes.try_for_each(|note| write!(f, "\n{note}"))
    }
}
