//! A mesh against convex shapes of every kind and against a large floor: what queries cost, and
//! whether a contact is lost, stock Parry beside SBBK.
//!
//! ```text
//! cargo run --release --example convex
//! cargo run --release --example convex -- --quick --csv convex.csv --plot convex.svg
//! ```

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::cli::{exit_code, print};
use sbbk_lab::report::{reserve, tables, write_convex_plot, write_csv, write_json};
use sbbk_lab::study::Progress;
use sbbk_lab::study::convex::{ConvexPlan, convex};

/// Compares the contacts of a mesh and convex shapes, and their times.
#[derive(Parser)]
struct Arguments {
    /// Fewer poses and repeats: some seconds
    #[arg(long)]
    quick: bool,
    /// Writes all numbers to a JSON file
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Writes all numbers to a CSV file, one a line
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Writes time against error to an SVG file
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
}

fn main() -> ExitCode {
    exit_code(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let plan = if arguments.quick { ConvexPlan::quick() } else { ConvexPlan::standard() };
    let Arguments { json, csv, plot, .. } = arguments;
    [json, csv, plot].into_iter().flatten().try_for_each(|path| reserve(path))?;
    let study = convex(&plan, &Progress::visible())?;
    print(&study.environment)?;
    print(format_args!("\n{}", tables::convex(&study)))?;
    if let Some(path) = json {
        write_json(&study, path)?;
    }
    if let Some(path) = csv {
        write_csv(&study, path)?;
    }
    if let Some(path) = plot {
        write_convex_plot(&study, path)?;
    }
    Ok(())
}
