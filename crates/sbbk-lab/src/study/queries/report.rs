//! All of it in one go.

use std::convert::Infallible;
use std::time::Instant;

use rapier3d::geometry::SharedShape;
use rayon::prelude::*;
use serde::Serialize;

use super::super::turns::in_turn;
use super::super::{Progress, StudyError};
use super::answer::{Answered, Query, ask};
use super::judge::{Judge, QueryErrors};
use super::place::{Place, Placed, poses};
use super::plan::{QueriesPlan, SIZE};
use crate::backend::{Backend, Primed, SharedDispatcher};
use crate::metrics::{Environment, Summary, geometric_mean, ratio};
use crate::scene::SceneError;
use crate::study::contacts::CONTESTANTS;

/// All that [`queries`] found.
#[derive(Clone, Debug, Serialize)]
pub struct Queries {
    /// Machine and build.
    pub environment: Environment,
    /// By mesh, query and place.
    pub rows: Vec<QueryRow>,
}

/// One kind of question about one mesh.
#[derive(Clone, Debug, Serialize)]
pub struct QueryRow {
    /// Name of the mesh.
    pub mesh: String,
    /// Its triangles.
    pub triangle_count: usize,
    /// What was asked.
    pub query: Query,
    /// Where.
    pub place: Place,
    /// Poses asked at.
    pub pose_count: usize,
    /// Stock and SBBK.
    pub sides: [QuerySide; 2],
}

/// One dispatcher.
#[derive(Clone, Debug, Serialize)]
pub struct QuerySide {
    /// Who answered.
    pub backend: Backend,
    /// Microseconds a query, over the repeats.
    pub time: Summary,
    /// How wrong the answers were.
    pub errors: QueryErrors,
    /// The answers, pose by pose.
    #[serde(skip)]
    pub answers: Vec<Answered>,
}

impl QueryRow {
    /// How many times faster SBBK is, by medians.
    pub fn ratio(&self) -> Option<f64> {
        ratio(self.sides[0].time.median, self.sides[1].time.median)
    }
}

impl Queries {
    /// The geometric mean of the ratios of a query over meshes and places.
    pub fn mean_ratio(&self, query: Query) -> Option<f64> {
        let rows = self.rows.iter().filter(|row| row.query == query);
        geometric_mean(rows.filter_map(QueryRow::ratio))
    }
}

/// Stock and SBBK with the trees of a mesh built.
pub(super) struct Asked {
    pub shape: SharedShape,
    pub dispatchers: [SharedDispatcher; 2],
    _primed: [Primed; 2],
}

impl Asked {
    pub fn new(shape: SharedShape) -> Self {
        let dispatchers = CONTESTANTS.map(Backend::dispatcher);
        let primed = dispatchers.each_ref().map(|d| Primed::new(d, [&shape]));
        Self { shape, dispatchers, _primed: primed }
    }

    pub fn poses(&self, place: Place, count: usize) -> Vec<Placed> {
        poses(&self.dispatchers[1], &self.shape, SIZE, place, count)
    }
}

/// Measures all that `plan` asks for.
///
/// Errors: a mesh has no triangles.
pub fn queries(plan: &QueriesPlan, progress: &Progress) -> Result<Queries, StudyError> {
    let row_count: usize = Query::ALL.map(|query| query.places().len()).into_iter().sum();
    progress.phase("queries", row_count * plan.meshes.len());
    let mut rows = Vec::new();
    for (mesh, pose_count) in &plan.meshes {
        let sized = mesh.clone().centred().scaled_to(SIZE);
        let named = |cause| SceneError { mesh: mesh.name.clone(), cause };
        let asked = Asked::new(sized.shared_shape().map_err(named)?);
        let judge = Judge::new(&asked.shape, SIZE);
        let is_asked = |query: &Query| mesh.triangle_count() <= query.largest_mesh();
        for query in Query::ALL.into_iter().filter(is_asked) {
            for &place in query.places() {
                let poses = asked.poses(place, *pose_count);
                rows.push(QueryRow {
                    mesh: mesh.name.clone(),
                    triangle_count: mesh.triangle_count(),
                    query,
                    place,
                    pose_count: *pose_count,
                    sides: measure(plan, &asked, &judge, query, &poses),
                });
                progress.step();
            }
        }
    }
    progress.finish();
    Ok(Queries { environment: Environment::detect(), rows })
}

fn measure(
    plan: &QueriesPlan,
    asked: &Asked,
    judge: &Judge,
    query: Query,
    poses: &[Placed],
) -> [QuerySide; 2] {
    let sweep = |dispatcher: &SharedDispatcher| -> Vec<Answered> {
        poses.iter().map(|placed| ask(query, dispatcher, &asked.shape, placed, SIZE)).collect()
    };
    let answers = asked.dispatchers.each_ref().map(sweep);
    let Ok(times) = in_turn(&asked.dispatchers, plan.repeats.max(1), |dispatcher, _| {
        let start = Instant::now();
        std::hint::black_box(sweep(dispatcher));
        Ok::<_, Infallible>(1e6 * start.elapsed().as_secs_f64() / poses.len().max(1) as f64)
    });
    let mut times = times.into_iter().flat_map(Summary::of);
    let mut sides = CONTESTANTS.into_iter().zip(answers).map(|(backend, answers)| {
        let judged: Vec<_> = poses.iter().zip(&answers).take(plan.judged).collect();
        let errors = judged.par_iter().with_max_len(1);
        let errors: Vec<_> =
            errors.map(|(placed, answer)| judge.judge(query, placed, **answer)).collect();
        let time = times.next().expect("both contestants had at least one turn");
        QuerySide { backend, time, errors: errors.into_iter().sum(), answers }
    });
    [(); 2].map(|()| sides.next().expect("there are two contestants"))
}
