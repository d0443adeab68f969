//! A mesh against convex shapes of every kind, compounds of them and a large floor, stock Parry
//! beside SBBK: what queries cost, and how many contacts are wrong, by brute force, at all sizes.
//!
//! ```text
//! cargo run --release --example convex
//! cargo run --release --example convex -- --quick --csv convex.csv --plot convex.svg
//! ```

use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::cli::{OtherFiles, StudyArguments, exit_code};
use sbbk_lab::study::convex::{ConvexPlan, convex};

/// Compares the contacts of a mesh and convex shapes or compounds, and their times.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
}

fn main() -> ExitCode {
    let Arguments { study } = Arguments::parse();
    let plan = study.plan(ConvexPlan::standard, ConvexPlan::quick);
    exit_code(study.run(&plan, convex, OtherFiles::default()))
}
