//! Measures your meshes and robots as terrains, as bodies and as sensors, under stock Rapier and
//! under SBBK, and prints settings.
//!
//! ```text
//! cargo run --release --example advise -- bunny.obj terrain.stl robot.urdf
//! ```

use std::path::PathBuf;

use clap::Parser;
use sbbk_lab::cli::{Outcome, print};
use sbbk_lab::progress::Progress;
use sbbk_lab::study::everyday::{Subject, advise};

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
    for path in &files {
        let advice = advise(&Subject::load(path)?, STEPS, &Progress::visible());
        print(advice)?;
    }
    Ok(())
}
