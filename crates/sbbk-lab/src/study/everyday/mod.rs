//! Everyday scenes: bodies on mesh terrains of all sizes, meshes that come and go, robots, sensors,
//! characters, and queries without a workspace.
//!
//! Each scene runs in whole worlds, under stock Rapier and under SBBK with its defaults, step by step
//! in turns. All runs of a backend do the same, so the time of a step is the least over the runs.
//! Brute force in f64 judges contacts of both at poses of stock's run.

mod advise;
mod ground;
mod judged;
mod measure;
mod queries;
mod report;
mod robots;
mod scenes;
mod subject;

pub use advise::{Advice, advise, advise_robot};
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use rapier3d::geometry::TriMeshFlags;
use rapier3d::math::Real;

use self::ground::Ground;
use self::measure::Everyday;
use super::StudyError;
use crate::progress::Progress;
use crate::report::{Results, Row};

const BODIES: &str = "everyday: bodies on terrains";
const SINGLE: &str = "everyday: single bodies, and many meshes";
const DEFORMABLE: &str = "everyday: all flags, and robots";
const SENSORS: &str = "everyday: sensors and characters";
const PILE: &str = "everyday: pile";
const QUERIES: &str = "everyday: queries";
/// Rapier's, in units.
const PREDICTION: Real = 0.02;

/// A part of the study.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Group {
    /// Bodies of all kinds on mesh terrains.
    Terrains,
    /// Single bodies that bounce and cross, and many small meshes.
    Single,
    /// Meshes with `TriMeshFlags::all()`, and robots.
    Flags,
    /// Mesh sensors, and Rapier's character controller.
    Sensors,
    /// Heads in a pile.
    Pile,
    /// Single queries without a workspace.
    Queries,
}

/// A terrain.
#[derive(Clone, Copy, Debug)]
pub struct GroundPlan {
    /// Cells along a side: two triangles each.
    pub cells: u32,
    /// Length of a cell, in units: bodies are about a unit long.
    pub cell: f32,
    /// Whether the mesh has `TriMeshFlags::FIX_INTERNAL_EDGES`.
    pub fixes_edges: bool,
}

/// Extent of the comparison.
#[derive(Clone, Debug)]
pub struct EverydayPlan {
    /// Parts of the study.
    pub groups: Vec<Group>,
    /// Terrains for bodies of all kinds.
    pub grounds: Vec<GroundPlan>,
    /// Bodies on each, if there is room.
    pub bodies: usize,
    /// Steps of a run of these.
    pub steps: usize,
    /// Runs of each scene on each backend.
    pub repeats: usize,
    /// Cells along a side of the terrain for single bodies and sensors, of half a unit, with fixed
    /// edges.
    pub cells: u32,
    /// Cells along a side of the world that is crossed once, of a unit.
    pub world_cells: u32,
    /// Small meshes that come and go.
    pub small_meshes: usize,
    /// Cells along a side of the terrains for meshes with all flags and for robots, of half a unit.
    pub deformable_cells: u32,
    /// URDF file of the robots, or `None` for a walker of this crate.
    pub urdf: Option<PathBuf>,
    /// Heads in the pile.
    pub heads: usize,
    /// Cells along a side of the terrains for single queries, of half a unit.
    pub query_cells: Vec<u32>,
    /// Text in the names of the worlds that are measured.
    pub name: String,
    /// Page that plays the first of these worlds.
    pub replay: Option<PathBuf>,
}

impl EverydayPlan {
    /// Terrains of 2048 to two million triangles, of a body's length and a quarter of it, with
    /// and without fixed edges; ten minutes on two cores.
    pub fn standard() -> Self {
        let grounds = [32, 100, 400, 1000].into_iter().flat_map(|cells| {
            [1.0, 0.25].into_iter().flat_map(move |cell| {
                [false, true].map(|fixes_edges| GroundPlan { cells, cell, fixes_edges })
            })
        });
        Self {
            groups: Group::value_variants().to_vec(),
            grounds: grounds.collect(),
            bodies: 100,
            steps: 120,
            repeats: 2,
            cells: 512,
            world_cells: 1000,
            small_meshes: 10_000,
            deformable_cells: 256,
            urdf: None,
            heads: 300,
            query_cells: vec![23, 100, 400, 1000],
            name: String::new(),
            replay: None,
        }
    }

    /// For trying, not for quoting: about a minute.
    pub fn quick() -> Self {
        let ground = |cells, cell, fixes_edges| GroundPlan { cells, cell, fixes_edges };
        Self {
            grounds: vec![
                ground(32, 1.0, false),
                ground(100, 1.0, false),
                ground(100, 1.0, true),
                ground(400, 0.25, false),
            ],
            steps: 100,
            repeats: 3,
            world_cells: 512,
            small_meshes: 1000,
            heads: 100,
            query_cells: vec![100, 400],
            ..Self::standard()
        }
    }
}

/// Measures all that `plan` asks for.
///
/// Errors: there is no such world, the URDF file cannot be loaded, or the page cannot be written.
pub fn everyday(plan: &EverydayPlan, progress: &Progress) -> Result<Results, StudyError> {
    let mut worlds = Worlds { plan, progress, replay: plan.replay.as_deref() };
    let mut rows = Vec::new();
    for group in &plan.groups {
        rows.extend(match group {
            Group::Terrains => on_terrains(&mut worlds)?,
            // `--scene` chooses worlds.
            Group::Queries if !plan.name.is_empty() => Vec::new(),
            Group::Queries => queries(plan, progress),
            Group::Single => {
                let large = plan.large();
                let world = Ground::new(plan.world_cells, 1.0, TriMeshFlags::empty());
                let small = Ground::new(64, 0.5, TriMeshFlags::empty());
                let mut scenes = scenes::bouncing(&large, 5 * plan.steps);
                scenes.extend(scenes::crossing(&world, 2 * plan.steps));
                scenes.push(scenes::rolling_population(&small, plan.small_meshes));
                worlds.measure("single bodies, many meshes", &scenes)?
            }
            Group::Flags => {
                let [all, fixed] = [TriMeshFlags::all(), TriMeshFlags::FIX_INTERNAL_EDGES];
                let all = Ground::new(plan.deformable_cells, 0.5, all);
                let fixed = Ground::new(plan.deformable_cells, 0.5, fixed);
                let mut scenes = scenes::all_flags(&all, plan.steps);
                scenes.extend(robots::robots(&fixed, plan.urdf.as_deref(), plan.steps)?);
                worlds.measure("all flags, and robots", &scenes)?
            }
            Group::Sensors => {
                let large = plan.large();
                let scenes = scenes::sensors(&large, plan.steps);
                worlds.measure("sensors and characters", &scenes)?
            }
            Group::Pile => worlds.measure("pile", &[scenes::pile(plan.heads, plan.steps)])?,
        });
    }
    if rows.is_empty() {
        return Err(StudyError::NoScene(plan.name.clone()));
    }
    let tables = report::tables(plan, &rows);
    Ok(Results::new(report::verdict(&rows), rows, tables))
}

impl EverydayPlan {
    /// The terrain for single bodies and sensors.
    fn large(&self) -> Ground {
        Ground::new(self.cells, 0.5, TriMeshFlags::FIX_INTERNAL_EDGES)
    }
}

/// Measures worlds.
struct Worlds<'a> {
    plan: &'a EverydayPlan,
    progress: &'a Progress,
    /// The page that is not written yet.
    replay: Option<&'a Path>,
}

impl Worlds<'_> {
    fn measure(&mut self, phase: &str, scenes: &[Everyday]) -> Result<Vec<Row>, StudyError> {
        let scenes: Vec<&Everyday> =
            scenes.iter().filter(|scene| scene.name().contains(&self.plan.name)).collect();
        let mut rows = Vec::new();
        for (index, scene) in scenes.iter().enumerate() {
            let message = format!("{phase}, world {} of {}", index + 1, scenes.len());
            self.progress.phase(message, scene.step_count(self.plan.repeats));
            rows.extend(scene.measure(self.plan.repeats, self.progress));
            self.replay.take().map(|path| scene.play(path)).transpose()?;
        }
        Ok(rows)
    }
}

fn on_terrains(worlds: &mut Worlds) -> Result<Vec<Row>, StudyError> {
    let plan = worlds.plan;
    let mut rows = Vec::new();
    for (index, &ground_plan) in plan.grounds.iter().enumerate() {
        let GroundPlan { cells, cell, fixes_edges } = ground_plan;
        let flags = match fixes_edges {
            true => TriMeshFlags::FIX_INTERNAL_EDGES,
            false => TriMeshFlags::empty(),
        };
        let ground = Ground::new(cells, cell, flags);
        let scenes = scenes::bodies(ground_plan, &ground, plan.bodies, plan.steps);
        let phase = format!("bodies on terrain {} of {}", index + 1, plan.grounds.len());
        rows.extend(worlds.measure(&phase, &scenes)?);
    }
    Ok(rows)
}

fn queries(plan: &EverydayPlan, progress: &Progress) -> Vec<Row> {
    progress.phase("queries on terrains", plan.query_cells.len());
    let mut rows = Vec::new();
    for &cells in &plan.query_cells {
        let ground = Ground::new(cells, 0.5, TriMeshFlags::empty());
        rows.extend(queries::queries(&ground, plan.repeats));
        progress.step();
    }
    rows
}
