//! The paper's first experiment: a ball falls on the rotor of a helicopter.
//!
//! ```text
//! cargo run --release --example helicopter_ball_drop
//! cargo run --release --example helicopter_ball_drop -- --ball primitive --picture rotor.png
//! ```

use std::error::Error;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::backend::Backend;
use sbbk_lab::cli::{exit_code, print};
use sbbk_lab::mesh;
use sbbk_lab::metrics::Environment;
use sbbk_lab::replay;
use sbbk_lab::report::{check_files, replace_file};
use sbbk_lab::scene::{BallKind, HelicopterBallDrop, Scene};
use sbbk_lab::study::{HelicopterPlan, Progress, cut, cut_table, frames, helicopter};

/// Drops a ball on a helicopter's rotor: frames a second, and how much each hierarchy reports.
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
    /// Saves a picture of the moment of contact to a PNG file
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
    /// Runs once more, and writes a page that plays the backends side by side
    #[arg(long, value_name = "FILE")]
    replay: Option<PathBuf>,
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
    let [read, written] = [&arguments.mesh, &arguments.picture].map(Option::as_deref);
    let replay = arguments.replay.as_deref();
    check_files(read.as_slice(), &[written, replay].into_iter().flatten().collect::<Vec<_>>())?;
    let progress = Progress::visible();
    let rows = helicopter(&scene, &arguments.backend, &plan, &progress)?;
    let cut = cut(&scene)?;
    progress.finish();
    let frames = frames(&rows, &plan);
    print(format_args!("{}\n\n{frames}\n\n{}", Environment::detect(), cut_table(&cut)))?;
    if let Some(path) = written {
        let mut built = scene.build()?;
        let contact = cut.first().map_or(plan.steps as u64, |row| row.count("step"));
        (0..contact).for_each(|_| built.world.step());
        let picture = built.portrait(1280, 720);
        replace_file(path, |path| picture.save(path))?;
    }
    if let Some(path) = replay {
        replay::play(path, &scene, &arguments.backend, plan.steps)?;
    }
    Ok(())
}
