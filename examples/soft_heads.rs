//! Soft monkey heads fall on a rigid helicopter, stock beside SBBK.
//!
//! ```text
//! cargo run --release --example soft_heads
//! cargo run --release --example soft_heads -- --quick --picture soft.png
//! ```

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use rapier3d::math::Vec3;
use sbbk_lab::backend::Backend;
use sbbk_lab::cli::{OtherFiles, StudyArguments, exit_code};
use sbbk_lab::report::replace_file;
use sbbk_lab::scene::{Scene, SoftHeads};
use sbbk_lab::study::soft::{SoftPlan, soft};

/// Measures soft heads on a helicopter.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Saves a picture of very soft heads on the helicopter to a PNG file
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
}

/// The step of the picture.
const SQUASHED_AT: usize = 31;

fn main() -> ExitCode {
    exit_code(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let plan = arguments.study.plan(SoftPlan::standard, SoftPlan::quick);
    let others = OtherFiles { written: arguments.picture.as_deref(), ..OtherFiles::default() };
    arguments.study.run(&plan, soft, others)?;
    if let Some(path) = others.written {
        // Softer than those that are measured, and seen while the rotor squashes them most.
        let scene = SoftHeads { stiffness: 4.0, seed: 3, ..SoftHeads::with_heads(4) };
        let mut built = scene.build()?;
        let _installed = Backend::Sbbk.install(&mut built.world);
        (0..SQUASHED_AT).for_each(|_| built.world.step());
        let picture = built.close_up(1280, 720, Vec3::new(-0.35, -0.45, -1.0));
        replace_file(path, |path| picture.save(path))?;
    }
    Ok(())
}
