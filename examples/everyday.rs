//! Everyday scenes, stock Rapier beside SBBK: bodies on mesh terrains, single bodies, sensors,
//! characters, queries without a workspace. Where does the one line cost time or memory?
//!
//! ```text
//! cargo run --release --example everyday
//! cargo run --release --example everyday -- --quick --csv everyday.csv --plot everyday.svg
//! ```

use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::cli::{OtherFiles, StudyArguments, exit_code};
use sbbk_lab::study::everyday::{EverydayPlan, everyday};

/// Compares times, memory and contacts in everyday scenes.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
}

fn main() -> ExitCode {
    let Arguments { study } = Arguments::parse();
    let plan = study.plan(EverydayPlan::standard, EverydayPlan::quick);
    exit_code(study.run(&plan, everyday, OtherFiles::default()))
}
