//! Does it pay? Measures your meshes as terrains, as bodies and as sensors, under stock Rapier and
//! under SBBK, and says what to set.
//!
//! ```text
//! cargo run --release --example advise -- bunny.obj terrain.glb
//! ```

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::cli::{exit_code, print};
use sbbk_lab::mesh;
use sbbk_lab::study::everyday::advise;

/// Says for each mesh, in three lines, what SBBK is worth and what to set.
#[derive(Parser)]
struct Arguments {
    /// OBJ, STL or glTF files
    #[arg(required = true, value_name = "MESH")]
    meshes: Vec<PathBuf>,
    /// Steps of each run
    #[arg(long, default_value_t = 120)]
    steps: usize,
    /// Runs of each scene
    #[arg(long, default_value_t = 2)]
    repeats: usize,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let run = || -> Result<(), Box<dyn Error>> {
        for path in &arguments.meshes {
            let mesh = mesh::load(path)?;
            print(advise(&mesh, arguments.steps, arguments.repeats)?)?;
        }
        Ok(())
    };
    exit_code(run())
}
