//! The paper's first experiment: a ball falls on the rotor of a helicopter.
//!
//! ```text
//! cargo run --release --example helicopter_ball_drop
//! cargo run --release --example helicopter_ball_drop -- --ball primitive --replay rotor.html
//! ```

use std::error::Error;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::backend::Backend;
use sbbk_lab::cli::{ReplayArguments, exit_code, print};
use sbbk_lab::mesh;
use sbbk_lab::metrics::Environment;
use sbbk_lab::report::check_files;
use sbbk_lab::scene::{BallKind, HelicopterBallDrop};
use sbbk_lab::study::{HelicopterPlan, Progress, frames, helicopter};

/// Drops a ball on a helicopter's rotor: frames a second.
#[derive(Parser)]
struct Arguments {
    /// What the ball is made of
    #[arg(long, value_enum, default_value_t)]
    ball: BallKind,
    /// The helicopter, y up: an OBJ, STL or glTF file instead of the built-in one
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    /// Who answers the contact queries; several take turns
    #[arg(long, value_enum, value_delimiter = ',', default_value = "stock,aabb-only,sbbk")]
    backend: Vec<Backend>,
    /// Steps of a sixtieth of a second in each run
    #[arg(long, default_value = "120")]
    steps: NonZeroUsize,
    /// Runs of each backend; the paper has 30
    #[arg(long, default_value = "30")]
    repeats: NonZeroUsize,
    #[command(flatten)]
    replay: ReplayArguments,
}

fn main() -> ExitCode {
    exit_code(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let mut scene = HelicopterBallDrop { ball: arguments.ball, ..HelicopterBallDrop::default() };
    if let Some(path) = &arguments.mesh {
        scene.helicopter = mesh::load(path)?;
    }
    let plan = HelicopterPlan { repeats: arguments.repeats.get(), steps: arguments.steps.get() };
    let replay = &arguments.replay;
    check_files(arguments.mesh.as_deref().as_slice(), replay.replay.as_deref().as_slice())?;
    let progress = Progress::visible();
    let rows = helicopter(&scene, &arguments.backend, &plan, &progress);
    progress.finish();
    let frames = frames(&rows, &plan);
    print(format_args!("{}\n\n{frames}", Environment::detect()))?;
    replay.play(&scene, &arguments.backend, plan.steps)
}
