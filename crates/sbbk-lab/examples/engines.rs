//! The pile of heads in Rapier, for comparison with other engines: `benches/engines/run` runs all.
//!
//! ```text
//! cargo run --release --example engines -- export scene
//! cargo run --release --example engines -- run sbbk scene sbbk.1
//! cargo run --release --example engines -- judge scene sbbk.1 sbbk.2 bullet.1
//! ```

use std::path::PathBuf;

use clap::Parser;
use sbbk_lab::cli::{Outcome, show};
use sbbk_lab::mesh::monkey_head;
use sbbk_lab::mesh_file;
use sbbk_lab::scene::MonkeyPile;
use sbbk_lab::study::hard::Column;
use sbbk_lab::study::hard::engines::EnginePile;

/// Drops monkey heads in several engines: writes the scene, runs it in Rapier, compares runs
#[derive(Parser)]
enum Arguments {
    /// Writes the scene
    Export {
        /// File that all engines read
        scene: PathBuf,
        /// Number of heads
        #[arg(long, default_value = "200")]
        heads: usize,
        /// Seed of their orientations
        #[arg(long, default_value = "1")]
        seed: u64,
        /// The head: a closed OBJ or STL file instead of the built-in monkey
        #[arg(long, value_name = "FILE")]
        mesh: Option<PathBuf>,
    },
    /// Runs the scene in Rapier
    Run {
        /// Dispatcher and meshes; `control`: the convex parts of the heads
        column: Column,
        /// The scene
        scene: PathBuf,
        /// File with times, memory and the states of all heads
        run: PathBuf,
    },
    /// Compares runs
    Judge {
        /// The scene
        scene: PathBuf,
        /// Runs of all engines, named by these
        runs: Vec<PathBuf>,
        /// Writes all numbers to a CSV file, one a line
        #[arg(long, value_name = "FILE")]
        csv: Option<PathBuf>,
    },
}

fn main() -> Outcome {
    match Arguments::parse() {
        Arguments::Export { scene, heads, seed, mesh } => {
            let head = mesh.map_or_else(|| Ok(monkey_head()), |path| mesh_file::load(&path))?;
            let pile = MonkeyPile { seed, ..MonkeyPile::of(heads, head) };
            Ok(EnginePile::new(&pile).write(&scene)?)
        }
        Arguments::Run { column, scene, run } => Ok(EnginePile::read(&scene)?.run(column, &run)?),
        Arguments::Judge { scene, runs, csv } => {
            show(&EnginePile::read(&scene)?.judge(&runs)?, csv.as_deref())
        }
    }
}
