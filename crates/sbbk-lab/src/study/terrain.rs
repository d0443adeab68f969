//! A mesh on terrains of growing size: the terrain as a height field and as a mesh of the same triangles.
//!
//! Stock Rapier knows the second only. A head stands on the terrain at random places and is asked there for the first time, and
//! then in slow motion with what the query before left. All answers are judged by brute force over the triangles.

use std::convert::Infallible;
use std::time::{Duration, Instant};

use glamx::{Pose3, Quat, Vec3};
use oorandom::Rand32;
use rapier_integration::{SbbkConfig, SbbkDispatcher};
use rapier3d::geometry::{ContactManifold, SharedShape};
use rapier3d::math::Real;
use rapier3d::parry::query::{DefaultQueryDispatcher, QueryDispatcher};
use serde::Serialize;

use super::contacts::{Contest, Memory, SLOW, STEP_COUNT};
use super::turns::in_turn;
use super::{Progress, StudyError};
use crate::backend::{Answer, Question, Reported, SharedDispatcher};
use crate::mesh;
use crate::metrics::{Environment, ErrorCount, Judge, Summary};
use crate::scene::{HeadsOnTerrain, SceneError};

/// Rapier's, in units.
const PREDICTION: Real = 0.02;

/// What to compare, and how thoroughly.
#[derive(Clone, Debug)]
pub struct TerrainPlan {
    /// Cells along the sides of the terrains.
    pub cells: Vec<u32>,
    /// Places on each.
    pub place_count: usize,
    /// How often each measurement is repeated.
    pub repeats: usize,
}

impl TerrainPlan {
    /// From a thousand cells to a million; half a minute on two cores.
    pub fn standard() -> Self {
        Self { cells: vec![32, 100, 316, 1000], place_count: 12, repeats: 15 }
    }

    /// For trying, not for quoting: some seconds.
    pub fn quick() -> Self {
        Self { cells: vec![32, 100], place_count: 4, repeats: 3 }
    }
}

/// All that [`terrain`] found.
#[derive(Clone, Debug, Serialize)]
pub struct Terrain {
    /// Machine and build.
    pub environment: Environment,
    /// By terrain, and who answered for what.
    pub rows: Vec<TerrainRow>,
}

/// One terrain, one way to answer.
#[derive(Clone, Debug, Serialize)]
pub struct TerrainRow {
    /// Cells along the side.
    pub cells: u32,
    /// Who answered, and what the terrain was.
    pub way: &'static str,
    /// Microseconds of a first query, by repeat; trees are built.
    pub fresh: Summary,
    /// Microseconds of a query in slow motion, by repeat.
    pub steady: Summary,
    /// Contacts lost, added and wrong, of all answers.
    pub errors: ErrorCount,
    /// Cells whose heights a first query reads, on the mean; for fields.
    pub visited: Option<f64>,
}

/// A terrain and who answers for it.
struct Way<'a> {
    name: &'static str,
    dispatcher: &'a SharedDispatcher,
    ground: &'a SharedShape,
}

/// Measures all that `plan` asks for.
///
/// Errors: none but those of a mesh without triangles, which these are not.
pub fn terrain(plan: &TerrainPlan, progress: &Progress) -> Result<Terrain, StudyError> {
    progress.phase("terrains", plan.cells.len());
    let mut rows = Vec::new();
    for &cells in &plan.cells {
        rows.extend(of_size(plan, cells)?);
        progress.step();
    }
    progress.finish();
    Ok(Terrain { environment: Environment::detect(), rows })
}

fn of_size(plan: &TerrainPlan, cells: u32) -> Result<Vec<TerrainRow>, StudyError> {
    let shared = |mesh: &mesh::Mesh| {
        mesh.shared_shape().map_err(|cause| SceneError { mesh: mesh.name.clone(), cause })
    };
    let head = shared(&mesh::monkey_head().centred().scaled_to(2.0))?;
    let ground = shared(&HeadsOnTerrain::terrain(cells))?;
    let field = SharedShape::new(HeadsOnTerrain::field(cells));
    let contest = Contest::new([&head, &ground].into_iter());
    let [stock, sbbk] = &contest.dispatchers;
    let ways = [
        Way { name: "stock, mesh", dispatcher: stock, ground: &ground },
        Way { name: "sbbk, mesh", dispatcher: sbbk, ground: &ground },
        Way { name: "sbbk, height field", dispatcher: sbbk, ground: &field },
    ];
    let mut random = Rand32::new(u64::from(cells));
    let places = (0..plan.place_count).map(|_| place(&mut random, &head, &ground, cells));
    let motions: Vec<Vec<Pose3>> = places.map(motion).collect();
    let fresh = times(plan, &ways, |way| way.fresh(&head, &motions));
    let steady = times(plan, &ways, |way| way.steady(&head, &motions));
    let judge = Judge::new([&ground, &head]);
    let rows = ways.iter().zip(fresh).zip(steady).map(|((way, fresh), steady)| TerrainRow {
        cells,
        way: way.name,
        fresh,
        steady,
        errors: way.errors(&judge, (&ground, &head), cells, &motions),
        visited: way.ground.as_heightfield().map(|_| visited(&head, &field, &motions)),
    });
    Ok(rows.collect())
}

/// Microseconds a query, by way.
fn times(
    plan: &TerrainPlan,
    ways: &[Way<'_>; 3],
    sweep: impl Fn(&Way<'_>) -> (Duration, usize),
) -> Vec<Summary> {
    let Ok(times) = in_turn(ways, plan.repeats.max(1), |way, _| {
        let (time, count) = sweep(way);
        Ok::<_, Infallible>(1e6 * time.as_secs_f64() / count as f64)
    });
    times.into_iter().filter_map(Summary::of).collect()
}

/// A pose of the head that touches the ground.
fn place(random: &mut Rand32, head: &SharedShape, ground: &SharedShape, cells: u32) -> Pose3 {
    let [x, z] = [(); 2].map(|()| 0.4 * cells as Real * (random.rand_float() - 0.5));
    let turn = Quat::from_rotation_y(6.0 * random.rand_float());
    let at = |y: Real| Pose3::from_parts(Vec3::new(x, y, z), turn);
    let touches = |y: Real| {
        let answer = DefaultQueryDispatcher.intersection_test(&at(y), &*ground.0, &*head.0);
        answer.is_ok_and(|answer| answer.intersecting)
    };
    let (mut below, mut above) = (-1.5, 3.0);
    for _ in 0..16 {
        let middle = 0.5 * (below + above);
        // A head that is deep in the ground touches it with its sides, one under it does not.
        *(if touches(middle) || middle < 0.0 { &mut below } else { &mut above }) = middle;
    }
    at(below - 0.2 * PREDICTION)
}

/// Slow motion along the ground.
fn motion(start: Pose3) -> Vec<Pose3> {
    let step = Vec3::X * SLOW * PREDICTION;
    let pose = |i: usize| Pose3::from_parts(start.translation + i as Real * step, start.rotation);
    (0..=STEP_COUNT).map(pose).collect()
}

impl Way<'_> {
    fn ask(&self, memory: &mut Memory, head: &SharedShape, pose: &Pose3) {
        memory.ask_pair(self.dispatcher, [&*self.ground.0, &*head.0], pose, PREDICTION);
    }

    fn fresh(&self, head: &SharedShape, motions: &[Vec<Pose3>]) -> (Duration, usize) {
        let start = Instant::now();
        for poses in motions {
            self.ask(&mut Memory::default(), head, &poses[0]);
        }
        (start.elapsed(), motions.len())
    }

    fn steady(&self, head: &SharedShape, motions: &[Vec<Pose3>]) -> (Duration, usize) {
        let mut time = Duration::ZERO;
        for poses in motions {
            let mut memory = Memory::default();
            self.ask(&mut memory, head, &poses[0]);
            let start = Instant::now();
            poses[1..].iter().for_each(|pose| self.ask(&mut memory, head, pose));
            time += start.elapsed();
        }
        (time, motions.len() * STEP_COUNT)
    }

    /// Judges the first and the last answer of each motion.
    fn errors(
        &self,
        judge: &Judge,
        (ground, head): (&SharedShape, &SharedShape),
        cells: u32,
        motions: &[Vec<Pose3>],
    ) -> ErrorCount {
        let mut errors = ErrorCount::default();
        for poses in motions {
            let mut memory = Memory::default();
            for (index, pose) in poses.iter().enumerate() {
                self.ask(&mut memory, head, pose);
                if index == 0 || index == STEP_COUNT {
                    let question = Question::new(pose, [&*ground.0, &*head.0], PREDICTION);
                    let reported = memory.manifolds.iter().filter_map(|m| self.reported(m, cells));
                    let answer = Answer { question, reported: reported.collect() };
                    errors += judge.truth(&question).judge(&answer);
                }
            }
        }
        errors
    }

    /// A manifold with the number that its triangle has in the mesh of the terrain.
    fn reported(&self, manifold: &ContactManifold, cells: u32) -> Option<Reported> {
        let distances = manifold.points.iter().map(|point| point.dist);
        let distance = distances.reduce(Real::min).filter(|&distance| distance <= PREDICTION)?;
        let id = manifold.subshape1;
        let triangle1 = match self.ground.as_heightfield() {
            None => id,
            Some(_) => {
                let (cell, side) = (id % (cells * cells), id / (cells * cells));
                2 * ((cell % cells) * cells + cell / cells) + side
            }
        };
        Some(Reported { triangle1, triangle2: manifold.subshape2, distance })
    }
}

/// Cells read by a first query, on the mean.
fn visited(head: &SharedShape, field: &SharedShape, motions: &[Vec<Pose3>]) -> f64 {
    let mut config = SbbkConfig::default();
    config.count_queries = true;
    let dispatcher = SbbkDispatcher::new(config);
    let shared: SharedDispatcher = std::sync::Arc::new(dispatcher.clone());
    for poses in motions {
        let mut memory = Memory::default();
        memory.ask_pair(&shared, [&*field.0, &*head.0], &poses[0], PREDICTION);
    }
    dispatcher.stats().descent.cells as f64 / motions.len().max(1) as f64
}
