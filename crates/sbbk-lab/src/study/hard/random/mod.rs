//! Scenes by chance, on which no code was tuned. Family, seed and number give all of a scene.
//!
//! Closed forms, conservation of energy, and the same scene with Rapier's shapes judge all columns
//! alike. Limits have no unit: they are in sizes of the scene, or shares.

mod bowls;
mod chains;
mod draw;
mod floors;
mod gears;
mod overlaps;
mod piles;
mod plates;
mod report;
mod riders;
mod rooms;
mod screws;
mod slopes;
mod stacks;
mod stage;
mod tables;
mod vessels;

use std::ops::Range;
use std::sync::PoisonError;

use super::kit::{Column, Film, Kit};
use crate::prelude::*;
use crate::study::hard::figures::{Figure, Figures};
use draw::Draw;

/// Names that most families use.
mod prelude {
    pub(super) use super::draw::{Draw, Part};
    pub(super) use super::stage::{Body, Stage};
    pub(super) use crate::study::hard::kit::*;
}

named! {
    /// A kind of scene.
    #[derive(ValueEnum)]
    pub enum Family {
        Floors = "floors",
        Stacks = "stacks",
        Piles = "piles",
        Chains = "chains",
        Bowls = "bowls",
        Slopes = "slopes",
        Gears = "gears",
        Screws = "screws",
        Plates = "plates",
        Overlaps = "overlaps",
        Rooms = "rooms",
        Tables = "tables",
    }
}

/// Runs a scene of each family, in the order of [`Family`].
const RUN: [fn(&mut Draw, &Kit) -> Figures; Family::ALL.len()] = [
    floors::run,
    stacks::run,
    piles::run,
    chains::run,
    bowls::run,
    slopes::run,
    gears::run,
    screws::run,
    plates::run,
    overlaps::run,
    rooms::run,
    tables::run,
];

/// Extent of the study.
#[derive(Clone, Debug)]
pub struct RandomPlan {
    pub families: Vec<Family>,
    /// Columns of the tables.
    pub columns: Vec<Column>,
    /// Numbers of the scenes of each family.
    pub numbers: Range<u32>,
    pub seed: u64,
    /// Scenes that run at once.
    pub threads: usize,
    /// True to show all figures.
    pub shows_figures: bool,
    /// Page that plays the first scene in all columns.
    pub replay: Option<PathBuf>,
}

impl RandomPlan {
    /// Scenes of all families.
    pub fn new(numbers: Range<u32>, seed: u64) -> Self {
        Self {
            families: Family::ALL.into(),
            columns: vec![Column::Stock, Column::StockFlag, Column::Sbbk],
            numbers,
            seed,
            threads: 2,
            shows_figures: false,
            replay: None,
        }
    }
}

/// A scene in one column, with its figures.
struct Run {
    family: Family,
    number: u32,
    column: Column,
    figures: Figures,
    about: String,
}

impl Run {
    /// The first figure beyond its limits.
    fn wrong(&self) -> Option<&Figure> {
        self.figures.0.iter().find(|figure| !figure.is_right())
    }
}

/// Runs all scenes of the plan.
///
/// Errors: the page cannot be written.
pub fn random(plan: &RandomPlan, progress: &Progress) -> Result<Results, StudyError> {
    let mut runs = Vec::new();
    let mut replay = plan.replay.as_deref();
    for &family in &plan.families {
        let of = |number| plan.columns.iter().map(move |&column| (number, column));
        let jobs: Vec<(u32, Column)> = plan.numbers.clone().flat_map(of).collect();
        progress.phase(family.to_string(), jobs.len());
        let page = replay.take();
        let films: Vec<Film> = plan.columns.iter().map(|_| Film::default()).collect();
        let found = parallel::map(&jobs, plan.threads, |index, &(number, column)| {
            let film = films.get(index).filter(|_| page.is_some());
            let mut draw = Draw::new(family, plan.seed, number);
            let kit = Kit::new(column, true, 0);
            *kit.film.lock().unwrap_or_else(PoisonError::into_inner) = film.cloned();
            let figures = RUN[family as usize](&mut draw, &kit);
            progress.step();
            // Some parts have no convex shape.
            let is_run = column != Column::Control || draw.has_control;
            let about = draw.about.join(", ");
            is_run.then_some(Run { family, number, column, figures, about })
        });
        runs.extend(found.into_iter().flatten());
        if let Some(path) = page {
            let take = |film: &Film| film.lock().unwrap_or_else(PoisonError::into_inner).take();
            let taken: Vec<Recorder> = films.iter().filter_map(take).collect();
            replay::write(path, &format!("{family} {}", plan.numbers.start), &taken)?;
        }
    }
    Ok(report::results(plan, &runs))
}
