//! Hard scenes, stock Rapier beside SBBK: stacks, piles, gears, bodies that start in each other,
//! sheets. Each is judged by figures with limits.
//!
//! ```text
//! cargo run --release --example hard_scenes
//! cargo run --release --example hard_scenes -- --quick --csv hard.csv
//! cargo run --release --example hard_scenes -- --only gears,sunk --backends stock,sbbk --verbose
//! cargo run --release --example hard_scenes -- --quick --only gears --replay gears.html
//! cargo run --release --example hard_scenes -- --quick --only pile --mesh bunny.obj
//! ```

use std::path::PathBuf;

use clap::Parser;
use sbbk_lab::cli::{Outcome, ReplayArguments, StudyArguments};
use sbbk_lab::mesh_file;
use sbbk_lab::study::hard::{Column, Group, HardPlan, hard};

/// Runs difficult scenes of meshes to their end, and judges them
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
    /// Body of the piles: an OBJ or STL file instead of the built-in monkey
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    #[command(flatten)]
    replay: ReplayArguments,
    /// Shows all figures of all scenes
    #[arg(long)]
    verbose: bool,
    /// Runs so many worlds at once
    #[arg(long, default_value = "2")]
    threads: usize,
}

fn main() -> Outcome {
    let arguments = Arguments::parse();
    let Arguments { study, only, backends, scene, mesh, replay, verbose, threads } = arguments;
    let mut plan = study.plan(HardPlan::standard, HardPlan::quick);
    if !only.is_empty() {
        plan.groups = only;
    }
    if !backends.is_empty() {
        plan.columns = backends;
    }
    (plan.shows_figures, plan.threads, plan.name) = (verbose, threads, scene);
    plan.replay = replay.replay.clone();
    plan.mesh = mesh.as_deref().map(mesh_file::load).transpose()?;
    let page = replay.replay.as_deref();
    study.run(mesh.as_deref(), page, |progress| hard(&plan, progress))?;
    replay.print()
}
