//! What temporal coherence is worth: node tests, times and errors of descents that start where the
//! last one stopped, beside fresh ones, for pairs that move slowly, fast, rest with jitter, or
//! tumble.
//!
//! Every variant answers the same sequences of poses, from nothing known on, and all queries are
//! timed. Two times are taken: of the *traversal*, until the pairs of leaves are known, the frame
//! of the pose included; and of the whole *query*, until the pairs of triangles within the
//! prediction distance are known, exactly. These pairs are compared with those of fresh descents.
//!
//! Besides, the dispatcher as a user has it makes a *journey* through all places of a mesh in slow
//! motion, with a teleport from each place to the next, beside stock.

mod search;

use glamx::{Pose3, Quat, Vec3};
use oorandom::Rand32;
use rapier3d::geometry::{ContactManifold, SharedShape, TrackedContact};
use rapier3d::math::Real;
use sbbk_core::traverse::DescentCounts;
use sbbk_core::tree::{LayerPlan, Tree};

use self::search::{Search, Variant};
use super::contacts::{ERROR_NOTE, places};
use super::motion::{Place, motion};
use super::pair::Contest;
use super::turns::{race, timed};
use super::{Progress, shape, tree};
use crate::backend::{Memory, SharedDispatcher};
use crate::mesh::{self, Mesh};
use crate::metrics::{Sequence, Summary};
use crate::report::{
    Look, Panel, Results, Row, Scale, TIME_NOTE, Table, TableSpec, faster, number, sides, time,
};
use crate::scene::random;

const COHERENCE: &str = "front";
const JOURNEY: &str = "front: journey, µs";
/// Longest side of the meshes, in units, and the prediction distance: Rapier's default, and meshes
/// of the size that it is made for.
const SIZE: f32 = 2.0;
const PREDICTION: f32 = 0.02;
/// Steps of one motion, after its first query.
const STEP_COUNT: usize = 48;
/// Greatest shift of a resting pair from its place, and greatest way of a point one unit from its
/// centre by turning, in prediction distances: what the solver leaves of a body at rest.
const JITTER: Real = 0.02;
/// Turning of a tumbling pair, in radians a step: a bit less than a turn a second.
const TUMBLING: Real = 0.08;

/// What to compare, and how thoroughly.
#[derive(Clone, Debug)]
pub struct FrontPlan {
    /// The meshes, each against itself.
    pub meshes: Vec<Mesh>,
    /// Approaches of a mesh to itself, each with five places, from nearly apart to deep inside.
    pub approach_count: usize,
    /// How often everything is timed.
    pub repeats: usize,
}

impl FrontPlan {
    /// Five meshes of 288 to 12,168 triangles, ten places each; about a minute on two cores.
    pub fn standard() -> Self {
        let meshes = vec![
            mesh::monkey_head_with(6),
            mesh::monkey_head_with(11),
            mesh::helicopter(),
            mesh::torus(0.7, 0.3, 72, 35),
            mesh::monkey_head_with(39),
        ];
        Self { meshes, approach_count: 2, repeats: 7 }
    }

    /// Three of these meshes, one approach each, a few repeats: for trying, not for quoting.
    pub fn quick() -> Self {
        let mut standard = Self::standard();
        standard.meshes.truncate(3);
        Self { approach_count: 1, repeats: 3, ..standard }
    }
}

named! {
    /// How a pair moves.
    enum Motion {
        /// It slides and turns through the place, 0.05 prediction distances a step.
        Slow = "slow",
        /// The same, 0.5 prediction distances a step.
        Fast = "fast",
        /// It stays at the place, but for a shift and turn at random at each step.
        Resting = "resting, jitter",
        /// It turns on the spot, about a random axis.
        Tumbling = "tumbling",
    }
}

impl Motion {
    fn poses(self, shape: &SharedShape, place: &Place, random: &mut Rand32) -> Vec<Pose3> {
        let Pose3 { translation, rotation, .. } = place.pos12;
        match self {
            Self::Slow => motion(shape, place, 0.05 * PREDICTION, STEP_COUNT),
            Self::Fast => motion(shape, place, 0.5 * PREDICTION, STEP_COUNT),
            Self::Resting => {
                let mut number = || (2.0 * random.rand_float() - 1.0) * JITTER * PREDICTION;
                let mut jitter = || Vec3::from([(); 3].map(|()| number()));
                let pose = |_| {
                    let (shift, turn) = (jitter(), Quat::from_scaled_axis(jitter()));
                    Pose3::from_parts(translation + shift, turn * rotation)
                };
                (0..=STEP_COUNT).map(pose).collect()
            }
            Self::Tumbling => {
                let axis = random::direction(random);
                let turn = |step| Quat::from_axis_angle(axis, TUMBLING * step as Real) * rotation;
                (0..=STEP_COUNT).map(|step| Pose3::from_parts(translation, turn(step))).collect()
            }
        }
    }
}

/// A mesh that can be asked.
struct Posed<'a> {
    mesh: &'a Mesh,
    shape: SharedShape,
    tree: Tree,
    places: Vec<Place>,
}

/// Measures all that `plan` asks for.
pub fn front(plan: &FrontPlan, progress: &Progress) -> Results {
    let meshes = plan.meshes.iter().map(|mesh| Posed::new(mesh, plan.approach_count));
    let meshes: Vec<Posed> = meshes.collect();
    progress.phase("front", meshes.len() * (Motion::ALL.len() + 1));
    let mut rows = Vec::new();
    for motion in Motion::ALL {
        for posed in &meshes {
            rows.extend(posed.measure(motion, plan.repeats));
            progress.step();
        }
    }
    for posed in &meshes {
        rows.extend(posed.journey(plan.repeats));
        progress.step();
    }
    progress.finish();
    let panels = Motion::ALL.map(|motion| panel(&rows, motion)).into();
    let tables = tables(&rows);
    Results::new(rows, tables, panels)
}

impl<'a> Posed<'a> {
    fn new(mesh: &'a Mesh, approach_count: usize) -> Self {
        let scaled = mesh.clone().centred().scaled_to(SIZE);
        let shape = shape(&scaled);
        let contest = Contest::new([&shape]);
        let seeds = 0..approach_count as u64;
        let places = seeds.flat_map(|seed| places(&contest, &shape, SIZE, PREDICTION, seed));
        let places = places.collect();
        Self { mesh, tree: tree(&scaled, Some(LayerPlan::SBBK)), shape, places }
    }

    fn row(&self, study: &'static str, backend: impl ToString) -> Row {
        let row = Row::new(study, backend).key("mesh", &*self.mesh.name);
        row.key("triangle_count", self.mesh.triangle_count())
    }

    fn motions(&self, motion: Motion) -> Vec<Vec<Pose3>> {
        let mut random = Rand32::new(self.mesh.triangle_count() as u64);
        self.places.iter().map(|place| motion.poses(&self.shape, place, &mut random)).collect()
    }

    fn measure(&self, motion: Motion, repeats: usize) -> impl Iterator<Item = Row> {
        let motions = self.motions(motion);
        let query_count = motions.iter().map(Vec::len).sum::<usize>() as f64;
        let race = |ask: fn(&mut Search, &Pose3)| -> Vec<Summary> {
            race(&Variant::ALL, repeats, 1e6 / query_count, |&variant| {
                let times = motions.iter().map(|poses| {
                    let mut search = Search::new(variant, &self.tree, PREDICTION);
                    timed(|| poses.iter().for_each(|pose| ask(&mut search, pose))).0
                });
                times.sum()
            })
        };
        let traversal = race(|search, pose| _ = search.traverse(pose, ()));
        let query = race(|search, pose| search.query(pose));
        let fresh = self.answers(&motions, Variant::Fresh);
        let times = traversal.into_iter().zip(query);
        let rows = Variant::ALL.into_iter().zip(times).map(|(variant, (traversal, query))| {
            let found = self.answers(&motions, variant);
            let (mut counts, mut leaf_pairs, mut reused) = (DescentCounts::default(), 0, None);
            for poses in &motions {
                let mut search = Search::new(variant, &self.tree, PREDICTION);
                // Leaves that are reused are handed out again.
                let pairs = poses.iter().map(|pose| search.traverse(pose, &mut counts));
                leaf_pairs += pairs.sum::<usize>();
                reused = search.reused().map(|count| count + reused.unwrap_or(0));
            }
            let pairs: usize = found.iter().map(Vec::len).sum();
            let differing = found.iter().zip(&fresh).map(|(a, b)| differing(a, b));
            self.row(COHERENCE, variant)
                .key("motion", motion.to_string())
                .with("node_tests", counts.aabb_tests as f64 / query_count)
                .with("leaf_pairs", leaf_pairs as f64 / query_count)
                .with("reused", reused.map(|count| count as f64 / query_count))
                .with("traversal", traversal)
                .with("query", query)
                .with("pairs", pairs as f64 / query_count)
                .with("differing", differing.sum::<usize>())
        });
        rows.collect::<Vec<_>>().into_iter()
    }

    /// The sorted pairs of triangles of each query.
    fn answers(&self, motions: &[Vec<Pose3>], variant: Variant) -> Vec<Vec<(u32, u32)>> {
        let answers = motions.iter().flat_map(|poses| {
            let mut search = Search::new(variant, &self.tree, PREDICTION);
            poses.iter().map(move |pose| {
                search.query(pose);
                let mut pairs = search.pairs.clone();
                pairs.sort_unstable();
                pairs
            })
        });
        answers.collect()
    }

    /// Coherent motion with teleports, through the whole dispatcher.
    fn journey(&self, repeats: usize) -> impl Iterator<Item = Row> {
        let motions = self.motions(Motion::Slow);
        let shapes = [(); 2].map(|()| self.shape.clone());
        let sequence = Sequence { shapes, poses: motions.concat(), prediction: PREDICTION };
        let contest = Contest::new([&self.shape]);
        let times = contest.race(repeats, std::slice::from_ref(&sequence));
        // At the end of the motion through each place.
        let errors = contest.mesh_errors(std::slice::from_ref(&sequence), |step| {
            step % (STEP_COUNT + 1) == STEP_COUNT
        });
        let sides = Contest::BACKENDS.into_iter().zip(&contest.dispatchers).zip(times).zip(errors);
        let rows = sides.map(|(((backend, dispatcher), time), errors)| {
            self.row(JOURNEY, backend)
                .with("query_count", sequence.poses.len())
                .with("teleport_count", motions.len() - 1)
                .with("time", time)
                .with("errors", errors)
                .with("differing", differing_from_fresh(&sequence, dispatcher))
        });
        rows.collect::<Vec<_>>().into_iter()
    }
}

/// Number of pairs in one sorted list only.
fn differing(a: &[(u32, u32)], b: &[(u32, u32)]) -> usize {
    let missing = |from: &[(u32, u32)], other: &[(u32, u32)]| {
        from.iter().filter(|pair| other.binary_search(pair).is_err()).count()
    };
    missing(a, b) + missing(b, a)
}

/// Manifolds that differ from those of a fresh query in any bit of their triangles, points,
/// distances or normals, over all queries.
fn differing_from_fresh(sequence: &Sequence, dispatcher: &SharedDispatcher) -> usize {
    let mut differing = 0;
    sequence.walk(dispatcher, |step, kept| {
        let mut fresh = Memory::default();
        sequence.ask(&mut fresh, dispatcher, step);
        let fresh = &fresh.manifolds;
        let pairs = kept.iter().zip(fresh).filter(|(a, b)| !is_same(a, b));
        differing += kept.len().abs_diff(fresh.len()) + pairs.count();
    });
    differing
}

fn is_same(a: &ContactManifold, b: &ContactManifold) -> bool {
    fn geometry<C>(p: &TrackedContact<C>) -> impl PartialEq + use<C> {
        (p.local_p1, p.local_p2, p.dist, p.fid1, p.fid2)
    }
    [a.subshape1, a.subshape2] == [b.subshape1, b.subshape2]
        && [a.local_n1, a.local_n2] == [b.local_n1, b.local_n2]
        && a.points.iter().map(geometry).eq(b.points.iter().map(geometry))
}

fn tables(rows: &[Row]) -> Vec<Table> {
    let times_faster = |path| faster("times faster", path, Variant::Fresh);
    let note = "differing: triangle pairs within the prediction distance, against fresh descents; \
                all queries together";
    let notes = vec![TIME_NOTE.to_owned(), note.to_owned()];
    let details = TableSpec::new(
        "Coherence: each variant, for one query on average, microseconds",
        COHERENCE,
        &["motion", "triangle_count", "backend"],
        [
            number("node tests", "node_tests"),
            number("leaf pairs", "leaf_pairs"),
            time("traversal", "traversal"),
            times_faster("traversal.min"),
            time("query", "query"),
            times_faster("query.min"),
            number("true pairs", "pairs"),
            number("differing", "differing"),
        ],
    )
    .notes(notes.clone());
    let summary = TableSpec::new(
        "Coherence: times fewer and faster than fresh descents, geometric means over the \
                meshes",
        COHERENCE,
        &["motion", "backend"],
        [
            faster("node tests", "node_tests", Variant::Fresh),
            faster("traversal", "traversal.min", Variant::Fresh),
            faster("query", "query.min", Variant::Fresh),
            number("differing pairs", "differing"),
        ],
    )
    .notes(notes);
    let counts = [number("queries", "query_count"), number("teleports", "teleport_count")];
    let columns = counts.map(|column| column.of("sbbk")).into_iter().chain(sides());
    let journeys = TableSpec::new(
        "The dispatcher in slow motion with teleports: microseconds a query",
        JOURNEY,
        &["mesh", "triangle_count"],
        columns.chain([number("differing", "differing").of("sbbk")]),
    )
    .total(0)
    .note(format!("{TIME_NOTE}; 0.05 prediction distances a step"))
    .note(ERROR_NOTE)
    .note("differing: manifolds of sbbk that differ from a fresh query's in any bit");
    [details, summary, journeys].map(|spec| spec.of(rows)).into()
}

/// How many times faster than a fresh descent the variants are, by the size of the mesh.
fn panel(rows: &[Row], motion: Motion) -> Panel {
    let labels = ["triangles of each mesh", "times faster than fresh descents"];
    let panel = Panel::new(format!("Traversal, {motion}"), labels, Scale::Linear);
    let time = |variant: Variant| {
        let is_it = move |row: &&Row| row.is("backend", variant) && row.is("motion", motion);
        let point = |row: &Row| [row.number("triangle_count"), row.number("traversal.min")];
        rows.iter().filter(is_it).map(point)
    };
    Variant::ALL.into_iter().zip(Look::ALL).fold(panel, |panel, (variant, look)| {
        let points = time(Variant::Fresh).zip(time(variant));
        panel.line(
            &variant.to_string(),
            look,
            points.map(|([x, fresh], [_, own])| [x, fresh / own]),
        )
    })
}
