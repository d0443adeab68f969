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

use clap::{Args, Parser, ValueEnum};
use sbbk_lab::cli::{Outcome, StudyArguments, print_page};
use sbbk_lab::mesh_file;
use sbbk_lab::report::check_output;
use sbbk_lab::study::hard::random::{Family, Options, RandomPlan, random as run_random};
use sbbk_lab::study::hard::{Column, Group, HardPlan, Settings, hard};

/// Runs difficult scenes of meshes to their end, and judges them
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Runs only these scenes
    #[arg(long, value_name = "SCENES", value_delimiter = ',')]
    only: Vec<Group>,
    /// Body of the piles: an OBJ or STL file instead of the built-in monkey
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    #[command(flatten)]
    settings: Settings,
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
    #[command(flatten)]
    options: Options,
}

impl RandomArguments {
    /// True if random scenes are asked for.
    fn are_given(&self) -> bool {
        self.random.is_some() || self.number.is_some() || !self.family.is_empty()
    }

    fn plan(self, study: &StudyArguments, settings: Settings) -> RandomPlan {
        let count = self.random.flatten().unwrap_or_else(|| study.plan(|| 200, || 2));
        let numbers = self.number.map_or(0..count, |number| number..number + 1);
        let all = || Family::value_variants().to_vec();
        let families = if self.family.is_empty() { all() } else { self.family };
        RandomPlan { families, numbers, options: self.options, settings }
    }
}

fn main() -> Outcome {
    let Arguments { study, only, mesh, mut settings, random } = Arguments::parse();
    let page = settings.replay.clone();
    if let Some(page) = &page {
        check_output(page)?;
    }
    if settings.columns.is_empty() {
        let all = || Column::value_variants().to_vec();
        let usual = || Column::USUAL.to_vec();
        let with_control = || [usual(), vec![Column::Control]].concat();
        settings.columns = if random.are_given() { with_control() } else { study.plan(all, usual) };
    }
    if random.are_given() {
        let plan = random.plan(&study, settings);
        study.run(|progress| run_random(&plan, progress))?;
    } else {
        let groups = if only.is_empty() { Group::value_variants().to_vec() } else { only };
        let mesh = mesh.as_deref().map(mesh_file::load).transpose()?;
        let plan = HardPlan { groups, settings, mesh };
        study.run(|progress| hard(&plan, progress))?;
    }
    if let Some(page) = &page {
        print_page(page)?;
    }
    Ok(())
}
