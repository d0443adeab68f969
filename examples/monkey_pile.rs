//! The paper's second experiment: monkey heads dropped at once, colliding with each other.
//!
//! ```text
//! cargo run --release --example monkey_pile
//! cargo run --release --example monkey_pile -- 200 --backend stock,sbbk --picture pile.png
//! cargo run --release --example monkey_pile -- 200 --steps 573 --backend stock,sbbk --replay pile.html
//! ```

use std::error::Error;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::backend::Backend;
use sbbk_lab::cli::{exit_code, print};
use sbbk_lab::mesh;
use sbbk_lab::metrics::{Environment, RunPlan};
use sbbk_lab::replay;
use sbbk_lab::report::{check_files, replace_file};
use sbbk_lab::scene::MonkeyPile;
use sbbk_lab::study::{PilePlan, Progress, pile, runs};

/// Drops monkey heads in a pile, and says where the time goes.
#[derive(Parser)]
struct Arguments {
    /// Number of heads
    #[arg(default_value = "2000")]
    heads: NonZeroUsize,
    /// Steps of a sixtieth of a second after the free fall
    #[arg(long, default_value = "53")]
    steps: NonZeroUsize,
    /// Who answers the contact queries; several run side by side
    #[arg(long, value_enum, value_delimiter = ',', default_value = "sbbk")]
    backend: Vec<Backend>,
    /// Asks about every pair in every step, also about pairs that hardly moved
    #[arg(long)]
    no_recycling: bool,
    /// The head: an OBJ, STL or glTF file instead of the built-in monkey
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    /// Saves a picture of the last step to a PNG file
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
    let mut scene = MonkeyPile::with_heads(arguments.heads.get());
    if let Some(path) = &arguments.mesh {
        scene = MonkeyPile::of(arguments.heads.get(), mesh::load(path)?);
    }
    scene.contact_recycling = !arguments.no_recycling;
    let [read, written] = [&arguments.mesh, &arguments.picture].map(Option::as_deref);
    let replay = arguments.replay.as_deref();
    check_files(read.as_slice(), &[written, replay].into_iter().flatten().collect::<Vec<_>>())?;
    let steps = arguments.steps.get();
    let plan = PilePlan {
        backends: arguments.backend.clone(),
        repeats: 1,
        run: RunPlan {
            warm_up: PilePlan::FREE_FALL,
            steps,
            sample_every: steps.div_ceil(3),
            sample_size: 30,
            query_stride: PilePlan::QUERY_STRIDE,
        },
        same_poses: None,
    };
    let mut picture = None;
    let progress = Progress::visible();
    let rows = pile(&scene, &plan, &progress, &mut |world| {
        if written.is_some() {
            picture.get_or_insert_with(|| world.portrait(1280, 720));
        }
    })?;
    progress.finish();
    let [times, accuracy] = runs(&rows, &plan.run);
    print(format_args!("{}\n\n{times}\n\n{accuracy}", Environment::detect()))?;
    if let Some((path, picture)) = written.zip(picture) {
        replace_file(path, |path| picture.save(path))?;
    }
    if let Some(path) = replay {
        replay::play(path, &scene, &arguments.backend, plan.run.step_count())?;
    }
    Ok(())
}
