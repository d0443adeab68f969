//! Contacts of mesh pairs at every scale: how many are right, and what they cost, stock Parry
//! beside SBBK.
//!
//! ```text
//! cargo run --release --example contacts
//! cargo run --release --example contacts -- --quick --csv contacts.csv --plot contacts.svg
//! ```

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::cli::{exit_code, print};
use sbbk_lab::report::{reserve, tables, write_contacts_plot, write_csv, write_json};
use sbbk_lab::study::Progress;
use sbbk_lab::study::contacts::{ContactsPlan, contacts};

/// Compares the contacts of stock Parry and SBBK with brute force, and their times.
#[derive(Parser)]
struct Arguments {
    /// Smaller meshes and fewer poses: half a minute instead of three
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
    let plan = if arguments.quick { ContactsPlan::quick() } else { ContactsPlan::standard() };
    let Arguments { json, csv, plot, .. } = arguments;
    [json, csv, plot].into_iter().flatten().try_for_each(|path| reserve(path))?;
    let contacts = contacts(&plan, &Progress::visible())?;
    print(&contacts.environment)?;
    for table in tables::contacts(&contacts) {
        print(format_args!("\n{table}"))?;
    }
    if let Some(path) = json {
        write_json(&contacts, path)?;
    }
    if let Some(path) = csv {
        write_csv(&contacts, path)?;
    }
    if let Some(path) = plot {
        write_contacts_plot(&contacts, path)?;
    }
    Ok(())
}
