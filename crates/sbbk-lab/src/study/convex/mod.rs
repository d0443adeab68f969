//! A mesh against convex shapes and compounds of them, stock Parry beside SBBK: what queries cost,
//! and whether a contact is lost, added or at a wrong distance.
//!
//! The mesh comes towards a shape of each kind along random directions and is stopped at five
//! places around the first touch; the pair is asked there for the first time, and in slow and
//! faster motion through these places. The same ways are taken by small and large meshes and
//! shapes, asked for the first time. Brute force in f64 over all triangles near the shape tells the
//! truth.

pub(super) mod errors;
pub(super) mod kinds;

use glamx::{Pose3, Quat, Vec3};
use oorandom::Rand32;
use rapier3d::geometry::{ContactManifold, SharedShape};
use rapier3d::math::Real;

use self::errors::{Judge, Truth};
use self::kinds::{Kind, Upright, kinds};
use super::motion::{Approach, Mode, Place, mode_notes};
use super::pair::{Contest, DIRECT_NOTE, Sequence};
use super::{Progress, StudyError, shape};
use crate::mesh::{self, Mesh};
use crate::metrics::{Environment, ErrorCount};
use crate::report::{Panel, Results, Row, TIME_NOTE, Table, TableSpec, errors, number, sides};
use crate::scene::random;

/// What to compare, and how thoroughly.
#[derive(Clone, Debug)]
pub struct ConvexPlan {
    /// The mesh, asked against every kind of shape.
    pub mesh: Mesh,
    /// The prediction distance, in units.
    pub prediction: Real,
    /// Approaches to each shape, of five places each.
    pub approach_count: usize,
    /// Of these, the approaches that are taken at all sizes.
    pub sized_approach_count: usize,
    /// How often each measurement is repeated.
    pub repeats: usize,
}

/// How far beyond the first touch the mesh is stopped, in prediction distances: about to touch,
/// touching, and somewhat deeper than a body at rest is.
const ADVANCES: [Real; 5] = [-0.95, -0.5, 0.0, 0.5, 2.0];
/// Lengths of the mesh, in units, at which first queries are judged; the shapes and the prediction
/// distance shrink with it.
const SIZES: [f64; 3] = [0.01, 0.1, 2.0];
const SHAPES: &str = "convex: queries, µs";
const COMPOUNDS: &str = "compounds: queries, µs";
const SIZED: &str = "convex: sizes";
const ERRORS_NOTE: &str = "errors: missed + beyond + wrong distance, of the true contacts in all answers; the truth is \
                           brute force in f64. Missed: nearer than the prediction distance, and not reported; beyond: \
                           reported, and farther; 1 % of the prediction distance may go either way. Wrong: off by \
                           more than 5 % of it; how deep cylinders and cones cross is not judged";

impl ConvexPlan {
    /// The head of 968 triangles, two units across, Rapier's prediction distance; within three
    /// minutes on two cores.
    pub fn standard() -> Self {
        Self {
            mesh: mesh::monkey_head(),
            prediction: 0.02,
            approach_count: 6,
            sized_approach_count: 6,
            repeats: 25,
        }
    }

    /// For trying, not for quoting: some seconds.
    pub fn quick() -> Self {
        Self { approach_count: 2, sized_approach_count: 1, repeats: 5, ..Self::standard() }
    }
}

/// Measures all that `plan` asks for.
///
/// Errors: the mesh has no triangles.
pub fn convex(plan: &ConvexPlan, progress: &Progress) -> Result<Results, StudyError> {
    let ConvexPlan { prediction, .. } = *plan;
    let mesh = shape(&plan.mesh)?;
    let contest = Contest::new([&mesh]);
    let kinds = kinds(1.0);
    progress.phase("convex shapes and compounds", kinds.len() * (1 + SIZES.len()));
    let mut rows: Vec<Row> = Vec::new();
    let mut ways = Vec::new();
    for (seed, kind) in (0..).zip(&kinds) {
        let mut random = Rand32::new(seed);
        let places = (0..plan.approach_count).flat_map(|_| {
            let approach = approach(&contest, &mesh, kind, &mut random);
            ADVANCES.map(|advance| approach.place(advance * prediction))
        });
        let places: Vec<Place> = places.collect();
        let pair = Pair::new(&contest, &mesh, kind, prediction);
        for mode in Mode::ALL {
            let sequences = pair.sequences(&places, mode);
            let times = contest.race(plan.repeats, &sequences);
            let study = if kind.shape.as_compound().is_some() { COMPOUNDS } else { SHAPES };
            let timed = pair.rows(study, &sequences).into_iter().zip(times);
            rows.extend(timed.map(|(row, time)| {
                let row = row.key("mesh", &*plan.mesh.name).key("mode", mode.to_string());
                row.with("place_count", places.len()).with("time", time)
            }));
        }
        ways.push(places.into_iter().take(plan.sized_approach_count * ADVANCES.len()).collect());
        progress.step();
    }
    for size in SIZES {
        rows.extend(sized(plan, size, &ways, progress)?);
    }
    progress.finish();
    let panels = Mode::ALL.map(|mode| {
        let is_shown = move |row: &&Row| row.is("mode", mode);
        Panel::time_against_error(format!("Queries, {mode}"), rows.iter().filter(is_shown))
    });
    let environment = Environment::detect();
    Ok(Results { environment, tables: tables(plan, &rows), rows, panels: panels.into() })
}

/// First queries at the same places, everything scaled so that the mesh has this size.
fn sized(
    plan: &ConvexPlan,
    size: f64,
    ways: &[Vec<Place>],
    progress: &Progress,
) -> Result<Vec<Row>, StudyError> {
    let factor = size as Real / plan.mesh.bounds().extents().max_element();
    let mesh = shape(&plan.mesh.clone().scaled(factor))?;
    let contest = Contest::new([&mesh]);
    let prediction = factor * plan.prediction;
    let mut rows = Vec::new();
    for (kind, places) in kinds(factor).iter().zip(ways) {
        let pair = Pair::new(&contest, &mesh, kind, prediction);
        let scaled = places.iter().map(|&Place { mut pos12, direction }| {
            pos12.translation *= factor;
            Place { pos12, direction }
        });
        let sequences = pair.sequences(&scaled.collect::<Vec<_>>(), Mode::Fresh);
        let judged = pair.rows(SIZED, &sequences).into_iter();
        rows.extend(judged.map(|row| {
            row.key("size", size).with("prediction", prediction).with("place_count", places.len())
        }));
        progress.step();
    }
    Ok(rows)
}

fn tables(plan: &ConvexPlan, rows: &[Row]) -> Vec<Table> {
    let ConvexPlan { mesh, prediction, .. } = plan;
    let count = mesh.triangle_count();
    let places = |header| number(header, "place_count").of("sbbk");
    let timed = [("convex shapes", SHAPES), ("compounds", COMPOUNDS)].map(|(kinds, study)| {
        let mut notes = mode_notes();
        let asked = "every other place or motion is asked with the mesh first";
        notes.extend([asked, TIME_NOTE, ERRORS_NOTE, DIRECT_NOTE].map(str::to_owned));
        let columns = [vec![places("places or motions")], sides()].concat();
        let title = format!(
            "A mesh against {kinds}: {} of {count} triangles, prediction distance {prediction}; \
             microseconds a query",
            mesh.name
        );
        TableSpec { title, study, keys: &["mode", "shape"], total: Some(1), columns, notes }
    });
    let sides = ["stock", "sbbk"].map(|side| errors(&format!("errors, {side}"), "errors").of(side));
    let asked = vec![number("prediction", "prediction").of("sbbk"), places("places")];
    let columns = [asked, sides.to_vec()].concat();
    let sized = TableSpec {
        title: format!("First queries at several sizes of the mesh: {}", mesh.name),
        study: SIZED,
        keys: &["size", "shape"],
        total: Some(1),
        columns,
        notes: vec![
            "everything shrinks together: mesh, shapes, prediction distance".to_owned(),
            ERRORS_NOTE.to_owned(),
        ],
    };
    timed.into_iter().chain([sized]).map(|spec| spec.of(rows)).collect()
}

/// A random way of the mesh to the shape.
fn approach(contest: &Contest, mesh: &SharedShape, kind: &Kind, random: &mut Rand32) -> Approach {
    let shapes = [&kind.shape, mesh];
    let Some(upright) = kind.floor else {
        return Approach::random(contest.sbbk(), shapes, random);
    };
    let rotation = match upright {
        Upright::Yes => Quat::IDENTITY,
        Upright::No => random::rotation(random),
    };
    let [x, z] = [(); 2].map(|()| 20.0 * random.rand_float() - 10.0);
    Approach::along(Vec3::Y, rotation, Vec3::new(x, 0.0, z), contest.sbbk(), shapes)
        .expect("what comes from above to a floor touches it")
}

/// A mesh and a shape.
struct Pair<'a> {
    contest: &'a Contest,
    mesh: &'a SharedShape,
    kind: &'a Kind,
    prediction: Real,
    judge: Judge,
}

impl<'a> Pair<'a> {
    fn new(contest: &'a Contest, mesh: &'a SharedShape, kind: &'a Kind, prediction: Real) -> Self {
        Self { contest, mesh, kind, prediction, judge: Judge::new(mesh, &kind.shape) }
    }

    /// The queries at some places, every other time with the mesh first.
    fn sequences(&self, places: &[Place], mode: Mode) -> Vec<Sequence<'a>> {
        let Self { mesh, kind, prediction, .. } = *self;
        let sequence = |(index, place): (usize, &Place)| {
            let poses = mode.poses(mesh, place, prediction).into_iter();
            let (shapes, poses): (_, Vec<Pose3>) = if is_mesh_first(index) {
                ([mesh, &kind.shape], poses.map(|pose| pose.inverse()).collect())
            } else {
                ([&kind.shape, mesh], poses.collect())
            };
            Sequence { shapes, poses, prediction }
        };
        places.iter().enumerate().map(sequence).collect()
    }

    /// The errors of both sides in all answers.
    fn rows(&self, study: &'static str, sequences: &[Sequence]) -> [Row; 2] {
        let mut errors = [ErrorCount::default(); 2];
        for (index, sequence) in sequences.iter().enumerate() {
            let is_mesh_first = is_mesh_first(index);
            let truth = sequence.poses.iter().map(|pos12| {
                let pose = if is_mesh_first { pos12.inverse() } else { *pos12 };
                self.judge.truth(&pose, self.prediction)
            });
            let truth: Vec<Truth> = truth.collect();
            let subshapes = |manifold: &ContactManifold| {
                let (one, two) = (manifold.subshape1, manifold.subshape2);
                if is_mesh_first { (one, two) } else { (two, one) }
            };
            for (dispatcher, errors) in self.contest.dispatchers.iter().zip(&mut errors) {
                sequence.walk(dispatcher, |step, manifolds| {
                    *errors += truth[step].judge(manifolds, subshapes);
                });
            }
        }
        let parts = self.kind.shape.as_compound().map(|compound| compound.shapes().len());
        let row = |side: usize| {
            Row::new(study, Contest::BACKENDS[side])
                .key("shape", self.kind.name)
                .with("part_count", parts)
                .with("errors", errors[side])
        };
        [row(0), row(1)]
    }
}

fn is_mesh_first(index: usize) -> bool {
    index.is_multiple_of(2)
}
