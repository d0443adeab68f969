//! A mesh against convex shapes of every kind and against a large floor: what queries cost, and
//! whether a contact is lost, stock Parry beside SBBK.
//!
//! ```text
//! cargo run --release --example convex
//! cargo run --release --example convex -- --quick --csv convex.csv --plot convex.svg
//! ```

use std::error::Error;
use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::cli::{Output, exit_code};
use sbbk_lab::report::{tables, write_convex_plot};
use sbbk_lab::study::Progress;
use sbbk_lab::study::convex::{ConvexPlan, convex};

/// Compares the contacts of a mesh and convex shapes, and their times.
#[derive(Parser)]
struct Arguments {
    /// Fewer poses and repeats: some seconds
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    output: Output,
}

fn main() -> ExitCode {
    exit_code(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let plan = if arguments.quick { ConvexPlan::quick() } else { ConvexPlan::standard() };
    arguments.output.reserve()?;
    let study = convex(&plan, &Progress::visible())?;
    let tables = [tables::convex(&study)];
    arguments.output.publish(&study, &study.environment, &tables, write_convex_plot)
}
