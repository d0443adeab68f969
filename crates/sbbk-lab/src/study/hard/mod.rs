//! Hard scenes: whole worlds of meshes that stack, nest, mesh, sink in and fly.
//!
//! Stock Rapier and SBBK run each scene, with plain meshes and with
//! `TriMeshFlags::FIX_INTERNAL_EDGES`, with contact recycling and without. Where convex shapes can
//! replace the meshes, stock runs these as a control. Figures with limits judge all runs alike.
//! Chaotic scenes run with several seeds.
//!
//! Time steps are 1/60 s, gravity 9.81 units/s², and all parameters Rapier's defaults, unless a scene
//! says otherwise.

use crate::prelude::*;
mod ccd;
mod depth;
pub mod engines;
mod figures;
mod heaps;
mod inside;
mod kit;
mod machines;
pub mod random;
mod report;
mod resting;
mod road;

use std::sync::PoisonError;

pub use self::kit::Column;

use self::figures::Figures;
use self::kit::{Film, Kit};

/// A kind of scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Group {
    /// Heads dropped on a floor.
    Pile,
    /// Towers of cubes.
    Stacks,
    /// Bowls in each other.
    Bowls,
    /// A wall of bricks, and a house of cards.
    Walls,
    /// Rings that hang in each other.
    Chain,
    /// A nut on a bolt.
    Screw,
    /// Two gears.
    Gears,
    /// Bodies released in each other.
    Overlap,
    /// Boxes that start in a slab.
    Sunk,
    /// Cubes that slide and balls that roll over meshes.
    Road,
    /// Thin and fast bodies.
    Ccd,
    /// Heads at rest in a pit, of several sizes.
    Pit,
    /// Cubes on sheets without an inside.
    Sheets,
    /// Small things on a tray.
    Tray,
}

/// Extent of the study.
#[derive(Clone, Debug)]
pub struct HardPlan {
    /// Kinds of scenes.
    pub groups: Vec<Group>,
    /// Columns of the tables.
    pub columns: Vec<Column>,
    /// Rapier's contact recycling: its default is `true`.
    pub recycling: Vec<bool>,
    /// Runs of a chaotic scene.
    pub seeds: u64,
    /// Heads in the piles.
    pub heads: Vec<usize>,
    /// Body of the piles, or `None` for heads.
    pub mesh: Option<Mesh>,
    /// Runs at once. Scenes that are timed run alone.
    pub threads: usize,
    /// True to show all figures.
    pub shows_figures: bool,
    /// Text in the names of the scenes.
    pub name: String,
    /// Page that plays the first of the scenes in all columns.
    pub replay: Option<PathBuf>,
}

impl HardPlan {
    /// Everything.
    pub fn standard() -> Self {
        Self {
            groups: Group::value_variants().to_vec(),
            columns: Column::value_variants().to_vec(),
            recycling: vec![true, false],
            seeds: 3,
            heads: vec![200, 500],
            mesh: None,
            threads: 2,
            shows_figures: false,
            name: String::new(),
            replay: None,
        }
    }

    /// Stock and SBBK on plain meshes with Rapier's defaults, one run each.
    pub fn quick() -> Self {
        Self {
            columns: vec![Column::Stock, Column::Sbbk],
            recycling: vec![true],
            seeds: 1,
            heads: vec![200],
            ..Self::standard()
        }
    }
}

/// A scene with its figures.
struct Trial {
    name: String,
    /// True if convex shapes can replace the meshes.
    has_control: bool,
    /// True if the seed makes a difference.
    has_seeds: bool,
    run: Box<RunTrial>,
}

type RunTrial = dyn Fn(&Kit) -> Figures + Send + Sync;

impl Trial {
    /// A scene with a control and without a seed.
    fn new(name: impl Into<String>, run: impl Fn(&Kit) -> Figures + Send + Sync + 'static) -> Self {
        Self { name: name.into(), has_control: true, has_seeds: false, run: Box::new(run) }
    }

    /// Removes the control.
    fn without_control(self) -> Self {
        Self { has_control: false, ..self }
    }

    /// Runs the scene with several seeds.
    fn seeded(self) -> Self {
        Self { has_seeds: true, ..self }
    }

    fn kits(&self, plan: &HardPlan) -> Vec<Kit> {
        let mut kits = Vec::new();
        for &recycling in &plan.recycling {
            let columns = plan.columns.iter().copied();
            for column in columns.filter(|&column| self.has_control || column != Column::Control) {
                let seeds = 1..=if self.has_seeds { plan.seeds } else { 1 };
                kits.extend(seeds.map(|seed| Kit::new(column, recycling, seed)));
            }
        }
        kits
    }
}

fn trials(group: Group, plan: &HardPlan) -> Vec<Trial> {
    let mut trials = match group {
        Group::Pile => heaps::piles(&plan.heads, plan.mesh.as_ref()),
        Group::Stacks => resting::stacks(),
        Group::Bowls => resting::bowls(),
        Group::Walls => resting::walls(),
        Group::Chain => resting::chains(),
        Group::Screw => machines::screws(),
        Group::Gears => machines::gears(),
        Group::Overlap => inside::overlaps(),
        Group::Sunk => inside::sunk(),
        Group::Road => road::trials(),
        Group::Ccd => ccd::trials(),
        Group::Pit => heaps::pits(),
        Group::Sheets => inside::sheets(),
        Group::Tray => heaps::trays(),
    };
    trials.retain(|trial| trial.name.contains(&plan.name));
    trials
}

/// Runs all scenes of the plan.
///
/// Errors: no scene has the name, or the page cannot be written.
pub fn hard(plan: &HardPlan, progress: &Progress) -> Result<Results, StudyError> {
    let mut rows = Vec::new();
    let mut replay = plan.replay.as_deref();
    for group in &plan.groups {
        let trials = trials(*group, plan);
        let jobs: Vec<(&Trial, Kit)> = trials
            .iter()
            .flat_map(|trial| trial.kits(plan).into_iter().map(move |kit| (trial, kit)))
            .collect();
        let replay = trials.first().and_then(|trial| Some((trial, replay.take()?)));
        let films = replay.map_or_else(Vec::new, |(trial, _)| film(trial, &jobs));
        let name = group.to_possible_value().map_or_else(String::new, |v| v.get_name().to_owned());
        progress.phase(name, jobs.len());
        let threads = if matches!(group, Group::Pile | Group::Tray) { 1 } else { plan.threads };
        let found = parallel::map(&jobs, threads, |_, (trial, kit)| {
            let figures = (trial.run)(kit);
            progress.step();
            figures
        });
        if let Some((trial, path)) = replay {
            let recorders = films
                .iter()
                .filter_map(|film| film.lock().unwrap_or_else(PoisonError::into_inner).take());
            replay::write(path, &trial.name, &recorders.collect::<Vec<_>>())?;
        }
        for trial in &trials {
            let runs = jobs.iter().zip(&found).filter(|((other, _), _)| other.name == trial.name);
            let runs: Vec<(&Kit, &Figures)> = runs.map(|((_, kit), found)| (kit, found)).collect();
            rows.extend(report::rows(trial, &runs));
        }
    }
    if rows.is_empty() {
        return Err(StudyError::NoScene(plan.name.clone()));
    }
    let tables = report::tables(plan, &rows);
    Ok(Results::new(report::verdict_of_all(plan, &rows), rows, tables))
}

/// Records the first run of a scene in each column.
fn film(first: &Trial, jobs: &[(&Trial, Kit)]) -> Vec<Film> {
    let mut films: Vec<(Column, Film)> = Vec::new();
    for (_, kit) in jobs.iter().filter(|(trial, _)| trial.name == first.name) {
        if films.iter().all(|(column, _)| *column != kit.column) {
            let film = Film::default();
            films.push((kit.column, film.clone()));
            *kit.film.lock().unwrap_or_else(PoisonError::into_inner) = Some(film);
        }
    }
    films.into_iter().map(|(_, film)| film).collect()
}
