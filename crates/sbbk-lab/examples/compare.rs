//! Both scenes of the paper under stock Rapier and SBBK, with the paper's numbers among ours.
//!
//! ```text
//! cargo run --release --example compare
//! cargo run --release --example compare -- --quick --csv compare.csv
//! ```

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::Parser;
use sbbk_lab::backend::Backend;
use sbbk_lab::cli::{Outcome, ReplayArguments, StudyArguments};
use sbbk_lab::mesh_file;
use sbbk_lab::study::compare::{ComparePlan, compare};

/// Compares stock Rapier, SBBK, and SBBK with AABBs only, in speed and error
#[derive(Parser)]
struct Arguments {
    /// Sizes of the piles of heads, the largest last [default: 100,200,500,1000,2000]
    #[arg(long, value_delimiter = ',', value_name = "N,N,...")]
    heads: Vec<NonZeroUsize>,
    /// The head: an OBJ or STL file instead of the built-in monkey
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    // The page shows ten seconds of the smallest pile.
    #[command(flatten)]
    replay: ReplayArguments,
    #[command(flatten)]
    study: StudyArguments,
}

/// Steps of the page.
const STEPS: usize = 600;

fn main() -> Outcome {
    let Arguments { heads, mesh, replay, study } = Arguments::parse();
    let mut plan = study.plan(ComparePlan::standard, ComparePlan::quick);
    plan.head = mesh.as_deref().map(mesh_file::load).transpose()?;
    if !heads.is_empty() {
        plan.heads = heads.iter().copied().map(NonZeroUsize::get).collect();
    }
    let page = replay.replay.as_deref();
    study.run(mesh.as_deref(), page, |progress| Ok(compare(&plan, progress)))?;
    let smallest = plan.heads.iter().copied().min().unwrap_or(1);
    replay.play(&plan.scene(smallest), &[Backend::Stock, Backend::Sbbk], STEPS)
}
