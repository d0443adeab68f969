//! Distance, intersection, contact and casts of two meshes: what they cost and how right they are,
//! stock Parry beside SBBK.
//!
//! ```text
//! cargo run --release --example queries
//! cargo run --release --example queries -- --quick --csv queries.csv
//! ```

use std::error::Error;
use std::fs::create_dir_all;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::cli::{StudyArguments, exit_code};
use sbbk_lab::study::queries::{QueriesPlan, export, queries};

/// Compares the queries of stock Parry and SBBK with brute force, and their times.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Writes meshes, poses, times and answers for `benches/coal_fcl/compare.py`
    #[arg(long, value_name = "DIR")]
    export: Option<PathBuf>,
}

fn main() -> ExitCode {
    exit_code(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let plan = arguments.study.plan(QueriesPlan::standard, QueriesPlan::quick);
    arguments.export.as_deref().map(create_dir_all).transpose()?;
    let found = arguments.study.run(None, None, |progress| Ok(queries(&plan, progress)))?;
    if let Some(folder) = &arguments.export {
        export(&plan, &found, folder)?;
    }
    Ok(())
}
