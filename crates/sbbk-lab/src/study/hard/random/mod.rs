//! Scenes by chance, on which no code was tuned. Family, seed and number give all of a scene.
//!
//! Closed forms, conservation of energy, and the same scene with Rapier's shapes judge all columns
//! alike. Limits have no unit: they are in sizes of the scene, or shares.

mod draw;
mod heaps;
mod machines;
mod riders;
mod stage;

use std::ops::Range;

use clap::Args;

use super::figures::{self, Figures, Run};
use super::kit::{Column, Kit};
use super::{Settings, Trial, run_all};
use crate::prelude::*;
use draw::Draw;

/// Names that most families use.
mod prelude {
    pub(super) use super::draw::{Draw, Part};
    pub(super) use super::stage::{Body, Stage};
    pub(super) use crate::study::hard::kit::*;
}

/// A kind of scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Family {
    Floors,
    Stacks,
    Piles,
    Chains,
    Bowls,
    Slopes,
    Gears,
    Screws,
    Plates,
    Overlaps,
    Rooms,
    Tables,
    Grippers,
}

impl Family {
    /// Draws a scene and runs it.
    fn run(self, draw: &mut Draw, kit: &Kit) -> Figures {
        match self {
            Self::Floors => riders::floors(draw, kit),
            Self::Stacks => heaps::stacks(draw, kit),
            Self::Piles => heaps::piles(draw, kit),
            Self::Chains => machines::chains(draw, kit),
            Self::Bowls => heaps::bowls(draw, kit),
            Self::Slopes => riders::slopes(draw, kit),
            Self::Gears => machines::gears(draw, kit),
            Self::Screws => machines::screws(draw, kit),
            Self::Plates => heaps::plates(draw, kit),
            Self::Overlaps => heaps::overlaps(draw, kit),
            Self::Rooms => heaps::rooms(draw, kit),
            Self::Tables => heaps::tables(draw, kit),
            Self::Grippers => machines::grippers(draw, kit),
        }
    }
}

/// Settings of all scenes of a study.
#[derive(Clone, Copy, Debug, Args)]
pub struct Options {
    /// Seed of the random scenes
    #[arg(long, default_value = "1")]
    pub seed: u64,
    /// Rapier's length unit in random scenes; the size of the bodies if not given
    #[arg(long)]
    pub unit: Option<f32>,
}

/// Extent of the study.
#[derive(Clone, Debug)]
pub struct RandomPlan {
    pub families: Vec<Family>,
    /// Numbers of the scenes of each family.
    pub numbers: Range<u32>,
    pub options: Options,
    pub settings: Settings,
}

impl RandomPlan {
    fn trial(&self, family: Family, number: u32) -> Trial {
        let options = self.options;
        let run = move |kit: &Kit| {
            let mut draw = Draw::new(family, options, number);
            let figures = family.run(&mut draw, kit);
            // Some parts have no convex shape.
            let is_run = kit.column != Column::Control || draw.has_control;
            let about = format!("; {}", draw.about.join(", "));
            is_run.then_some(Figures { about, ..figures })
        };
        Trial { name: format!("{family} {number}"), run: Box::new(run) }
    }
}

/// Runs all scenes of the plan.
///
/// Errors: the page cannot be written.
pub fn random(plan: &RandomPlan, progress: &Progress) -> io::Result<Results> {
    let mut runs = Vec::new();
    for &family in &plan.families {
        let trials = plan.numbers.clone().map(|number| plan.trial(family, number));
        let trials: Vec<Trial> = trials.collect();
        let (settings, threads) = (&plan.settings, parallel::threads());
        run_all(&mut runs, &family.to_string(), &trials, settings, threads, progress)?;
    }
    let rows = plan.families.iter().flat_map(|family| {
        let counts = |&column: &Column| counted(&family.to_string(), column, &runs);
        plan.settings.columns.iter().map(counts).collect::<Vec<Row>>()
    });
    let broken = runs.iter().filter(|run| run.column == Column::Sbbk && run.wrong().is_some());
    let broken = broken.flat_map(|run| run.rows("random scenes: broken"));
    let rows = rows.chain(broken);
    let mut notes = figures::notes(&plan.settings, &runs);
    if !notes.is_empty() {
        let Options { seed, unit } = plan.options;
        let unit = unit.map(|unit| format!(" --unit {unit}")).unwrap_or_default();
        notes.push(format!("again: --family FAMILY --number NUMBER --seed {seed}{unit} --verbose"));
    }
    Ok(Results { notes, ..Results::new("random_scenes", rows.collect()) })
}

/// Counts of a family in a column: scenes, scenes that hold, and failures of SBBK. `lost` counts
/// the failures that stock holds, with the flag or without. `shared` counts the failures in which
/// the control fails, too.
fn counted(family: &str, column: Column, runs: &[Run]) -> Row {
    let of: Vec<&Run> =
        runs.iter().filter(|run| run.group == family && run.column == column).collect();
    let held = of.iter().filter(|run| run.wrong().is_none()).count();
    let is_failed = |run: &&&Run| column == Column::Sbbk && run.wrong().is_some();
    let is_stock = |column: &Column| matches!(column, Column::Stock | Column::StockFlag);
    let failed = of.iter().filter(is_failed);
    let lost = failed.clone().filter(|run| run.held_by(runs).iter().any(is_stock)).count();
    let shared = failed.filter(|run| {
        let is_control = |other: &Run| other.column == Column::Control && other.scene == run.scene;
        runs.iter().any(|other| is_control(other) && other.wrong().is_some())
    });
    let row = Row::new("random scenes", column).key("family", family);
    let row = row.with("scenes", of.len()).with("held", held).with("lost", lost);
    row.with("shared", shared.count())
}
