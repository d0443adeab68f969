//! The paper's second experiment: monkey heads dropped at once, colliding with each other.
//!
//! ```text
//! cargo run --release --example monkey_pile
//! cargo run --release --example monkey_pile -- 200 --steps 573 --backend stock,sbbk --replay pile.html
//! ```

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::Parser;
use sbbk_lab::backend::Backend;
use sbbk_lab::cli::{Outcome, ReplayArguments, print};
use sbbk_lab::mesh_file;
use sbbk_lab::metrics::{Environment, RunPlan};
use sbbk_lab::progress::Progress;
use sbbk_lab::report::check_outputs;
use sbbk_lab::scene::MonkeyPile;
use sbbk_lab::study::{PilePlan, pile, runs};

/// Drops monkey heads in a pile, and shows where the time goes
#[derive(Parser)]
struct Arguments {
    /// Number of heads
    #[arg(default_value = "2000")]
    heads: NonZeroUsize,
    /// Steps of a sixtieth of a second after the free fall
    #[arg(long, default_value = "53")]
    steps: NonZeroUsize,
    /// Dispatchers of the world; several run side by side
    #[arg(long, value_enum, value_delimiter = ',', default_value = "sbbk")]
    backend: Vec<Backend>,
    /// Updates every pair in every step, also pairs that hardly moved
    #[arg(long)]
    no_recycling: bool,
    /// The head: an OBJ or STL file instead of the built-in monkey
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    #[command(flatten)]
    replay: ReplayArguments,
}

fn main() -> Outcome {
    let arguments = Arguments::parse();
    let mut scene = MonkeyPile::with_heads(arguments.heads.get());
    if let Some(path) = &arguments.mesh {
        scene = MonkeyPile::of(arguments.heads.get(), mesh_file::load(path)?);
    }
    scene.contact_recycling = !arguments.no_recycling;
    let replay = &arguments.replay;
    check_outputs(arguments.mesh.as_deref().as_slice(), replay.replay.as_deref().as_slice())?;
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
    let progress = Progress::visible();
    let rows = pile(&scene, &plan, &progress);
    progress.finish();
    let [times, state] = runs(&rows, &plan.run);
    print(format_args!("{}\n\n{times}\n{state}", Environment::detect()))?;
    replay.play(&scene, &arguments.backend, plan.run.step_count())
}
