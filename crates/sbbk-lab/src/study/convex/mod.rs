//! A mesh against convex shapes and compounds of them, stock Parry beside SBBK: what queries cost,
//! and whether a contact is lost, added, at a wrong distance or along a wrong normal.
//!
//! The mesh comes towards a shape of each kind along random directions and is stopped at places
//! about the first touch and deep in it; the pair is asked there for the first time, and in slow
//! and fast motion through these places. Meshes of few and many triangles, small and large, take
//! such ways at several prediction distances. Brute force in f64 over all triangles near the shape
//! tells the truth.

pub(super) mod errors;
pub(super) mod kinds;
mod pair;

use oorandom::Rand32;
use rapier3d::math::Real;

use self::kinds::kinds;
use self::pair::Pair;
use super::motion::{Mode, Place, mode_notes};
use super::pair::{Contest, DIRECT_NOTE};
use super::{Progress, shape};
use crate::mesh::{self, Mesh};
use crate::report::{Panel, Results, Row, TIME_NOTE, Table, TableSpec, errors, number, sides};

/// What to compare, and how thoroughly.
#[derive(Clone, Debug)]
pub struct ConvexPlan {
    /// The mesh that is timed against every kind of shape.
    pub mesh: Mesh,
    /// The prediction distance then, in units.
    pub prediction: Real,
    /// Approaches to each shape, of five places about the first touch and two deep ones each.
    pub approach_count: usize,
    /// How often each measurement is repeated.
    pub repeats: usize,
    /// The meshes of which first queries are judged, one approach each.
    pub meshes: Vec<Mesh>,
    /// The lengths of these, in units.
    pub sizes: Vec<f64>,
    /// The prediction distances; one that is too large for a mesh is left out.
    pub predictions: Vec<Real>,
}

/// How far beyond the first touch the mesh is stopped, in prediction distances: about to touch,
/// touching, and somewhat deeper than a body at rest is.
const ADVANCES: [Real; 5] = [-0.95, -0.5, 0.0, 0.5, 2.0];
/// The same for deep places, as shares of the length of the mesh.
const DEEP: [Real; 2] = [0.05, 0.15];
/// Of the former those of first queries that are only judged.
const JUDGED: [Real; 3] = [-0.5, 0.0, 0.5];
/// Motion that is faster than prediction distances allow for.
const FASTEST: Mode = Mode::Steady(3.0);
const MODES: [Mode; 4] = [Mode::Fresh, Mode::SLOW, Mode::FAST, FASTEST];

/// The length of meshes that kinds of one unit across are beside.
const LENGTH: f64 = 2.0;

const SHAPES: &str = "convex: queries, µs";
const COMPOUNDS: &str = "compounds: queries, µs";
const SIZED: &str = "convex: sizes";
const ERRORS_NOTE: &str = "errors: missed + beyond + wrong distance + wrong normal, of the true contacts in all \
                           answers judged, of motions one in four; the truth is brute force in f64. Missed: nearer \
                           than the prediction distance, and not reported; beyond: reported, and farther; 1 % of the \
                           prediction distance may go either way. Wrong: a distance off by more than 1 % of the \
                           prediction distance and 1e-5 of the depth; a normal off by more than 0.1 degrees";

impl ConvexPlan {
    /// The head of 968 triangles, two units across, at Rapier's prediction distance, and meshes of
    /// 288 to 70,688 triangles; about five minutes.
    pub fn standard() -> Self {
        Self {
            mesh: mesh::monkey_head(),
            prediction: 0.02,
            approach_count: 3,
            repeats: 9,
            meshes: vec![
                mesh::monkey_head_with(6),
                mesh::torus(0.7, 0.3, 70, 40),
                mesh::monkey_head_with(94),
            ],
            sizes: vec![0.01, 0.1, 2.0, 40.0],
            predictions: vec![0.0001, 0.002, 0.02],
        }
    }

    /// For trying, not for quoting: some seconds.
    pub fn quick() -> Self {
        let meshes = vec![mesh::monkey_head_with(6)];
        Self { approach_count: 1, repeats: 3, meshes, ..Self::standard() }
    }

    /// Whether contacts of a mesh of this length are judged at this prediction distance. Where that
    /// is large beside triangles, there are too many to judge.
    fn asks(mesh: &Mesh, size: f64, prediction: Real) -> bool {
        /// A tenth of the mesh, of 1000 triangles.
        const MOST: f64 = 1.0;
        let share = f64::from(prediction) / size;
        share * (mesh.triangle_count() as f64 / 1000.0).max(3.0).sqrt() <= MOST
    }
}

/// Measures all that `plan` asks for.
pub fn convex(plan: &ConvexPlan, progress: &Progress) -> Results {
    let mut rows = timed(plan, progress);
    let panels = MODES.map(|mode| {
        let is_shown = move |row: &&Row| row.is("mode", mode);
        Panel::time_against_error(format!("Queries, {mode}"), rows.iter().filter(is_shown))
    });
    progress.phase("sizes", plan.meshes.len() * plan.sizes.len());
    for mesh in &plan.meshes {
        for &size in &plan.sizes {
            rows.extend(sized(plan, mesh, size));
            progress.step();
        }
    }
    progress.finish();
    let tables = tables(plan, &rows);
    Results::new(rows, tables, panels.into())
}

/// Times and errors of one mesh.
fn timed(plan: &ConvexPlan, progress: &Progress) -> Vec<Row> {
    let ConvexPlan { prediction, .. } = *plan;
    let mesh = shape(&plan.mesh);
    let contest = Contest::new([&mesh]);
    let length = plan.mesh.bounds().extents().max_element();
    let about = ADVANCES.map(|advance| advance * prediction);
    let deep = DEEP.map(|share| share * length);
    let kinds = kinds(1.0);
    progress.phase("convex shapes and compounds", kinds.len());
    let mut rows: Vec<Row> = Vec::new();
    for (seed, kind) in (0..).zip(&kinds) {
        let mut random = Rand32::new(seed);
        let ways: Vec<_> = (0..plan.approach_count)
            .map(|_| Pair::approach(&contest, &mesh, kind, &mut random))
            .collect();
        let pair = Pair::new(&contest, &mesh, kind, prediction);
        for (depth, advances) in [("touching", &about[..]), ("deep", &deep)] {
            let places =
                |advance: &Real| ways.iter().map(|way| way.place(*advance)).collect::<Vec<_>>();
            let places: Vec<Place> = advances.iter().flat_map(places).collect();
            for mode in MODES {
                let sequences = pair.sequences(&places, mode);
                let times = contest.race(plan.repeats, &sequences);
                let study = if kind.shape.as_compound().is_some() { COMPOUNDS } else { SHAPES };
                let timed = pair.rows(study, &sequences).into_iter().zip(times);
                rows.extend(timed.map(|(row, time)| {
                    let row = row.key("mesh", &*plan.mesh.name).key("mode", mode.to_string());
                    let row = row.key("depth", depth);
                    row.with("place_count", places.len()).with("time", time)
                }));
            }
        }
        progress.step();
    }
    rows
}

/// The errors of first queries of a mesh of this length.
fn sized(plan: &ConvexPlan, mesh: &Mesh, size: f64) -> Vec<Row> {
    let base = shape(&mesh.clone().scaled_to(LENGTH as Real));
    let scaled = shape(&mesh.clone().scaled_to(size as Real));
    let contests = [Contest::new([&base]), Contest::new([&scaled])];
    let factor = (size / LENGTH) as Real;
    let predictions = plan.predictions.iter().filter(|&&p| ConvexPlan::asks(mesh, size, p));
    let mut rows = Vec::new();
    for (seed, (kind, &prediction)) in
        (0..).zip(predictions.flat_map(|p| kinds(1.0).into_iter().map(move |kind| (kind, p))))
    {
        let mut random = Rand32::new(seed);
        let way = Pair::approach(&contests[0], &base, &kind, &mut random);
        let about = JUDGED.map(|advance| advance * prediction / factor);
        let advances = about.into_iter().chain(DEEP.map(|share| share * LENGTH as Real));
        let places: Vec<Place> = advances
            .map(|advance| {
                let Place { mut pos12, direction } = way.place(advance);
                pos12.translation *= factor;
                Place { pos12, direction }
            })
            .collect();
        let scaled_kinds = kinds(factor);
        let own = scaled_kinds.iter().find(|own| own.name == kind.name).expect("the same kinds");
        let pair = Pair::new(&contests[1], &scaled, own, prediction);
        let judged = pair.rows(SIZED, &pair.sequences(&places, Mode::Fresh)).into_iter();
        rows.extend(judged.map(|row| {
            row.key("mesh", format!("{}, {} triangles", mesh.name, mesh.triangle_count()))
                .key("size", size)
                .key("prediction", f64::from(prediction))
                .with("place_count", places.len())
        }));
    }
    rows
}

fn tables(plan: &ConvexPlan, rows: &[Row]) -> Vec<Table> {
    let ConvexPlan { mesh, prediction, .. } = plan;
    let count = mesh.triangle_count();
    let places = |header| number(header, "place_count").of("sbbk");
    let timed = [("convex shapes", SHAPES), ("compounds", COMPOUNDS)].map(|(kinds, study)| {
        let mut notes = mode_notes();
        let asked = "every other place or motion is asked with the mesh first; deep: 5 and 15 % of \
                     the length of the mesh beyond the first touch";
        notes.extend([asked, TIME_NOTE, ERRORS_NOTE, DIRECT_NOTE].map(str::to_owned));
        let columns = [vec![places("places or motions")], sides()].concat();
        let title = format!(
            "A mesh against {kinds}: {} of {count} triangles, prediction distance {prediction}; \
             microseconds a query",
            mesh.name
        );
        TableSpec::new(title, study, &["mode", "depth", "shape"], columns).total(2).notes(notes)
    });
    let sized = [
        ("by size and shape", &["size", "shape"][..]),
        ("by mesh and prediction distance", &["mesh", "prediction"]),
    ]
    .map(|(by, keys)| {
        let sides =
            ["stock", "sbbk"].map(|side| errors(&format!("errors, {side}"), "errors").of(side));
        let columns = [vec![places("places")], sides.to_vec()].concat();
        let title = format!("First queries of meshes of all sizes, {by}");
        let notes = vec![ERRORS_NOTE.to_owned()];
        TableSpec::new(title, SIZED, keys, columns).total(1).notes(notes)
    });
    timed.into_iter().chain(sized).map(|spec| spec.of(rows)).collect()
}
