//! Hard scenes: whole worlds of meshes that stack, nest, mesh, sink in and fly.
//!
//! Stock Rapier and SBBK run each scene, with plain meshes and with
//! `TriMeshFlags::FIX_INTERNAL_EDGES`. Where convex shapes can replace the meshes, stock runs these as
//! a control. Figures with limits judge all runs alike.
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

pub use self::kit::Column;

use self::figures::Figures;
use self::kit::{Film, Kit};
use self::report::Run;

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
#[derive(Clone, Debug)]
pub struct Settings {
    /// Columns of the tables.
    pub columns: Vec<Column>,
    /// Runs at once. Scenes that are timed run alone.
    pub threads: usize,
    /// True to show all figures.
    pub shows_figures: bool,
    /// Page that plays the first of the scenes in all columns.
    pub replay: Option<PathBuf>,
}

impl Default for Settings {
    /// Stock and SBBK on plain meshes, and stock on meshes with the flag.
    fn default() -> Self {
        let columns = vec![Column::Stock, Column::StockFlag, Column::Sbbk];
        Self { columns, threads: 2, shows_figures: false, replay: None }
    }
}

/// Extent of the study.
#[derive(Clone, Debug)]
pub struct HardPlan {
    /// Kinds of scenes.
    pub groups: Vec<Group>,
    pub settings: Settings,
    /// Body of the piles, or `None` for heads.
    pub mesh: Option<Mesh>,
    /// Text in the names of the scenes.
    pub name: String,
}

impl HardPlan {
    /// All scenes in all columns.
    pub fn standard() -> Self {
        let columns = Column::value_variants().to_vec();
        Self { settings: Settings { columns, ..Settings::default() }, ..Self::quick() }
    }

    /// All scenes.
    pub fn quick() -> Self {
        Self {
            groups: Group::value_variants().to_vec(),
            settings: Settings::default(),
            mesh: None,
            name: String::new(),
        }
    }
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

fn trials(group: Group, plan: &HardPlan) -> Vec<Trial> {
    let mut trials = match group {
        Group::Pile => heaps::piles(plan.mesh.as_ref()),
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
    let mut stage = Stage::new(&plan.settings, progress);
    for group in &plan.groups {
        let name = group.to_possible_value().map_or_else(String::new, |v| v.get_name().to_owned());
        let is_timed = matches!(group, Group::Pile | Group::Tray);
        let threads = if is_timed { 1 } else { plan.settings.threads };
        stage.run(&name, &trials(*group, plan), threads)?;
    }
    let runs = stage.runs;
    if runs.is_empty() {
        return Err(StudyError::NoScene(plan.name.clone()));
    }
    let rows = runs.iter().flat_map(|run| {
        let row = Row::new("hard scenes", run.column).key("scene", &*run.scene);
        let row = row.with("passed", usize::from(run.wrong().is_none()));
        [row].into_iter().chain(run.rows("hard scenes: figures"))
    });
    let failed = plan.settings.columns.iter().map(|&column| {
        let of = runs.iter().filter(|run| run.column == column);
        let failed = of.clone().filter(|run| run.wrong().is_some());
        format!("{column} {} of {}", failed.count(), of.count())
    });
    let verdict = format!("scenes that fail: {}", failed.collect::<Vec<_>>().join(", "));
    let results = Results::new("hard_scenes", verdict, rows.collect());
    Ok(Results { notes: report::notes(&plan.settings, &runs), ..results })
}

/// Runs scenes in all columns.
struct Stage<'a> {
    settings: &'a Settings,
    progress: &'a Progress,
    runs: Vec<Run>,
}

impl<'a> Stage<'a> {
    fn new(settings: &'a Settings, progress: &'a Progress) -> Self {
        Self { settings, progress, runs: Vec::new() }
    }

    /// Runs scenes of one kind. The first scene of all is recorded, if there is to be a page.
    ///
    /// Errors: the page cannot be written.
    fn run(&mut self, group: &str, trials: &[Trial], threads: usize) -> Result<(), StudyError> {
        let Settings { columns, replay, .. } = self.settings;
        let page = replay.as_deref().filter(|_| self.runs.is_empty()).zip(trials.first());
        let of = |trial| columns.iter().map(move |&column| (trial, column));
        let jobs: Vec<(&Trial, Column)> = trials.iter().flat_map(of).collect();
        self.progress.phase(group, jobs.len());
        let found = parallel::map(&jobs, threads, |index, (trial, column)| {
            let film = (page.is_some() && index < columns.len()).then(Film::default);
            let figures = (trial.run)(&Kit::new(*column, film.clone()))?;
            self.progress.step();
            let (group, scene) = (group.to_owned(), trial.name.clone());
            let run = Run { group, scene, column: *column, figures };
            Some((run, film.and_then(|film| film.take())))
        });
        let (runs, films): (Vec<Run>, Vec<Option<Recorder>>) = found.into_iter().flatten().unzip();
        self.runs.extend(runs);
        let Some((path, trial)) = page else { return Ok(()) };
        replay::write(path, &trial.name, &films.into_iter().flatten().collect::<Vec<_>>())
    }
}
