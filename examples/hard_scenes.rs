//! Hard scenes, stock Rapier beside SBBK: stacks, piles, gears, bodies that start in each other,
//! sheets. Does each end as a user expects?
//!
//! ```text
//! cargo run --release --example hard_scenes
//! cargo run --release --example hard_scenes -- --quick --csv hard.csv
//! cargo run --release --example hard_scenes -- --only gears,sunk --backends stock,sbbk --verbose
//! cargo run --release --example hard_scenes -- --quick --only gears --replay gears.html
//! ```

use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::cli::{OtherFiles, ReplayArguments, StudyArguments, exit_code};
use sbbk_lab::study::hard::{Column, Group, HardPlan, hard};

/// Runs difficult scenes of meshes to their end, and judges them.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Runs only these scenes
    #[arg(long, value_name = "SCENES", value_delimiter = ',')]
    only: Vec<Group>,
    /// Runs only these columns
    #[arg(long, value_name = "COLUMNS", value_delimiter = ',')]
    backends: Vec<Column>,
    /// Runs only scenes with this in their names
    #[arg(long, value_name = "TEXT", default_value = "")]
    scene: String,
    #[command(flatten)]
    replay: ReplayArguments,
    /// Shows all figures of all scenes
    #[arg(long)]
    verbose: bool,
    /// Runs so many worlds at once
    #[arg(long, default_value = "2")]
    threads: usize,
}

fn main() -> ExitCode {
    let Arguments { study, only, backends, scene, replay, verbose, threads } = Arguments::parse();
    let mut plan = study.plan(HardPlan::standard, HardPlan::quick);
    if !only.is_empty() {
        plan.groups = only;
    }
    if !backends.is_empty() {
        plan.columns = backends;
    }
    plan.shows_figures = verbose;
    plan.threads = threads;
    plan.name = scene;
    plan.replay = replay.replay.clone();
    exit_code(study.try_run(&plan, hard, OtherFiles::written(&replay)))
}
