//! Hard scenes: whole worlds of meshes that stack, nest, mesh, sink in and fly.
//!
//! Stock Rapier and SBBK run each scene, with plain meshes and with
//! `TriMeshFlags::FIX_INTERNAL_EDGES`. Stock also runs the scene with convex shapes as a control,
//! if these can replace the meshes. Figures with limits judge all runs alike.
//!
//! Time steps are 1/60 s, gravity 9.81 units/s², and all parameters Rapier's defaults, unless a
//! scene says otherwise.

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
mod resting;
mod road;

pub use self::kit::Column;

use clap::Args;

use self::figures::{Figures, Run};
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

/// How scenes run.
#[derive(Clone, Debug, Default, Args)]
pub struct Settings {
    /// Runs only these columns
    #[arg(long = "backends", value_name = "COLUMNS", value_delimiter = ',')]
    pub columns: Vec<Column>,
    /// Shows all figures of all scenes
    #[arg(long)]
    pub verbose: bool,
    /// Writes a page that plays the first scene, all columns side by side
    #[arg(long, value_name = "FILE")]
    pub replay: Option<PathBuf>,
}

/// Extent of the study.
#[derive(Clone, Debug)]
pub struct HardPlan {
    /// Kinds of scenes.
    pub groups: Vec<Group>,
    pub settings: Settings,
    /// Body of the piles, or `None` for heads.
    pub mesh: Option<Mesh>,
}

/// A scene with its figures.
struct Trial {
    name: String,
    run: Box<RunTrial>,
}

/// Returns nothing if the scene has no convex shapes for the control.
type RunTrial = dyn Fn(&Kit) -> Option<Figures> + Send + Sync;

impl Trial {
    /// A scene with a control.
    fn new(name: impl Into<String>, run: impl Fn(&Kit) -> Figures + Send + Sync + 'static) -> Self {
        Self { name: name.into(), run: Box::new(move |kit| Some(run(kit))) }
    }

    /// Removes the control.
    fn without_control(self) -> Self {
        let Self { name, run } = self;
        let run = move |kit: &Kit| if kit.column == Column::Control { None } else { run(kit) };
        Self { name, run: Box::new(run) }
    }
}

fn trials(group: Group, mesh: Option<&Mesh>) -> Vec<Trial> {
    match group {
        Group::Pile => heaps::piles(mesh),
        Group::Stacks => resting::stacks(),
        Group::Bowls => vec![Trial::new("ten nested bowls", resting::nested)],
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
        Group::Tray => {
            vec![Trial::new("100 things of 3 to 8 cm on a tray", heaps::tray).without_control()]
        }
    }
}

/// Runs all scenes of the plan.
///
/// Errors: the page cannot be written.
pub fn hard(plan: &HardPlan, progress: &Progress) -> io::Result<Results> {
    let mut runs = Vec::new();
    for group in &plan.groups {
        let is_timed = matches!(group, Group::Pile | Group::Tray);
        let threads = if is_timed { 1 } else { parallel::threads() };
        let trials = trials(*group, plan.mesh.as_ref());
        run_all(&mut runs, &group.to_string(), &trials, &plan.settings, threads, progress)?;
    }
    let rows = runs.iter().flat_map(|run| {
        let row = Row::new("hard scenes", run.column).key("scene", &run.scene);
        let row = row.with("passed", usize::from(run.wrong().is_none()));
        [row].into_iter().chain(run.rows("hard scenes: figures"))
    });
    let notes = figures::notes(&plan.settings, &runs);
    Ok(Results { notes, ..Results::new("hard_scenes", rows.collect()) })
}

/// Runs scenes of one kind in all columns. The first scene of all is recorded, if there is to be a
/// page.
///
/// Errors: the page cannot be written.
fn run_all(
    runs: &mut Vec<Run>,
    group: &str,
    trials: &[Trial],
    settings: &Settings,
    threads: usize,
    progress: &Progress,
) -> io::Result<()> {
    let Settings { columns, replay, .. } = settings;
    let page = replay.as_deref().filter(|_| runs.is_empty()).zip(trials.first());
    let of = |trial| columns.iter().map(move |&column| (trial, column));
    let jobs: Vec<(&Trial, Column)> = trials.iter().flat_map(of).collect();
    progress.phase(group, jobs.len());
    let found = parallel::map(&jobs, threads, |index, (trial, column)| {
        let film = (page.is_some() && index < columns.len()).then(Film::default);
        let figures = (trial.run)(&Kit::new(*column, film.clone()))?;
        progress.step();
        let (group, scene) = (group.to_owned(), trial.name.clone());
        let run = Run { group, scene, column: *column, figures };
        Some((run, film.and_then(|film| film.take())))
    });
    let (found, films): (Vec<Run>, Vec<Option<Recorder>>) = found.into_iter().flatten().unzip();
    runs.extend(found);
    let Some((path, trial)) = page else { return Ok(()) };
    replay::write(path, &trial.name, &films.into_iter().flatten().collect::<Vec<_>>())
}
