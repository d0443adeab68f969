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
use sbbk_lab::cli::{OtherFiles, StudyArguments, exit_code};
use sbbk_lab::mesh;
use sbbk_lab::replay;
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
    /// Runs the smallest pile once more, for ten seconds, and writes a page that plays it on stock
    /// and SBBK side by side
    #[arg(long, value_name = "FILE")]
    replay: Option<PathBuf>,
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
    let [read, written] = [&arguments.mesh, &arguments.replay].map(Option::as_deref);
    arguments.study.run(&plan, compare, OtherFiles { read, written })?;
    if let Some(path) = written {
        let heads = plan.heads.iter().copied().min().unwrap_or(1);
        replay::play(path, &plan.scene(heads), &[Backend::Stock, Backend::Sbbk], STEPS)?;
    }
    Ok(())
}
