//! Which layers of trees should be k-DOPs: fixed plans beside the default one, on meshes of different
//! kinds.
//!
//! ```text
//! cargo run --release --example layers
//! cargo run --release --example layers -- --quick --csv layers.csv
//! ```

use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::cli::{OtherFiles, StudyArguments, exit_code};
use sbbk_lab::study::layers::{LayersPlan, layers};

/// Compares plans of layers.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
}

fn main() -> ExitCode {
    let Arguments { study } = Arguments::parse();
    let plan = study.plan(LayersPlan::standard, LayersPlan::quick);
    exit_code(study.run(&plan, layers, OtherFiles::default()))
}
