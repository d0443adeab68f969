//! Soft monkey heads fall on a rigid helicopter, stock beside SBBK.
//!
//! ```text
//! cargo run --release --example soft_heads
//! cargo run --release --example soft_heads -- --quick --replay soft.html
//! ```

use std::error::Error;
use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::backend::Backend;
use sbbk_lab::cli::{OtherFiles, ReplayArguments, StudyArguments, exit_code};
use sbbk_lab::scene::SoftHeads;
use sbbk_lab::study::soft::{SoftPlan, soft};

/// Measures soft heads on a helicopter.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    // Of heads that are softer than those that are measured.
    #[command(flatten)]
    replay: ReplayArguments,
}

fn main() -> ExitCode {
    exit_code(run(&Arguments::parse()))
}

fn run(Arguments { study, replay }: &Arguments) -> Result<(), Box<dyn Error>> {
    let plan = study.plan(SoftPlan::standard, SoftPlan::quick);
    study.run(&plan, soft, OtherFiles::written(replay))?;
    let softer = SoftHeads { stiffness: 4.0, seed: 3, ..SoftHeads::with_heads(4) };
    replay.play(&softer, &[Backend::Stock, Backend::Sbbk], plan.steps)
}
