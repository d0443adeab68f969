//! Contacts of mesh pairs at every scale, stock Parry beside SBBK: how many are right, and what
//! they cost.
//!
//! A *case* is one mesh at one size, asked for its contacts with itself within one prediction
//! distance. Its poses come from *approaches*: one copy comes along a random direction, in a random
//! orientation, and is stopped at five places from nearly apart to deep inside. Every answer is
//! compared with brute force in f64, and both dispatchers answer in turn.

use oorandom::Rand32;
use rapier3d::geometry::SharedShape;
use rapier3d::math::Real;
use serde_json::Value;

use super::motion::{Approach, Mode, Place, STEP_COUNT, mode_notes};
use super::pair::{Contest, DIRECT_NOTE};
use super::shape;
use crate::backend::Memory;
use crate::mesh::{self, Mesh};
use crate::metrics::{ContactErrors, Sequence, geometric_mean};
use crate::parallel;
use crate::progress::Progress;
use crate::report::{Results, Row, TIME_NOTE, Table, TableSpec, number, sides};

const EXACTNESS: &str = "contacts: exactness";
const QUERIES: &str = "contacts: queries, µs";

/// What the columns of errors hold.
pub(super) const ERROR_NOTE: &str =
    "errors: missed + phantom + wrong depth + wrong normal, of the true pairs judged";

/// A mesh and how often it is approached in each case.
#[derive(Clone, Debug)]
pub struct ApproachedMesh {
    /// The mesh; sizes are made by scaling it.
    pub mesh: Mesh,
    /// Approaches, of five poses each.
    pub approach_count: usize,
}

/// What to compare, and how thoroughly.
#[derive(Clone, Debug)]
pub struct ContactsPlan {
    /// The meshes, in the order of the tables.
    pub meshes: Vec<ApproachedMesh>,
    /// Longest sides, in units.
    pub sizes: Vec<Real>,
    /// Prediction distances, in units.
    pub predictions: Vec<Real>,
    /// How often the queries of each case are timed; once where there are very many contacts.
    pub case_repeats: usize,
    /// How often those of the speed tables are, at least.
    pub speed_repeats: usize,
}

/// Repeats of short measurements.
const SHORT_REPEATS: usize = 25;
/// Triangles in all repeats of the speed tables together: short queries are repeated more often.
const REPEATED_TRIANGLES: usize = 25_000;
/// True pairs in all repeats of a case together: the few cases with hundreds of thousands of
/// contacts, for which stock Parry takes seconds a query, are timed once.
const REPEATED_PAIRS: usize = 500_000;
/// Size and prediction distance, in units, of the cases whose speed is measured: Rapier's default
/// distance, and meshes of the size that it is made for.
const SPEED_CASE: [Real; 2] = [2.0, 0.02];
/// At most this many motions a mesh.
const MOTION_LIMIT: usize = 20;
/// Where there would be more contacts than these, the approach ends earlier: two meshes of 70,000
/// triangles, a tenth of a unit long, have tens of millions within 0.02 units. Higher: minutes and
/// gigabytes for the same verdict. Lower: meshes touch and cross in fewer cases.
const PAIR_LIMIT: usize = 40_000;
/// The way to a place is halved at most so often to stay below the limit.
const HALVINGS: i32 = 7;

impl ContactsPlan {
    /// Six meshes of 288 to 70,688 triangles, three sizes, three prediction distances, 1125 poses;
    /// within three minutes on two cores.
    pub fn standard() -> Self {
        let approached = |mesh, approach_count| ApproachedMesh { mesh, approach_count };
        Self {
            // Pieces of a mesh with many triangles are many poses in themselves.
            meshes: vec![
                approached(mesh::monkey_head_with(6), 8),
                approached(mesh::monkey_head_with(11), 6),
                approached(mesh::helicopter(), 4),
                approached(mesh::torus(0.7, 0.3, 72, 35), 4),
                approached(mesh::monkey_head_with(50), 2),
                approached(mesh::monkey_head_with(94), 1),
            ],
            sizes: vec![0.1, 2.0, 40.0],
            predictions: vec![0.001, 0.002, 0.02],
            case_repeats: 3,
            speed_repeats: 5,
        }
    }

    /// The same cases of the four smaller meshes, one approach each, within half a minute: for
    /// trying, not for quoting.
    pub fn quick() -> Self {
        let standard = Self::standard();
        let small = standard.meshes.into_iter().take(4);
        Self {
            meshes: small.map(|mesh| ApproachedMesh { approach_count: 1, ..mesh }).collect(),
            case_repeats: 1,
            speed_repeats: 3,
            ..standard
        }
    }

    /// Number of poses over all cases.
    pub fn pose_count(&self) -> usize {
        let approaches: usize = self.meshes.iter().map(|mesh| mesh.approach_count).sum();
        approaches * advances(0.0, 0.0).len() * self.sizes.len() * self.predictions.len()
    }
}

/// One mesh at one size against itself, with one prediction distance.
#[derive(Clone)]
struct Case<'a> {
    mesh: &'a ApproachedMesh,
    size: Real,
    prediction: Real,
    shape: &'a SharedShape,
    places: Vec<Place>,
    /// Of first queries at all places, by stock and SBBK.
    errors: [ContactErrors; 2],
}

/// Measures all that `plan` asks for.
pub fn contacts(plan: &ContactsPlan, progress: &Progress) -> Results {
    let mut shapes = Vec::new();
    for mesh in &plan.meshes {
        for &size in &plan.sizes {
            shapes.push((mesh, size, shape(&mesh.mesh.clone().centred().scaled_to(size))));
        }
    }
    let contest = Contest::new(shapes.iter().map(|(_, _, shape)| shape));
    let cases: Vec<Case> = shapes
        .iter()
        .flat_map(|(mesh, size, shape)| {
            plan.predictions
                .iter()
                .map(move |&prediction| Case::new(mesh, *size, prediction, shape))
        })
        .collect();
    progress.phase("poses and brute force", cases.len());
    let cases: Vec<Case> = parallel::map(&cases, parallel::threads(), |index, case| {
        let case = case.clone().posed(index, &contest).judged(&contest);
        progress.step();
        case
    });
    progress.phase("first queries", cases.len());
    let mut rows: Vec<Row> = Vec::new();
    for case in &cases {
        rows.extend(case.exactness(&contest, plan.case_repeats));
        progress.step();
    }
    let speed_cases = cases.iter().filter(|case| [case.size, case.prediction] == SPEED_CASE);
    progress.phase("speed", plan.meshes.len());
    for case in speed_cases {
        rows.extend(case.speed(&contest, plan.speed_repeats));
        progress.step();
    }
    progress.finish();
    let uncrossed = cases.iter().filter(|case| case.true_pairs()[1] == 0).count();
    let tables = tables(&rows, uncrossed);
    Results::new(verdict(&rows), rows, tables)
}

fn verdict(rows: &[Row]) -> String {
    let of = |backend: &str, study: &str| -> Vec<&Row> {
        rows.iter().filter(|row| row.study == study && row.is("backend", backend)).collect()
    };
    let wrong =
        |backend| -> u64 { of(backend, EXACTNESS).iter().map(|row| row.wrong("errors")).sum() };
    let all: u64 = of("sbbk", EXACTNESS).iter().map(|row| row.count("errors.true_pairs")).sum();
    let speed = |mode: Mode| {
        let pairs = of("stock", QUERIES).into_iter().zip(of("sbbk", QUERIES));
        let pairs = pairs.filter(|(row, _)| row.is("mode", mode));
        let ratios = pairs.map(|(a, b)| a.number("time.min") / b.number("time.min"));
        geometric_mean(ratios).unwrap_or(f64::NAN)
    };
    format!(
        "of {all} true contacts SBBK has {} wrong, stock {}; SBBK is {:.1} times as fast in first \
         queries, {:.1} and {:.1} times in slow and fast motion",
        wrong("sbbk"),
        wrong("stock"),
        speed(Mode::Fresh),
        speed(Mode::SLOW),
        speed(Mode::FAST)
    )
}

/// How far the second mesh goes beyond the first touch, in units; negative: short of it. The
/// distance of the meshes is at most the way back to where they touch, so that they are within the
/// prediction distance at all places.
fn advances(size: Real, prediction: Real) -> [Real; 5] {
    [-0.95 * prediction, -0.5 * prediction, 0.0, 0.02 * size, 0.06 * size]
}

/// The places of one approach of a mesh to itself, from apart to deep inside.
pub(super) fn places(
    contest: &Contest,
    shape: &SharedShape,
    size: Real,
    prediction: Real,
    seed: u64,
) -> Vec<Place> {
    let approach = Approach::random(contest.sbbk(), [shape; 2], &mut Rand32::new(seed));
    let is_small = |place: &Place| {
        let mut memory = Memory::default();
        memory.ask(contest.sbbk(), [&**shape; 2], &place.pos12, prediction);
        memory.manifolds.len() <= PAIR_LIMIT
    };
    let advances = advances(size, prediction);
    let first = advances[0];
    let place = |advance: Real| {
        let ways = (0..=HALVINGS).rev().map(|k| first + (advance - first) * 0.5f32.powi(k));
        let places = ways.map(|way| approach.place(way));
        places.take_while(is_small).last().unwrap_or(approach.place(first))
    };
    advances.map(place).into()
}

impl<'a> Case<'a> {
    fn new(mesh: &'a ApproachedMesh, size: Real, prediction: Real, shape: &'a SharedShape) -> Self {
        Self { mesh, size, prediction, shape, places: Vec::new(), errors: Default::default() }
    }

    /// With its places. Each approach has a seed of its own, so that the poses do not depend on the
    /// order in which the cores find them.
    fn posed(mut self, index: usize, contest: &Contest) -> Self {
        let seeds = (0..self.mesh.approach_count).map(|approach| (index << 16 | approach) as u64);
        self.places = seeds
            .flat_map(|seed| places(contest, self.shape, self.size, self.prediction, seed))
            .collect();
        self
    }

    /// With what is true, and what is wrong with the answers of both.
    fn judged(mut self, contest: &Contest) -> Self {
        self.errors = contest.mesh_errors(&self.sequences(Mode::Fresh, usize::MAX), |_| true);
        self
    }

    /// The true contacts, and those of them that cross.
    fn true_pairs(&self) -> [usize; 2] {
        let pairs = self.errors[0].pairs;
        [pairs.true_pairs, pairs.crossing]
    }

    /// What is asked in a mode.
    fn sequences(&self, mode: Mode, limit: usize) -> Vec<Sequence> {
        let places = self.places.iter().take(limit);
        places.map(|place| mode.sequence([self.shape; 2], place, self.prediction)).collect()
    }

    fn row(&self, study: &'static str, backend: impl ToString) -> Row {
        let row = Row::new(study, backend).key("mesh", &*self.mesh.mesh.name);
        row.key("triangle_count", self.mesh.mesh.triangle_count())
    }

    fn exactness(&self, contest: &Contest, repeats: usize) -> impl Iterator<Item = Row> {
        let [true_pairs, crossing] = self.true_pairs();
        let affordable = REPEATED_PAIRS / true_pairs.max(1);
        let sequences = self.sequences(Mode::Fresh, usize::MAX);
        let times = contest.race(affordable.clamp(1, repeats.max(1)), &sequences);
        let sides = Contest::BACKENDS.into_iter().zip(times).zip(self.errors);
        sides.map(move |((backend, time), errors)| {
            self.row(EXACTNESS, backend)
                .key("size", decimal(self.size))
                .key("prediction", decimal(self.prediction))
                .with("pose_count", self.places.len())
                .with("apart", true_pairs - crossing)
                .with("crossing", crossing)
                .with("time", time)
                .with("errors", errors)
        })
    }

    /// First queries, and queries in motion.
    fn speed(&self, contest: &Contest, repeats: usize) -> Vec<Row> {
        let affordable = REPEATED_TRIANGLES / self.mesh.mesh.triangle_count().max(1);
        let repeats = affordable.min(SHORT_REPEATS).max(repeats);
        let rows = Mode::ALL.into_iter().flat_map(|mode| {
            let is_fresh = mode == Mode::Fresh;
            let sequences = self.sequences(mode, if is_fresh { usize::MAX } else { MOTION_LIMIT });
            let times = contest.race(repeats, &sequences);
            let errors = match is_fresh {
                true => self.errors,
                false => contest
                    .mesh_errors(&sequences, |step| step == STEP_COUNT / 2 || step == STEP_COUNT),
            };
            let sides = Contest::BACKENDS.into_iter().zip(times).zip(errors);
            let rows = sides.map(|((backend, time), errors)| {
                let row = self.row(QUERIES, backend).key("mode", mode.to_string());
                row.with("sequence_count", sequences.len())
                    .with("time", time)
                    .with("errors", errors)
            });
            rows.collect::<Vec<_>>()
        });
        rows.collect()
    }
}

/// As it is written: 0.1 as an f32 is not 0.1 as an f64.
fn decimal(value: Real) -> Value {
    value.to_string().parse::<f64>().unwrap_or(f64::NAN).into()
}

fn tables(rows: &[Row], uncrossed: usize) -> Vec<Table> {
    let exactness = |title: &str, keys, notes| {
        let truth = [("poses", "pose_count"), ("true, apart", "apart"), ("crossing", "crossing")];
        let wrong = [
            ("missed", "errors.missed"),
            ("phantom", "errors.phantom"),
            ("wrong depth", "errors.wrong_depth"),
            ("wrong normal", "errors.wrong_normal"),
        ];
        let truth = truth.map(|(header, path)| number(header, path).of("sbbk"));
        let wrong = Contest::BACKENDS.into_iter().flat_map(|backend| {
            wrong.map(|(header, path)| number(&format!("{backend}: {header}"), path).of(backend))
        });
        TableSpec::new(title, EXACTNESS, keys, truth.into_iter().chain(wrong))
            .total(0)
            .notes(notes)
            .of(rows)
    };
    let speed = |title: String, study, of: Vec<_>, notes: Vec<String>| {
        let common = [TIME_NOTE, ERROR_NOTE, DIRECT_NOTE].map(str::to_owned);
        TableSpec::new(
            title,
            study,
            &["mode", "mesh", "triangle_count"],
            of.into_iter().chain(sides()),
        )
        .total(1)
        .notes([mode_notes(), notes, common.into()].concat())
        .of(rows)
    };
    let [size, prediction] = SPEED_CASE;
    vec![
        exactness("Exactness by size: all meshes", &["size", "prediction"], Vec::new()),
        exactness(
            "Exactness by mesh: all sizes and distances",
            &["mesh", "triangle_count"],
            vec![
                "pairs of triangles, against brute force in f64; true: within the prediction \
                 distance, with a band of 1 % of it for missed and phantom; wrong depth: off by \
                 more than 5 % of it"
                    .to_owned(),
                "wrong normal: off by more than 0.1 degrees, where the depth is right and the true \
                 normal the only one"
                    .to_owned(),
                format!(
                    "poses: from 0.95 prediction distances apart to 6 % of the size inside; less \
                     deep where there would be more than {PAIR_LIMIT} contacts, so that nothing \
                     crosses in {uncrossed} cases"
                ),
                DIRECT_NOTE.to_owned(),
            ],
        ),
        speed(
            format!(
                "Speed of mesh pairs: {size} units across, prediction distance {prediction}; \
                 microseconds a query"
            ),
            QUERIES,
            vec![number("poses or motions", "sequence_count").of("sbbk")],
            vec!["errors of motions: in their middle and at their end".to_owned()],
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Would catch a grid with a hole, and a plan that promises more than it asks.
    #[test]
    fn the_standard_plan_is_a_full_grid_of_a_thousand_poses() {
        let plan = ContactsPlan::standard();
        let counts = plan.meshes.iter().map(|mesh| mesh.mesh.triangle_count());
        assert_eq!(counts.collect::<Vec<_>>(), [288, 968, 2596, 5040, 20_000, 70_688]);
        assert_eq!((plan.pose_count(), ContactsPlan::quick().pose_count()), (1125, 180));
    }
}
