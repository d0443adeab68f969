//! Results as tables, files and plots, beside the paper's own.

mod against;
mod comparison;
mod contacts;
mod convex;
mod error;
mod files;
mod format;
mod front;
mod grid;
mod look;
mod panel;
mod paper;
mod queries;
mod soft;
pub mod tables;
mod terrain;

pub use error::ReportError;
pub use files::{ResultRow, Results, reserve, write_csv, write_json, write_plot};
pub use grid::Grid;
pub use look::Look;
pub use panel::{Panel, Scale, Series};
pub use paper::{PAPER, Paper};
