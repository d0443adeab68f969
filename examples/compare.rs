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
use sbbk_lab::cli::{Output, exit_code};
use sbbk_lab::mesh;
use sbbk_lab::report::{tables, write_plot};
use sbbk_lab::study::{ComparePlan, Progress, compare};

/// Compares stock Rapier, SBBK, and SBBK with AABBs only, in speed and error.
#[derive(Parser)]
struct Arguments {
    /// Small scenes and few repeats: half a minute instead of three
    #[arg(long)]
    quick: bool,
    /// Sizes of the piles of heads, the largest last [default: 100,200,500,1000,2000]
    #[arg(long, value_delimiter = ',', value_name = "N,N,...")]
    heads: Vec<NonZeroUsize>,
    /// The head: an OBJ, STL or glTF file instead of the built-in monkey
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    #[command(flatten)]
    output: Output,
}

fn main() -> ExitCode {
    exit_code(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let mut plan = if arguments.quick { ComparePlan::quick() } else { ComparePlan::standard() };
    plan.head = arguments.mesh.as_deref().map(mesh::load).transpose()?;
    if !arguments.heads.is_empty() {
        plan.heads = arguments.heads.iter().copied().map(NonZeroUsize::get).collect();
    }
    arguments.output.reserve()?;
    let comparison = compare(&plan, &Progress::visible())?;
    let tables = tables::all(&comparison);
    arguments.output.publish(&comparison, &comparison.environment, &tables, write_plot)
}
