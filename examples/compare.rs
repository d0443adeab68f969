//! Stock Rapier beside SBBK: both scenes of the paper on all backends, with the paper's numbers
//! among ours.
//!
//! ```text
//! cargo run --release --example compare
//! cargo run --release --example compare -- --quick --plot compare.svg
//! ```

use std::error::Error;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::backend::Backend;
use sbbk_lab::cli::{OtherFiles, ReplayArguments, StudyArguments, exit_code};
use sbbk_lab::mesh;
use sbbk_lab::study::compare::{ComparePlan, compare};

/// Compares stock Rapier, SBBK, and SBBK with AABBs only, in speed and error.
#[derive(Parser)]
struct Arguments {
    /// Sizes of the piles of heads, the largest last [default: 100,200,500,1000,2000]
    #[arg(long, value_delimiter = ',', value_name = "N,N,...")]
    heads: Vec<NonZeroUsize>,
    /// The head: an OBJ, STL or glTF file instead of the built-in monkey
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    // Of the smallest pile, for ten seconds.
    #[command(flatten)]
    replay: ReplayArguments,
    #[command(flatten)]
    study: StudyArguments,
}

/// Steps of the page.
const STEPS: usize = 600;

fn main() -> ExitCode {
    exit_code(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let mut plan = arguments.study.plan(ComparePlan::standard, ComparePlan::quick);
    plan.head = arguments.mesh.as_deref().map(mesh::load).transpose()?;
    if !arguments.heads.is_empty() {
        plan.heads = arguments.heads.iter().copied().map(NonZeroUsize::get).collect();
    }
    let Arguments { mesh, replay, study, .. } = arguments;
    let others = OtherFiles { read: mesh.as_deref(), ..OtherFiles::written(replay) };
    study.run(&plan, compare, others)?;
    let smallest = plan.heads.iter().copied().min().unwrap_or(1);
    replay.play(&plan.scene(smallest), &[Backend::Stock, Backend::Sbbk], STEPS)
}
