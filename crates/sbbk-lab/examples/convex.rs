//! A mesh against convex shapes and compounds, stock Parry beside SBBK: wrong contacts, and times.
//!
//! ```text
//! cargo run --release --example convex
//! cargo run --release --example convex -- --quick --csv convex.csv
//! ```

use clap::Parser;
use sbbk_lab::cli::{Outcome, StudyArguments};
use sbbk_lab::study::convex::{ConvexPlan, convex};

/// Compares the contacts of a mesh and convex shapes or compounds, and their times
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
}

fn main() -> Outcome {
    let Arguments { study } = Arguments::parse();
    let plan = study.plan(ConvexPlan::standard, ConvexPlan::quick);
    study.run(None, None, |progress| Ok(convex(&plan, progress)))
}
