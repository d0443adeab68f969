//! Results as tables, files and plots, beside the paper's own.

mod error;
mod files;
mod format;
mod grid;
mod look;
mod panel;
mod paper;
mod plot;
pub mod tables;

pub use error::ReportError;
pub use files::{reserve, write_csv, write_json};
pub use grid::Grid;
pub use paper::{PAPER, Paper};
pub use plot::write_plot;
