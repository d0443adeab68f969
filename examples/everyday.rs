//! Everyday scenes, stock Rapier beside SBBK: bodies on mesh terrains, single bodies, sensors,
//! characters, queries without a workspace. Where does the one line cost time or memory?
//!
//! ```text
//! cargo run --release --example everyday
//! cargo run --release --example everyday -- --quick --csv everyday.csv --plot everyday.svg
//! cargo run --release --example everyday -- --quick --only sensors,queries
//! cargo run --release --example everyday -- --quick --only flags --urdf robot.urdf
//! cargo run --release --example everyday -- --quick --only sensors --scene walk --replay walk.html
//! ```

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::cli::{OtherFiles, ReplayArguments, StudyArguments, exit_code};
use sbbk_lab::study::everyday::{EverydayPlan, Group, everyday};

/// Compares times, memory and contacts in everyday scenes.
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

fn main() -> ExitCode {
    let Arguments { study, only, scene, replay, urdf } = Arguments::parse();
    let mut plan = study.plan(EverydayPlan::standard, EverydayPlan::quick);
    if !only.is_empty() {
        plan.groups = only;
    }
    let others = OtherFiles { read: urdf.as_deref(), ..OtherFiles::written(&replay) };
    plan.urdf = urdf.clone();
    plan.name = scene;
    plan.replay = replay.replay.clone();
    exit_code(study.try_run(&plan, everyday, others))
}
