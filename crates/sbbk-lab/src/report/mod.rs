//! Results as rows, and what is made of them: tables, files and plots.

mod files;
mod html;
mod plot;
mod row;
mod table;

use std::fmt;

use serde::Serialize;

pub use files::{ReportError, check_files, replace_file};
pub use html::{Section, write_html};
pub use plot::{Look, Panel, Scale};
pub use row::Row;
pub use table::{Column, Table, TableSpec, errors, faster, number, sides, time};

use crate::metrics::Environment;

/// What the columns of times hold.
pub const TIME_NOTE: &str = "times: min / median over the repeats, all in turn; ratios: of minima, \
                             geometric means in the lines of means";
/// What the columns of errors hold.
pub const ERROR_NOTE: &str = "errors: missed + phantom + wrong depth, of the true triangle pairs \
                              judged, against brute force in f64";

/// What a study found.
#[derive(Clone, Debug, Serialize)]
pub struct Results {
    /// Machine and build.
    pub environment: Environment,
    /// All numbers.
    pub rows: Vec<Row>,
    /// Some of them for the terminal.
    #[serde(skip)]
    pub tables: Vec<Table>,
    /// The picture, from left to right.
    #[serde(skip)]
    pub panels: Vec<Panel>,
}

impl Results {
    /// What was found on this machine.
    pub fn new(rows: Vec<Row>, tables: Vec<Table>, panels: Vec<Panel>) -> Self {
        Self { environment: Environment::detect(), rows, tables, panels }
    }

    /// All of them as those of one study; `None` if there are none.
    pub fn joined(all: impl IntoIterator<Item = Self>) -> Option<Self> {
        all.into_iter().reduce(|mut joined, other| {
            joined.rows.extend(other.rows);
            joined.tables.extend(other.tables);
            joined.panels.extend(other.panels);
            joined
        })
    }
}

impl fmt::Display for Results {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.environment)?;
        self.tables.iter().try_for_each(|table| write!(f, "\n\n{table}"))
    }
}
