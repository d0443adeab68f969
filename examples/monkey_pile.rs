//! The paper's second experiment: monkey heads dropped at once, colliding with each other.
//!
//! ```text
//! cargo run --release --example monkey_pile
//! cargo run --release --example monkey_pile -- 200 --backend stock,sbbk --picture pile.png
//! ```

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use sbbk_lab::backend::Backend;
use sbbk_lab::cli::{exit_code, print};
use sbbk_lab::mesh;
use sbbk_lab::metrics::{Environment, RunPlan};
use sbbk_lab::report::tables;
use sbbk_lab::scene::MonkeyPile;
use sbbk_lab::study::{PilePlan, Progress, pile};

/// Drops monkey heads in a pile, and says where the time goes.
#[derive(Parser)]
struct Arguments {
    /// Number of heads
    #[arg(default_value_t = 2000)]
    heads: usize,
    /// Steps of a sixtieth of a second
    #[arg(long, default_value_t = 80)]
    steps: usize,
    /// Who answers the contact queries; several are run one after the other
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
}

/// Until then the heads fall freely.
const FREE_FALL: usize = 27;

fn main() -> ExitCode {
    exit_code(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let mut scene = MonkeyPile::with_heads(arguments.heads);
    if let Some(path) = &arguments.mesh {
        scene = MonkeyPile::of(arguments.heads, mesh::load(path)?);
    }
    scene.contact_recycling = !arguments.no_recycling;
    let steps = arguments.steps.saturating_sub(FREE_FALL);
    let plan = PilePlan {
        backends: arguments.backend.clone(),
        repeats: 1,
        run: RunPlan {
            warm_up: FREE_FALL,
            steps,
            sample_every: steps.div_ceil(3),
            sample_size: 30,
        },
        same_poses: None,
    };
    let (mut step, mut picture) = (0, None);
    let study = pile(&scene, &plan, &Progress::visible(), &mut |world| {
        step += 1;
        if step == FREE_FALL + steps && arguments.picture.is_some() {
            picture = Some(world.portrait(1280, 720));
        }
    })?;
    print(Environment::detect())?;
    print(format_args!("\n{}\n{}", tables::runs(&study), tables::accuracy(&[study])))?;
    if let (Some(path), Some(picture)) = (&arguments.picture, picture) {
        picture.save(path)?;
    }
    Ok(())
}
