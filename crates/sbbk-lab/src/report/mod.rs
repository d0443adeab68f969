//! Results as tables, files and plots, beside the paper's own.

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
mod plot;
mod queries;
pub mod tables;
mod terrain;

pub use contacts::write_contacts_plot;
pub use convex::write_convex_plot;
pub use error::ReportError;
pub use files::{ResultRow, Results, reserve, write_csv, write_json};
pub use front::write_front_plot;
pub use grid::Grid;
pub use paper::{PAPER, Paper};
pub use plot::write_plot;
pub use queries::write_queries_plot;
