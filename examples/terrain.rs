//! Monkey heads on a terrain: as a height field, which stock Rapier lets them fall through, and as
//! a mesh of the same triangles.
//!
//! ```text
//! cargo run --release --example terrain
//! cargo run --release --example terrain -- --quick --replay terrain.html
//! ```

use std::error::Error;
use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::backend::Backend;
use sbbk_lab::cli::{OtherFiles, ReplayArguments, StudyArguments, exit_code};
use sbbk_lab::scene::Ground;
use sbbk_lab::study::terrain::{TerrainPlan, falling_heads, terrain};

/// Measures queries on terrains from a thousand to a million cells, and lets heads fall on one.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    // Of the heads on a height field.
    #[command(flatten)]
    replay: ReplayArguments,
}

fn main() -> ExitCode {
    exit_code(run(&Arguments::parse()))
}

fn run(Arguments { study, replay }: &Arguments) -> Result<(), Box<dyn Error>> {
    let plan = study.plan(TerrainPlan::standard, TerrainPlan::quick);
    study.run(&plan, terrain, OtherFiles::written(replay))?;
    let heads = falling_heads(Ground::HeightField);
    replay.play(&heads, &[Backend::Stock, Backend::Sbbk], plan.fall_steps)
}
