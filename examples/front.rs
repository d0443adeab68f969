//! What temporal coherence is worth: the paper's front, the adaptive one and the dispatcher's way,
//! beside fresh descents.
//!
//! ```text
//! cargo run --release --example front
//! cargo run --release --example front -- --quick --csv front.csv --plot front.svg
//! ```

use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::cli::{OtherFiles, StudyArguments, exit_code};
use sbbk_lab::study::front::{FrontPlan, front};

/// Compares descents that start where the last one stopped with fresh ones.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
}

fn main() -> ExitCode {
    let Arguments { study } = Arguments::parse();
    let plan = study.plan(FrontPlan::standard, FrontPlan::quick);
    exit_code(study.run(&plan, front, OtherFiles::default()))
}
