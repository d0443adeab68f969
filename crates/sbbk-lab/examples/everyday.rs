//! Everyday scenes, stock Rapier beside SBBK: bodies on mesh terrains, single bodies, sensors,
//! characters, robots, and queries without a workspace.
//!
//! ```text
//! cargo run --release --example everyday
//! cargo run --release --example everyday -- --quick --csv everyday.csv
//! cargo run --release --example everyday -- --quick --only sensors,queries
//! cargo run --release --example everyday -- --quick --only flags --urdf robot.urdf
//! cargo run --release --example everyday -- --quick --only sensors --scene walk --replay walk.html
//! ```

use std::path::PathBuf;

use clap::Parser;
use sbbk_lab::cli::{Outcome, ReplayArguments, StudyArguments};
use sbbk_lab::study::everyday::{EverydayPlan, Group, everyday};

/// Compares times, memory and contacts in everyday scenes
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Measures only these parts
    #[arg(long, value_name = "PARTS", value_delimiter = ',')]
    only: Vec<Group>,
    /// Measures only worlds with this in their names
    #[arg(long, value_name = "TEXT", default_value = "")]
    scene: String,
    #[command(flatten)]
    replay: ReplayArguments,
    /// A robot of yours instead of ours, in the part `flags`
    #[arg(long, value_name = "FILE")]
    urdf: Option<PathBuf>,
}

fn main() -> Outcome {
    let arguments = Arguments::parse();
    let Arguments { study, only, scene, replay, urdf } = arguments;
    let mut plan = study.plan(EverydayPlan::standard, EverydayPlan::quick);
    if !only.is_empty() {
        plan.groups = only;
    }
    (plan.name, plan.urdf, plan.replay) = (scene, urdf.clone(), replay.replay.clone());
    let page = replay.replay.as_deref();
    study.run(urdf.as_deref(), page, |progress| everyday(&plan, progress))?;
    replay.print()
}
