//! Distance, intersection, contact and casts of two meshes: what they cost and how right they are,
//! stock Parry beside SBBK.
//!
//! ```text
//! cargo run --release --example queries
//! cargo run --release --example queries -- --quick --csv queries.csv --plot queries.svg
//! ```

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::cli::{exit_code, print};
use sbbk_lab::report::{reserve, tables, write_csv, write_json, write_queries_plot};
use sbbk_lab::study::Progress;
use sbbk_lab::study::queries::{QueriesPlan, export, queries};

/// Compares the queries of stock Parry and SBBK with brute force, and their times.
#[derive(Parser)]
struct Arguments {
    /// Two small meshes and few poses
    #[arg(long)]
    quick: bool,
    /// Writes all numbers to a JSON file
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Writes all numbers to a CSV file, one a line
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Writes time against mesh size to an SVG file
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Writes meshes, poses, times and answers for `benches/coal_fcl/compare.py`
    #[arg(long, value_name = "DIR")]
    export: Option<PathBuf>,
}

fn main() -> ExitCode {
    exit_code(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let plan = if arguments.quick { QueriesPlan::quick() } else { QueriesPlan::standard() };
    let Arguments { json, csv, plot, .. } = arguments;
    [json, csv, plot].into_iter().flatten().try_for_each(|path| reserve(path))?;
    let found = queries(&plan, &Progress::visible())?;
    print(&found.environment)?;
    for table in tables::one_answer(&found) {
        print(format_args!("\n{table}"))?;
    }
    if let Some(path) = json {
        write_json(&found, path)?;
    }
    if let Some(path) = csv {
        write_csv(&found, path)?;
    }
    if let Some(path) = plot {
        write_queries_plot(&found, path)?;
    }
    if let Some(folder) = &arguments.export {
        export(&plan, &found, folder)?;
    }
    Ok(())
}
