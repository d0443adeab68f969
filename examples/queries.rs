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
use sbbk_lab::cli::{Output, exit_code};
use sbbk_lab::report::{tables, write_queries_plot};
use sbbk_lab::study::Progress;
use sbbk_lab::study::queries::{QueriesPlan, export, queries};

/// Compares the queries of stock Parry and SBBK with brute force, and their times.
#[derive(Parser)]
struct Arguments {
    /// Two small meshes and few poses
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    output: Output,
    /// Writes meshes, poses, times and answers for `benches/coal_fcl/compare.py`
    #[arg(long, value_name = "DIR")]
    export: Option<PathBuf>,
}

fn main() -> ExitCode {
    exit_code(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let plan = if arguments.quick { QueriesPlan::quick() } else { QueriesPlan::standard() };
    arguments.output.reserve()?;
    let found = queries(&plan, &Progress::visible())?;
    let tables = tables::one_answer(&found);
    arguments.output.publish(&found, &found.environment, &tables, write_queries_plot)?;
    if let Some(folder) = &arguments.export {
        export(&plan, &found, folder)?;
    }
    Ok(())
}
