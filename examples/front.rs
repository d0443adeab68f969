//! What temporal coherence is worth: the parts of a front, one after the other, beside fresh descents.
//!
//! ```text
//! cargo run --release --example front
//! cargo run --release --example front -- --quick --csv front.csv --plot front.svg
//! ```

use std::error::Error;
use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::cli::{Output, exit_code};
use sbbk_lab::report::{tables, write_front_plot};
use sbbk_lab::study::Progress;
use sbbk_lab::study::front::{FrontPlan, front};

/// Compares descents that start where the last one stopped with fresh ones.
#[derive(Parser)]
struct Arguments {
    /// Fewer meshes and repeats: a quarter of a minute instead of two
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    output: Output,
}

fn main() -> ExitCode {
    exit_code(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let plan = if arguments.quick { FrontPlan::quick() } else { FrontPlan::standard() };
    arguments.output.reserve()?;
    let study = front(&plan, &Progress::visible())?;
    let tables = tables::front(&study);
    arguments.output.publish(&study, &study.environment, &tables, write_front_plot)
}
