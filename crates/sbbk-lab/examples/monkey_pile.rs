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
use sbbk_lab::cli::{Outcome, print, print_page};
use sbbk_lab::mesh::monkey_head;
use sbbk_lab::mesh_file;
use sbbk_lab::progress::Progress;
use sbbk_lab::replay;
use sbbk_lab::report::check_output;
use sbbk_lab::scene::MonkeyPile;
use sbbk_lab::study::runs::{RunPlan, one_pile};

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
    /// The head: an OBJ or STL file instead of the built-in monkey
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    /// Writes a page that plays the pile, all dispatchers side by side
    #[arg(long, value_name = "FILE")]
    replay: Option<PathBuf>,
}

fn main() -> Outcome {
    let Arguments { heads, steps, backend, mesh, replay: page } = Arguments::parse();
    if let Some(page) = &page {
        check_output(page)?;
    }
    let head = mesh.map_or_else(|| Ok(monkey_head()), |path| mesh_file::load(&path))?;
    let scene = MonkeyPile::of(heads.get(), head);
    let steps = steps.get();
    let plan = RunPlan {
        backends: backend,
        repeats: 1,
        warm_up: RunPlan::FREE_FALL,
        steps,
        judge_every: steps.div_ceil(3),
        judged_pairs: 30,
        same_poses: 0,
    };
    let results = one_pile(&scene, &plan, &Progress::visible());
    print(results)?;
    if let Some(page) = &page {
        replay::play(page, &scene, &plan.backends, plan.step_count(), &Progress::visible())?;
        print_page(page)?;
    }
    Ok(())
}
