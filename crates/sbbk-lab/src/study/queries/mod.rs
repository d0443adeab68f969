//! Queries that want one answer about two meshes (distance, intersection, casts), stock Parry
//! beside SBBK.
//!
//! Each mesh is asked about itself at *places*: crossing, hardly apart, near and far. Both
//! dispatchers answer the same questions in turn; every answer judged is compared with brute force
//! in f64.

mod ask;
mod export;
mod judge;

use oorandom::Rand32;
use rapier3d::geometry::SharedShape;

use self::ask::{Answered, Distance, Placed, Query, ask};
pub use self::export::export;
use self::judge::{Judge, QueryErrors};
use super::motion::Approach;
use super::pair::Contest;
use super::shape;
use super::turns::{race, timed};
use crate::backend::{Backend, SharedDispatcher};
use crate::mesh::{self, Mesh};
use crate::parallel;
use crate::progress::Progress;
use crate::report::{Results, Row, Table, TableSpec, faster, number, time};

const QUERIES: &str = "queries, µs";
/// Longest side of the meshes, in units.
const SIZE: f32 = 2.0;

/// What to ask, and how thoroughly.
#[derive(Clone, Debug)]
pub struct QueriesPlan {
    /// The meshes, scaled to two units.
    pub meshes: Vec<QueriedMesh>,
    /// How many poses of each place are judged, at most.
    pub judged: usize,
    /// How often all queries are timed.
    pub repeats: usize,
}

/// A mesh, and how often it is asked at every place.
#[derive(Clone, Debug)]
pub struct QueriedMesh {
    /// The mesh.
    pub mesh: Mesh,
    /// Poses at each place.
    pub pose_count: usize,
}

impl QueriesPlan {
    /// Meshes of 288 to 20,000 triangles, within two minutes.
    pub fn standard() -> Self {
        let meshes = [
            (mesh::monkey_head_with(6), 20),
            (mesh::monkey_head_with(11), 12),
            (mesh::helicopter(), 6),
            (mesh::torus(0.7, 0.3, 72, 35), 5),
            (mesh::monkey_head_with(50), 3),
        ];
        let meshes = meshes.map(|(mesh, pose_count)| QueriedMesh { mesh, pose_count });
        Self { meshes: meshes.into(), judged: 4, repeats: 3 }
    }

    /// The two smallest meshes, for trying.
    pub fn quick() -> Self {
        let standard = Self::standard();
        let meshes = standard.meshes.into_iter().take(2);
        let meshes = meshes.map(|mesh| QueriedMesh { pose_count: 8, ..mesh }).collect();
        Self { meshes, ..standard }
    }
}

/// Measures all that `plan` asks for.
pub fn queries(plan: &QueriesPlan, progress: &Progress) -> Results {
    let row_count: usize = Query::ALL.map(|query| query.distances().len()).into_iter().sum();
    progress.phase("queries", row_count * plan.meshes.len());
    let mut rows = Vec::new();
    for QueriedMesh { mesh, pose_count } in &plan.meshes {
        let asked = Asked::new(mesh);
        let is_asked = |query: &Query| mesh.triangle_count() <= query.largest_mesh();
        for query in Query::ALL.into_iter().filter(is_asked) {
            for &distance in query.distances() {
                let placed = asked.places(distance, *pose_count);
                let measured = asked.measure(plan, query, &placed);
                rows.extend(measured.map(|row| {
                    row.key("mesh", &*mesh.name)
                        .key("triangle_count", mesh.triangle_count())
                        .key("query", query.to_string())
                        .key("place", distance.to_string())
                        .with("pose_count", pose_count)
                }));
                progress.step();
            }
        }
    }
    progress.finish();
    rows.sort_by_key(|row| Query::ALL.into_iter().position(|query| row.is("query", query)));
    let tables = tables(&rows);
    Results::new("queries of two meshes".to_owned(), rows, tables)
}

/// A mesh of size [`SIZE`], and both dispatchers, which have met it.
struct Asked {
    shape: SharedShape,
    contest: Contest,
    judge: Judge,
}

impl Asked {
    fn new(mesh: &Mesh) -> Self {
        let shape = shape(&mesh.clone().centred().scaled_to(SIZE));
        Self { contest: Contest::new([&shape]), judge: Judge::new(&shape, SIZE), shape }
    }

    /// Poses at a distance: the second mesh comes in a random orientation, along a random
    /// direction.
    fn places(&self, distance: Distance, count: usize) -> Vec<Placed> {
        let mut random = Rand32::new(1);
        let place = |_| {
            let approach = Approach::random(self.contest.sbbk(), [&self.shape; 2], &mut random);
            approach.place(-distance.back() * SIZE)
        };
        (0..count).map(place).collect()
    }

    /// The answers of one dispatcher.
    fn ask(&self, query: Query, dispatcher: &SharedDispatcher, places: &[Placed]) -> Vec<Answered> {
        places.iter().map(|placed| ask(query, dispatcher, &self.shape, placed, SIZE)).collect()
    }

    fn measure(
        &self,
        plan: &QueriesPlan,
        query: Query,
        places: &[Placed],
    ) -> impl Iterator<Item = Row> {
        let scale = 1e6 / places.len().max(1) as f64;
        let times = race(&self.contest.dispatchers, plan.repeats, scale, |dispatcher| {
            timed(|| std::hint::black_box(self.ask(query, dispatcher, places))).0
        });
        let sides = Contest::BACKENDS.into_iter().zip(&self.contest.dispatchers).zip(times);
        sides.map(move |((backend, dispatcher), time)| {
            let answers = self.ask(query, dispatcher, places);
            let judged: Vec<_> = places.iter().zip(&answers).take(plan.judged).collect();
            let errors = parallel::map(&judged, parallel::threads(), |_, (placed, answer)| {
                self.judge.judge(query, placed, **answer)
            });
            let errors: QueryErrors = errors.into_iter().sum();
            Row::new(QUERIES, backend).with("time", time).with("errors", errors)
        })
    }
}

fn tables(rows: &[Row]) -> Vec<Table> {
    let ratio = || faster("ratio", "time.median", Backend::Stock).of("sbbk");
    let all = TableSpec::new(
        "Queries about each mesh and itself, 2 units across, microseconds",
        QUERIES,
        &["query", "place", "mesh", "triangle_count"],
        [
            number("poses", "pose_count").of("sbbk"),
            time("stock", "time").of("stock"),
            time("sbbk", "time").of("sbbk"),
            ratio(),
            number("judged", "errors.judged").of("sbbk"),
            number("wrong, stock", "errors.wrong").of("stock"),
            number("largest error", "errors.largest").of("stock"),
            number("wrong, sbbk", "errors.wrong").of("sbbk"),
            number("largest error", "errors.largest").of("sbbk"),
        ],
    )
    .note("times: min / median over the repeats, both in turn; ratios: of medians")
    .note(
        "errors against brute force in f64: wrong answers of those judged, and the largest \
         error of the others in sizes of the mesh (for casts: the distance left at the time of \
         impact)",
    );
    let means = TableSpec::new(
        "How many times faster than stock: geometric means over meshes and places",
        QUERIES,
        &["query"],
        [
            ratio(),
            number("judged", "errors.judged").of("sbbk"),
            number("wrong, stock", "errors.wrong").of("stock"),
            number("wrong, sbbk", "errors.wrong").of("sbbk"),
        ],
    );
    [all, means].map(|spec| spec.of(rows)).into()
}
