//! What temporal coherence is worth: the parts of a front, one after the other, beside fresh descents.
//!
//! ```text
//! cargo run --release --example front
//! cargo run --release --example front -- --quick --csv front.csv --plot front.svg
//! ```

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::cli::{exit_code, print};
use sbbk_lab::report::{reserve, tables, write_csv, write_front_plot, write_json};
use sbbk_lab::study::Progress;
use sbbk_lab::study::front::{FrontPlan, front};

/// Compares descents that start where the last one stopped with fresh ones.
#[derive(Parser)]
struct Arguments {
    /// Fewer meshes and repeats: a quarter of a minute instead of two
    #[arg(long)]
    quick: bool,
    /// Writes all numbers to a JSON file
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Writes all numbers to a CSV file, one a line
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Writes the times of the variants to an SVG file
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
}

fn main() -> ExitCode {
    exit_code(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let plan = if arguments.quick { FrontPlan::quick() } else { FrontPlan::standard() };
    let Arguments { json, csv, plot, .. } = arguments;
    [json, csv, plot].into_iter().flatten().try_for_each(|path| reserve(path))?;
    let study = front(&plan, &Progress::visible())?;
    print(&study.environment)?;
    for table in tables::front(&study) {
        print(format_args!("\n{table}"))?;
    }
    if let Some(path) = json {
        write_json(&study, path)?;
    }
    if let Some(path) = csv {
        write_csv(&study, path)?;
    }
    if let Some(path) = plot {
        write_front_plot(&study, path)?;
    }
    Ok(())
}
