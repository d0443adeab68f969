//! Monkey heads on terrains of growing size: the terrain as a height field and as a mesh of the
//! same triangles.
//!
//! Stock Rapier has no contacts of a mesh and a height field, so it is timed on the mesh only. A
//! head stands on the terrain at random places and is asked there for the first time, and then in
//! slow motion with what the query before left. The first and the last answer of each motion are
//! judged by brute force over the triangles. Besides, heads fall on a terrain in whole worlds,
//! under stock too: how many stay on it.

use std::sync::Arc;

use glamx::{Quat, Vec3};
use oorandom::Rand32;
use rapier_integration::{SbbkConfig, SbbkDispatcher};
use rapier3d::geometry::SharedShape;
use rapier3d::math::Real;

use super::motion::{Approach, Mode, Place};
use super::pair::{Contest, query_count, sweep};
use super::turns::race;
use super::{Progress, shape};
use crate::backend::{Backend, Question, SharedDispatcher};
use crate::mesh;
use crate::metrics::{ErrorCount, Judge, Sequence};
use crate::report::{
    ERROR_NOTE, Look, Panel, Results, Row, Scale, TIME_NOTE, Table, TableSpec, errors, number, time,
};
use crate::scene::{Ground, HeadsOnTerrain, Scene};

const QUERIES: &str = "terrain: queries, µs";
const FALLS: &str = "terrain: falling heads";
/// Rapier's, in units.
const PREDICTION: Real = 0.02;
/// A head whose origin is lower than this, in units, is under the terrain, whose valleys are less
/// deep.
const UNDER: f32 = -2.0;

/// What to compare, and how thoroughly.
#[derive(Clone, Debug)]
pub struct TerrainPlan {
    /// Cells along the sides of the terrains.
    pub cells: Vec<u32>,
    /// Places on each.
    pub place_count: usize,
    /// How often each measurement is repeated.
    pub repeats: usize,
    /// Steps of the heads that fall.
    pub fall_steps: usize,
}

impl TerrainPlan {
    /// From a thousand cells to a million; half a minute on two cores.
    pub fn standard() -> Self {
        Self { cells: vec![32, 100, 316, 1000], place_count: 12, repeats: 15, fall_steps: 300 }
    }

    /// For trying, not for quoting: some seconds.
    pub fn quick() -> Self {
        Self { cells: vec![32, 100], place_count: 4, repeats: 3, fall_steps: 300 }
    }
}

/// Sixteen heads that fall on a terrain.
pub fn falling_heads(ground: Ground) -> HeadsOnTerrain {
    HeadsOnTerrain { side_count: 4, cells: 24, ground }
}

/// Measures all that `plan` asks for.
pub fn terrain(plan: &TerrainPlan, progress: &Progress) -> Results {
    progress.phase("terrains", plan.cells.len());
    let mut rows = Vec::new();
    for &cells in &plan.cells {
        rows.extend(of_size(plan, cells));
        progress.step();
    }
    let ways = [
        (Backend::Stock, Ground::HeightField),
        (Backend::Sbbk, Ground::Mesh),
        (Backend::Sbbk, Ground::HeightField),
    ];
    progress.phase("falling heads", ways.len());
    for (backend, ground) in ways {
        let above = fall(backend, ground, plan.fall_steps);
        rows.push(
            Row::new(FALLS, backend)
                .key("ground", ground.to_string())
                .with("left", above.last())
                .with("heads_above", above),
        );
        progress.step();
    }
    progress.finish();
    let panels = vec![
        times(&rows, "First queries", "fresh.min"),
        times(&rows, "Queries in slow motion", "steady.min"),
        falls(&rows),
    ];
    let tables = tables(&rows, plan.fall_steps);
    Results::new(rows, tables, panels)
}

/// A terrain and who answers for it.
struct Way<'a> {
    backend: Backend,
    dispatcher: &'a SharedDispatcher,
    ground: Ground,
    shape: &'a SharedShape,
}

impl Way<'_> {
    fn sequences(&self, head: &SharedShape, places: &[Place], mode: Mode) -> Vec<Sequence> {
        let sequence = |place| mode.sequence([self.shape, head], place, PREDICTION);
        places.iter().map(sequence).collect()
    }

    /// Errors of the first and the last answer of each motion, against the terrain as a mesh.
    fn errors(&self, sequences: &[Sequence], meshes: [&SharedShape; 2], cells: u32) -> ErrorCount {
        let judge = Judge::new(meshes);
        let [errors] = Sequence::errors(sequences, [self.dispatcher], |index, step| {
            let poses = &sequences[index].poses;
            (step == 0 || step + 1 == poses.len()).then(|| {
                let shapes = meshes.map(|shape| &**shape);
                let truth = judge.truth(&Question::new(&poses[step], shapes, PREDICTION));
                match self.ground {
                    Ground::Mesh => truth,
                    Ground::HeightField => truth.renumbered(|t, other| (in_field(t, cells), other)),
                }
            })
        });
        errors.pairs
    }

    /// Cells whose heights a first query reads, on the mean; `None` on a mesh.
    fn cells_read(&self, sequences: &[Sequence]) -> Option<f64> {
        self.shape.as_heightfield()?;
        let mut config = SbbkConfig::default();
        config.count_queries = true;
        let counting = SbbkDispatcher::new(config);
        let dispatcher: SharedDispatcher = Arc::new(counting.clone());
        sequences.iter().for_each(|sequence| sequence.walk(&dispatcher, |_, _| ()));
        Some(counting.stats().descent.cells as f64 / sequences.len().max(1) as f64)
    }
}

/// The number that a triangle of the mesh has in the height field.
fn in_field(triangle: u32, cells: u32) -> u32 {
    let (cell, side) = (triangle / 2, triangle % 2);
    (cell % cells) * cells + cell / cells + side * cells * cells
}

fn of_size(plan: &TerrainPlan, cells: u32) -> Vec<Row> {
    let head = shape(&mesh::monkey_head().centred().scaled_to(2.0));
    let ground = shape(&HeadsOnTerrain::terrain(cells));
    let field = SharedShape::new(HeadsOnTerrain::field(cells));
    let contest = Contest::new([&head, &ground]);
    let [stock, sbbk] = &contest.dispatchers;
    let way = |backend, dispatcher, ground, shape| Way { backend, dispatcher, ground, shape };
    let ways = [
        way(Backend::Stock, stock, Ground::Mesh, &ground),
        way(Backend::Sbbk, sbbk, Ground::Mesh, &ground),
        way(Backend::Sbbk, sbbk, Ground::HeightField, &field),
    ];
    let mut random = Rand32::new(u64::from(cells));
    let places: Vec<Place> = (0..plan.place_count)
        .map(|_| {
            let [x, z] = [(); 2].map(|()| 0.4 * cells as Real * (random.rand_float() - 0.5));
            let turn = Quat::from_rotation_y(6.0 * random.rand_float());
            Approach::along(Vec3::Y, turn, Vec3::new(x, 0.0, z), sbbk, [&ground, &head])
                .expect("a head that comes from above touches the terrain")
                .place(0.2 * PREDICTION)
        })
        .collect();
    let times = |mode: Mode| {
        let count = query_count(&ways[0].sequences(&head, &places, mode));
        race(&ways, plan.repeats, 1e6 / count, |way| {
            sweep(way.dispatcher, &way.sequences(&head, &places, mode))
        })
    };
    let times = times(Mode::Fresh).into_iter().zip(times(Mode::SLOW));
    let rows = ways.iter().zip(times).map(|(way, (fresh, steady))| {
        let motions = way.sequences(&head, &places, Mode::SLOW);
        Row::new(QUERIES, way.backend)
            .key("ground", way.ground.to_string())
            .key("cells", cells)
            .with("fresh", fresh)
            .with("steady", steady)
            .with("errors", way.errors(&motions, [&ground, &head], cells))
            .with("cells_read", way.cells_read(&way.sequences(&head, &places, Mode::Fresh)))
    });
    rows.collect()
}

/// How many heads are not under the terrain, after each step.
fn fall(backend: Backend, ground: Ground, steps: usize) -> Vec<usize> {
    let mut built = falling_heads(ground).build();
    let _installed = backend.install(&mut built.world);
    let heads_above = (0..steps).map(|_| {
        built.world.step();
        let heights = built.watched.iter().map(|&body| built.world.bodies[body].translation().y);
        heights.filter(|&height| height > UNDER).count()
    });
    heads_above.collect()
}

fn tables(rows: &[Row], fall_steps: usize) -> Vec<Table> {
    let queries = TableSpec::new(
        "A head of 968 triangles on a square terrain; microseconds a query",
        QUERIES,
        &["cells", "backend", "ground"],
        [
            time("first", "fresh"),
            time("steady, 0.05 a step", "steady"),
            number("cells read", "cells_read"),
            errors("errors", "errors"),
        ],
    )
    .note("cells: along a side; stock Rapier has no contacts of a mesh and a height field")
    .note(
        "first, on a mesh: with the hash of its vertices and triangles, by which its tree is \
             found",
    )
    .note("cells read: by a first query, each as often as its heights are read")
    .note(TIME_NOTE)
    .note(ERROR_NOTE);
    let falls = TableSpec::new(
        format!("Sixteen heads that fell on a terrain, after {fall_steps} steps"),
        FALLS,
        &["backend", "ground"],
        [number("not under it", "left")],
    );
    [queries, falls].map(|spec| spec.of(rows)).into()
}

/// What the panels show: who answers, and on what.
const LINES: [(Backend, Ground, Look); 3] = [
    (Backend::Stock, Ground::Mesh, Look::ALL[0]),
    (Backend::Sbbk, Ground::Mesh, Look::ALL[5]),
    (Backend::Sbbk, Ground::HeightField, Look::ALL[2]),
];

fn of<'a>(
    rows: &'a [Row],
    study: &'static str,
    backend: Backend,
    ground: Ground,
) -> impl Iterator<Item = &'a Row> {
    rows.iter().filter(move |row| {
        row.study == study && row.is("backend", backend) && row.is("ground", ground)
    })
}

/// Least time of a query by number of cells.
fn times(rows: &[Row], title: &str, path: &str) -> Panel {
    let panel = Panel::new(title, ["cells", "µs a query"], Scale::Logarithmic);
    LINES.into_iter().fold(panel, |panel, (backend, ground, look)| {
        let rows = of(rows, QUERIES, backend, ground);
        let points = rows.map(|row| [row.number("cells").powi(2), row.number(path)]);
        panel.line(&format!("{backend}, {ground}"), look, points)
    })
}

/// How many heads stay on a height field. On the mesh all stay as well; they would hide it.
fn falls(rows: &[Row]) -> Panel {
    let labels = ["seconds", "heads that are not under it"];
    let panel = Panel::new("Heads dropped on a height field", labels, Scale::Linear);
    [Backend::Stock, Backend::Sbbk].into_iter().fold(panel, |panel, backend| {
        let above = of(rows, FALLS, backend, Ground::HeightField);
        let above = above.filter_map(|row| row.get("heads_above")?.as_array()).flatten();
        let points = above
            .enumerate()
            .step_by(12)
            .filter_map(|(step, count)| Some([(step + 1) as f64 / 60.0, count.as_f64()?]));
        let label = format!("{backend}, {}", Ground::HeightField);
        panel.line(&label, Look::of(backend), points)
    })
}
