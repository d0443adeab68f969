//! Soft monkey heads fall on a rigid helicopter, stock beside SBBK, and a large mesh deforms: refits beside rebuilds.
//!
//! ```text
//! cargo run --release --example soft_heads
//! cargo run --release --example soft_heads -- --quick --picture soft.png
//! ```

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::backend::Backend;
use sbbk_lab::cli::{exit_code, print};
use sbbk_lab::report::{reserve, tables};
use sbbk_lab::scene::{Scene, SoftHeads};
use sbbk_lab::study::Progress;
use sbbk_lab::study::soft::{SoftPlan, soft};

/// Measures soft heads on a helicopter and refits of a large mesh.
#[derive(Parser)]
struct Arguments {
    /// Fewer heads, frames and repeats: some seconds
    #[arg(long)]
    quick: bool,
    /// Saves a picture of the heads on the helicopter to a PNG file
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
}

fn main() -> ExitCode {
    exit_code(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let plan = if arguments.quick { SoftPlan::quick() } else { SoftPlan::standard() };
    arguments.picture.as_deref().map(reserve).transpose()?;
    let study = soft(&plan, &Progress::visible())?;
    print(&study.environment)?;
    print(format_args!("\n{}\n\n{}", tables::soft_heads(&study), tables::refit(&study)))?;
    if let Some(path) = &arguments.picture {
        let mut built = SoftHeads::with_heads(plan.heads).build()?;
        let _installed = Backend::Sbbk.install(&mut built.world);
        // Later most heads have slid off.
        for _ in 0..plan.steps / 2 {
            built.world.step();
        }
        built.portrait(1280, 720).save(path)?;
    }
    Ok(())
}
