//! Everyday scenes, stock Rapier beside SBBK: bodies on mesh terrains, single bodies, sensors,
//! characters, robots, and queries without a workspace.
//!
//! ```text
//! cargo run --release --example everyday
//! cargo run --release --example everyday -- --quick --csv everyday.csv
//! cargo run --release --example everyday -- --quick --only sensors,queries
//! ```

use clap::Parser;
use sbbk_lab::cli::{Outcome, StudyArguments};
use sbbk_lab::study::everyday::{EverydayPlan, Group, everyday};

/// Compares times, memory and contacts in everyday scenes
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Measures only these parts
    #[arg(long, value_name = "PARTS", value_delimiter = ',')]
    only: Vec<Group>,
}

fn main() -> Outcome {
    let Arguments { study, only } = Arguments::parse();
    let mut plan = study.plan(EverydayPlan::standard, EverydayPlan::quick);
    if !only.is_empty() {
        plan.groups = only;
    }
    study.run(|progress| Ok(everyday(&plan, progress)))
}
