//! Does it pay? Measures your meshes and robots as terrains, as bodies and as sensors, under stock
//! Rapier and under SBBK, and says what to set.
//!
//! ```text
//! cargo run --release --example advise -- bunny.obj terrain.stl robot.urdf
//! ```

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::cli::{exit_code, print};
use sbbk_lab::mesh_file;
use sbbk_lab::study::everyday::{advise, advise_robot};

/// Says for each mesh or robot, in three lines, what SBBK is worth and what to set.
#[derive(Parser)]
struct Arguments {
    /// OBJ, STL or URDF files
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Steps of each run
    #[arg(long, default_value_t = 120)]
    steps: usize,
    /// Runs of each scene
    #[arg(long, default_value_t = 2)]
    repeats: usize,
}

fn main() -> ExitCode {
    let Arguments { files, steps, repeats } = Arguments::parse();
    let run = || -> Result<(), Box<dyn Error>> {
        for path in &files {
            let is_robot = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("urdf"));
            let advice = match is_robot {
                true => advise_robot(path, steps, repeats)?,
                false => advise(&mesh_file::load(path)?, steps, repeats),
            };
            print(advice)?;
        }
        Ok(())
    };
    exit_code(run())
}
