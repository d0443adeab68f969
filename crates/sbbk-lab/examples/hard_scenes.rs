//! Hard scenes, stock Rapier beside SBBK: stacks, piles, gears, bodies that start in each other,
//! sheets. Each is judged by figures with limits.
//!
//! ```text
//! cargo run --release --example hard_scenes
//! cargo run --release --example hard_scenes -- --quick --csv hard.csv
//! cargo run --release --example hard_scenes -- --only gears,sunk --backends stock,sbbk --verbose
//! cargo run --release --example hard_scenes -- --quick --only gears --replay gears.html
//! cargo run --release --example hard_scenes -- --quick --only pile --mesh bunny.obj
//! cargo run --release --example hard_scenes -- --random 200 --seed 2
//! cargo run --release --example hard_scenes -- --family floors --number 17 --seed 2 --verbose
//! ```

use std::path::PathBuf;

use clap::{Args, Parser};
use sbbk_lab::cli::{Outcome, StudyArguments, print_page};
use sbbk_lab::mesh_file;
use sbbk_lab::report::check_output;
use sbbk_lab::study::hard::random::{Family, RandomPlan, random as run_random};
use sbbk_lab::study::hard::{Column, Group, HardPlan, Settings, hard};

/// Runs difficult scenes of meshes to their end, and judges them
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Runs only these scenes
    #[arg(long, value_name = "SCENES", value_delimiter = ',')]
    only: Vec<Group>,
    /// Runs only these columns
    #[arg(long, value_name = "COLUMNS", value_delimiter = ',')]
    backends: Vec<Column>,
    /// Body of the piles: an OBJ or STL file instead of the built-in monkey
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    /// Writes a page that plays the first scene, all columns side by side
    #[arg(long, value_name = "FILE")]
    replay: Option<PathBuf>,
    /// Shows all figures of all scenes
    #[arg(long)]
    verbose: bool,
    #[command(flatten)]
    random: RandomArguments,
}

/// Arguments of the random scenes.
#[derive(Args)]
struct RandomArguments {
    /// Runs so many random scenes of each family instead, or 200; a few if quick
    #[arg(long, value_name = "SCENES")]
    random: Option<Option<u32>>,
    /// Runs random scenes, of these families only
    #[arg(long, value_name = "FAMILIES", value_delimiter = ',')]
    family: Vec<Family>,
    /// Runs one random scene, the one with this number
    #[arg(long)]
    number: Option<u32>,
    /// Seed of the random scenes
    #[arg(long, default_value = "1")]
    seed: u64,
    /// Rapier's length unit in random scenes; the size of the bodies if not given
    #[arg(long)]
    unit: Option<f32>,
}

impl RandomArguments {
    /// The scenes, if random ones are asked for.
    fn plan(&self, study: &StudyArguments) -> Option<RandomPlan> {
        if self.random.is_none() && self.number.is_none() && self.family.is_empty() {
            return None;
        }
        let count = self.random.flatten().unwrap_or_else(|| study.plan(|| 200, || 2));
        let numbers = self.number.map_or(0..count, |number| number..number + 1);
        let mut plan = RandomPlan { unit: self.unit, ..RandomPlan::new(numbers, self.seed) };
        if !self.family.is_empty() {
            plan.families.clone_from(&self.family);
        }
        Some(plan)
    }
}

fn main() -> Outcome {
    let Arguments { study, only, backends, mesh, replay, verbose, random } = Arguments::parse();
    if let Some(page) = &replay {
        check_output(page)?;
    }
    let settings = |settings: Settings| Settings {
        columns: if backends.is_empty() { settings.columns } else { backends.clone() },
        shows_figures: verbose,
        replay: replay.clone(),
    };
    if let Some(mut plan) = random.plan(&study) {
        plan.settings = settings(plan.settings);
        study.run(|progress| run_random(&plan, progress))?;
    } else {
        let mut plan = study.plan(HardPlan::standard, HardPlan::quick);
        if !only.is_empty() {
            plan.groups = only;
        }
        plan.settings = settings(plan.settings);
        plan.mesh = mesh.as_deref().map(mesh_file::load).transpose()?;
        study.run(|progress| hard(&plan, progress))?;
    }
    if let Some(page) = &replay {
        print_page(page)?;
    }
    Ok(())
}
