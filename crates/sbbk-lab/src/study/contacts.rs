//! Contacts of mesh pairs at every scale, stock Parry beside SBBK: wrong ones, and times.
//!
//! A *case* is one mesh at one size, paired with itself at one prediction distance. One copy
//! approaches the other in a random orientation and is stopped at five places, from nearly apart to
//! deep inside. Brute force in f64 judges every answer.

use crate::prelude::*;

use super::PREDICTION;
use super::motion::{Approach, Mode, Place, STEP_COUNT};
use super::pair::{self, SIDES};

const EXACTNESS: &str = "contacts: exactness";
const QUERIES: &str = "contacts: queries, µs";
const DEFAULTS: &str = "contacts: queries with the default settings, µs";

/// Extent of the study.
#[derive(Clone, Debug)]
pub struct ContactsPlan {
    /// The meshes, in the order of the tables, and their approaches in each case, of five poses
    /// each.
    pub meshes: Vec<(Mesh, usize)>,
    /// Least number of repeats of times.
    pub repeats: usize,
}

/// Longest sides of meshes, and prediction distances, in units.
const SIZES: [Real; 3] = [0.1, 2.0, 40.0];
const PREDICTIONS: [Real; 3] = [0.001, 0.002, 0.02];
/// Triangles in all repeats of a speed case together. Higher: slower studies; lower: noisier times
/// of small meshes.
const REPEATED_TRIANGLES: usize = 25_000;
const MOST_REPEATS: usize = 25;
/// Size and prediction distance of the cases whose speed is measured, in units: Rapier's default.
const SPEED_CASE: [Real; 2] = [2.0, PREDICTION];
/// Motions of a mesh at most.
const MOTION_LIMIT: usize = 20;
/// Contacts of a place at most; a place with more is moved back. Higher: gigabytes for fine meshes
/// of a tenth of a unit; lower: fewer cases that cross.
const PAIR_LIMIT: usize = 40_000;
/// The way to a place is halved at most so often to stay below [`PAIR_LIMIT`].
const HALVINGS: i32 = 7;

impl ContactsPlan {
    /// Six meshes of 288 to 70,688 triangles in 1125 poses; about three minutes on two cores.
    pub fn standard() -> Self {
        Self {
            meshes: vec![
                (mesh::monkey_head_with(6), 8),
                (mesh::monkey_head_with(11), 6),
                (mesh::helicopter(), 4),
                (mesh::torus(0.7, 0.3, 72, 35), 4),
                (mesh::monkey_head_with(50), 2),
                (mesh::monkey_head_with(94), 1),
            ],
            repeats: 5,
        }
    }

    /// The four smaller meshes with one approach each, half a minute: for trying, not for quoting.
    pub fn quick() -> Self {
        let small = Self::standard().meshes.into_iter().take(4);
        Self { meshes: small.map(|(mesh, _)| (mesh, 1)).collect(), repeats: 3 }
    }
}

/// A mesh at one size against itself, with one prediction distance.
#[derive(Clone)]
struct Case<'a> {
    mesh: &'a Mesh,
    approach_count: usize,
    size: Real,
    prediction: Real,
    shape: SharedShape,
    places: Vec<Place>,
    /// Errors of first queries at all places, of stock and SBBK.
    errors: Vec<Errors>,
}

/// Judges all cases, and measures the times at Rapier's defaults.
pub fn contacts(plan: &ContactsPlan, progress: &Progress) -> Results {
    let mut cases = Vec::new();
    for &(ref mesh, approach_count) in &plan.meshes {
        for size in SIZES {
            let shape = mesh.clone().centred().scaled_to(size).shape();
            cases.extend(PREDICTIONS.map(|prediction| Case {
                mesh,
                approach_count,
                size,
                prediction,
                shape: shape.clone(),
                places: Vec::new(),
                errors: Vec::new(),
            }));
        }
    }
    let shapes = cases.iter().map(|case| &case.shape);
    let sides = SIDES.map(|backend| backend.per_triangle(shapes.clone()));
    let by_default = SIDES.map(|backend| {
        let mut dispatcher = backend.dispatcher();
        dispatcher.prepare(shapes.clone());
        dispatcher
    });
    progress.phase("poses and brute force", cases.len());
    let cases: Vec<Case> = parallel::map(&cases, parallel::threads(), |index, case| {
        let case = case.clone().judged(index, &sides);
        progress.step();
        case
    });
    let mut rows: Vec<Row> = cases.iter().flat_map(Case::exactness).collect();
    progress.phase("speed", plan.meshes.len());
    for case in cases.iter().filter(|case| [case.size, case.prediction] == SPEED_CASE) {
        rows.extend(case.speed(&sides, &by_default, plan.repeats));
        progress.step();
    }
    Results::new("contacts", rows)
}

impl Case<'_> {
    /// Finds the places and judges first queries there. The seeds of a case depend on its index,
    /// and not on the order in which threads take cases.
    fn judged(mut self, index: usize, sides: &[Dispatcher; 2]) -> Self {
        let seeds = (0..self.approach_count).map(|approach| (index << 16 | approach) as u64);
        self.places = seeds.flat_map(|seed| self.places_of(&sides[1], seed)).collect();
        self.errors = Sequence::errors(&self.sequences(Mode::Fresh, usize::MAX), sides, |_| true);
        self
    }

    /// Places of one approach, from apart to deep inside.
    fn places_of(&self, dispatcher: &SharedDispatcher, seed: u64) -> [Place; 5] {
        let Self { size, prediction, ref shape, .. } = *self;
        let approach = Approach::random(dispatcher, [shape; 2], &mut Rand32::new(seed));
        let is_small = |place: &Place| {
            let pair = Mode::Fresh.sequence([shape; 2], place, prediction);
            pair.first_answer(dispatcher).len() <= PAIR_LIMIT
        };
        // Advances beyond the first touch, all within the prediction distance.
        let first = -0.95 * prediction;
        [first, -0.5 * prediction, 0.0, 0.02 * size, 0.06 * size].map(|advance| {
            let ways = (0..=HALVINGS).rev().map(|k| first + (advance - first) * 0.5f32.powi(k));
            let places = ways.map(|way| approach.place(way));
            places.take_while(is_small).last().unwrap_or(approach.place(first))
        })
    }

    fn sequences(&self, mode: Mode, limit: usize) -> Vec<Sequence> {
        let places = self.places.iter().take(limit);
        places.map(|place| mode.sequence([&self.shape; 2], place, self.prediction)).collect()
    }

    fn row(&self, study: &'static str, backend: impl ToString) -> Row {
        let row = Row::new(study, backend).key("mesh", &self.mesh.name);
        row.key("triangle_count", self.mesh.triangle_count())
    }

    fn exactness(&self) -> Vec<Row> {
        let rows = SIDES.into_iter().zip(&self.errors).map(|(backend, errors)| {
            self.row(EXACTNESS, backend)
                .key("size", format!("{:?}", self.size))
                .key("prediction", self.prediction)
                .with("pose_count", self.places.len())
                .with("errors", errors)
        });
        rows.collect()
    }

    /// Times of first queries, and of queries in motion.
    fn speed(
        &self,
        sides: &[Dispatcher; 2],
        by_default: &[Dispatcher; 2],
        repeats: usize,
    ) -> Vec<Row> {
        let affordable = REPEATED_TRIANGLES / self.mesh.triangle_count().max(1);
        let repeats = affordable.min(MOST_REPEATS).max(repeats);
        let mut rows = Vec::new();
        for mode in Mode::ALL {
            let is_fresh = mode == Mode::Fresh;
            let sequences = self.sequences(mode, if is_fresh { usize::MAX } else { MOTION_LIMIT });
            let is_judged = |step| step == STEP_COUNT / 2 || step == STEP_COUNT;
            let errors = match is_fresh {
                true => self.errors.clone(),
                false => Sequence::errors(&sequences, sides, is_judged),
            };
            let row = self.row(QUERIES, "").key("mode", mode);
            rows.extend(pair::rows(sides, &row, repeats, &sequences, &errors));
            let row = self.row(DEFAULTS, "").key("mode", mode);
            rows.extend(pair::timed_rows(by_default, &row, repeats, &sequences));
        }
        rows
    }
}
