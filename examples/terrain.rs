//! Monkey heads on a terrain: as a height field, which stock Rapier lets them fall through, and as
//! a mesh of the same triangles.
//!
//! ```text
//! cargo run --release --example terrain
//! cargo run --release --example terrain -- --quick --picture terrain.png
//! ```

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::backend::Backend;
use sbbk_lab::cli::{OtherFiles, StudyArguments, exit_code};
use sbbk_lab::report::replace_file;
use sbbk_lab::scene::{Ground, Scene};
use sbbk_lab::study::terrain::{TerrainPlan, falling_heads, terrain};

/// Measures queries on terrains from a thousand to a million cells, and lets heads fall on one.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Saves a picture of heads at rest to a PNG file
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
}

fn main() -> ExitCode {
    exit_code(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let plan = arguments.study.plan(TerrainPlan::standard, TerrainPlan::quick);
    let others = OtherFiles { written: arguments.picture.as_deref(), ..OtherFiles::default() };
    arguments.study.run(&plan, terrain, others)?;
    if let Some(path) = others.written {
        let mut built = falling_heads(Ground::HeightField).build()?;
        let _installed = Backend::Sbbk.install(&mut built.world);
        (0..plan.fall_steps).for_each(|_| built.world.step());
        let picture = built.portrait(1280, 720);
        replace_file(path, |path| picture.save(path))?;
    }
    Ok(())
}
