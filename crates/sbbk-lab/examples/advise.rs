//! Measures your meshes and robots as terrains, as bodies and as sensors, under stock Rapier and
//! under SBBK, and prints settings.
//!
//! ```text
//! cargo run --release --example advise -- bunny.obj terrain.stl robot.urdf
//! ```

use std::path::PathBuf;

use clap::Parser;
use sbbk_lab::cli::{Outcome, print};
use sbbk_lab::mesh_file;
use sbbk_lab::progress::Progress;
use sbbk_lab::study::everyday::{advise, advise_robot};

/// Steps of each run.
const STEPS: usize = 120;

/// Prints for each mesh or robot the gain as a terrain, as bodies and as sensors, and settings
#[derive(Parser)]
struct Arguments {
    /// OBJ, STL or URDF files
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
}

fn main() -> Outcome {
    let Arguments { files } = Arguments::parse();
    let progress = Progress::visible();
    for path in &files {
        let is_robot = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("urdf"));
        let advice = match is_robot {
            true => advise_robot(path, STEPS, &progress)?,
            false => advise(&mesh_file::load(path)?, STEPS, &progress),
        };
        progress.finish();
        print(advice)?;
    }
    Ok(())
}
