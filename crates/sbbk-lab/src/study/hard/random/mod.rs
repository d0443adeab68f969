//! Scenes that nobody tuned on: all of a scene is drawn from family, seed and number.
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
        /// Bodies that slide and roll over a flat ground.
        Floors = "floors",
        /// Towers of boxes.
        Stacks = "stacks",
        /// Bodies that fall into a tray.
        Piles = "piles",
        /// Rings that hang in each other.
        Chains = "chains",
        /// Bodies that fall into a bowl.
        Bowls = "bowls",
        /// Bodies that slide, roll or stay on a slope.
        Slopes = "slopes",
        /// A gear that drives another one.
        Gears = "gears",
        /// A nut on a bolt.
        Screws = "screws",
        /// Thin plates that fly onto a ground.
        Plates = "plates",
        /// Bodies that are released in each other.
        Overlaps = "overlaps",
        /// Bodies that fly about in a closed box.
        Rooms = "rooms",
        /// Tables with things on them.
        Tables = "tables",
    }
}

impl Family {
    fn run(self, draw: &mut Draw, kit: &Kit) -> Figures {
        match self {
            Self::Floors => floors::run(draw, kit),
            Self::Stacks => stacks::run(draw, kit),
            Self::Piles => piles::run(draw, kit),
            Self::Chains => chains::run(draw, kit),
            Self::Bowls => bowls::run(draw, kit),
            Self::Slopes => slopes::run(draw, kit),
            Self::Gears => gears::run(draw, kit),
            Self::Screws => screws::run(draw, kit),
            Self::Plates => plates::run(draw, kit),
            Self::Overlaps => overlaps::run(draw, kit),
            Self::Rooms => rooms::run(draw, kit),
            Self::Tables => tables::run(draw, kit),
        }
    }
}

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
        runs.extend(parallel::map(&jobs, plan.threads, |index, &(number, column)| {
            let film = films.get(index).filter(|_| page.is_some());
            let mut draw = Draw::new(family, plan.seed, number);
            let kit = Kit::new(column, true, 0);
            *kit.film.lock().unwrap_or_else(PoisonError::into_inner) = film.cloned();
            let mut figures = family.run(&mut draw, &kit);
            if column == Column::Control && !draw.has_control {
                figures = Figures::default();
            }
            progress.step();
            Run { family, number, column, figures, about: draw.about.join(", ") }
        }));
        if let Some(path) = page {
            let taken = films.iter();
            let taken =
                taken.filter_map(|f| f.lock().unwrap_or_else(PoisonError::into_inner).take());
            let title = format!("{family} {}", plan.numbers.start);
            replay::write(path, &title, &taken.collect::<Vec<_>>())?;
        }
    }
    Ok(report::results(plan, &runs))
}
