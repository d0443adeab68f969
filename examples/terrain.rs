//! Monkey heads on a terrain: as a height field, which stock Rapier lets them fall through, and as a mesh of the same triangles.
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
use sbbk_lab::cli::{exit_code, print};
use sbbk_lab::report::{reserve, tables, write_json};
use sbbk_lab::scene::{Ground, HeadsOnTerrain, Scene};
use sbbk_lab::study::Progress;
use sbbk_lab::study::terrain::{TerrainPlan, terrain};

/// Measures queries on terrains from a thousand to a million cells, and lets heads fall on one.
#[derive(Parser)]
struct Arguments {
    /// Smaller terrains, fewer places and repeats: some seconds
    #[arg(long)]
    quick: bool,
    /// Writes all numbers to a JSON file
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Saves a picture of heads at rest to a PNG file
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
}

/// Steps of a sixtieth of a second until the heads rest.
const STEPS: usize = 300;

fn main() -> ExitCode {
    exit_code(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let plan = if arguments.quick { TerrainPlan::quick() } else { TerrainPlan::standard() };
    let Arguments { json, picture, .. } = arguments;
    [json, picture].into_iter().flatten().try_for_each(|path| reserve(path))?;
    let study = terrain(&plan, &Progress::visible())?;
    print(&study.environment)?;
    print(format_args!("\n{}\n", tables::terrain(&study)))?;
    if let Some(path) = json {
        write_json(&study, path)?;
    }
    let mut last = None;
    for (backend, ground) in [
        (Backend::Stock, Ground::HeightField),
        (Backend::Sbbk, Ground::Mesh),
        (Backend::Sbbk, Ground::HeightField),
    ] {
        let scene = HeadsOnTerrain { side_count: 4, cells: 24, ground };
        let mut world = scene.build()?;
        backend.install(&mut world.world);
        (0..STEPS).for_each(|_| world.world.step());
        let heights = world.watched.iter().map(|&body| world.world.bodies[body].translation().y);
        let count = heights.filter(|&height| height > -2.0).count();
        print(format_args!("{backend}, {}: {count} still there", scene.name()))?;
        last = Some(world);
    }
    if let (Some(path), Some(world)) = (picture, last) {
        world.portrait(1280, 720).save(path)?;
    }
    Ok(())
}
