//! Results: rows, tables and files.

mod output;
mod row;
mod table;

use std::fmt;

use serde::Serialize;

pub(crate) use output::said_by;
pub use output::{ReportError, check_outputs, write_file};
pub use row::Row;
pub use table::{
    Column, Table, TableSpec, errors, faster, greater, number, sides, three_digits, time,
};

use crate::metrics::Environment;

/// Content of the columns of times.
pub const TIME_NOTE: &str =
    "times: min / median over the repeats, taken in turn; ratios: of minima, geometric means";
/// Content of the columns of errors.
pub const ERROR_NOTE: &str = "errors: missed + phantom + wrong depth, of the true triangle pairs \
                              judged, against brute force in f64";

/// Findings of a study.
#[derive(Clone, Debug, Serialize)]
pub struct Results {
    /// Machine and build.
    pub environment: Environment,
    /// The main finding, in one sentence.
    pub verdict: String,
    /// All numbers.
    pub rows: Vec<Row>,
    /// Some of the numbers, for the terminal.
    #[serde(skip)]
    pub tables: Vec<Table>,
}

impl Results {
    /// Findings of this machine.
    pub fn new(verdict: String, rows: Vec<Row>, tables: Vec<Table>) -> Self {
        Self { environment: Environment::detect(), verdict, rows, tables }
    }
}

impl fmt::Display for Results {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = table::wrapped(&format!("VERDICT: {}", self.verdict), "");
        writeln!(f, "{verdict}\n\n{}", self.environment)?;
        self.tables.iter().try_for_each(|table| write!(f, "\n{table}"))
    }
}
