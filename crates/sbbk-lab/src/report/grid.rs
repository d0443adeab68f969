//! A table for the terminal.

use std::fmt;

use comfy_table::presets::ASCII_MARKDOWN;
use comfy_table::{CellAlignment, Table};

/// A titled table with notes below it. Text columns come first, and are aligned to the left.
#[derive(Clone, Debug, Default)]
pub struct Grid {
    /// What the table shows.
    pub title: String,
    /// Names of the columns.
    pub header: Vec<&'static str>,
    /// How many of the first columns are text.
    pub text_columns: usize,
    /// Cells, row by row.
    pub rows: Vec<Vec<String>>,
    /// What a reader must know.
    pub notes: Vec<String>,
}

impl fmt::Display for Grid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut table = Table::new();
        table.load_style(ASCII_MARKDOWN).set_header(&self.header);
        table.add_rows(&self.rows);
        for column in table.column_iter_mut().skip(self.text_columns) {
            column.set_cell_alignment(CellAlignment::Right);
        }
        write!(f, "{}\n{table}", self.title)?;
        self.notes.iter().try_for_each(|note| write!(f, "\n  {note}"))
    }
}
