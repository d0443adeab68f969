//! Everyday scenes: bodies on mesh terrains of all sizes, meshes that come and go, robots, sensors,
//! characters, and queries without a workspace.
//!
//! Each scene runs in whole worlds, under stock Rapier and under SBBK with its defaults, step by
//! step in turns. All runs of a backend do the same, so the time of a step is the least over the
//! runs. Brute force in f64 judges contacts of both at poses of stock's run.

use crate::prelude::*;

mod advise;
mod measure;
mod queries;
mod robots;
mod scenes;

pub use self::advise::{Advice, advise};
use self::measure::Everyday;
pub use self::robots::Subject;
use self::scenes::Ground;

const BODIES: &str = "everyday: bodies on terrains";
const SINGLE: &str = "everyday: single bodies, and many meshes";
const DEFORMABLE: &str = "everyday: all flags, and robots";
const SENSORS: &str = "everyday: sensors and characters";
const PILE: &str = "everyday: pile";
const FINE: &str = "everyday: fine meshes";
const QUERIES: &str = "everyday: queries";
#[cfg(feature = "parallel")]
const THREADS: &str = "everyday: threads";
/// Flags of terrains.
const PLAIN: TriMeshFlags = TriMeshFlags::empty();
const FIXED: TriMeshFlags = TriMeshFlags::FIX_INTERNAL_EDGES;

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
    /// Piles of tori with few and with many triangles, and parts of centimetres.
    Fine,
    /// Heavy and light pairs on one thread, on two, and on all.
    #[cfg(feature = "parallel")]
    Threads,
    /// Single queries without a workspace.
    Queries,
}

/// Extent of the study.
#[derive(Clone, Debug)]
pub struct EverydayPlan {
    pub groups: Vec<Group>,
    /// Terrains for bodies of all kinds: cells along a side, their length, and flags of the mesh.
    pub grounds: Vec<(u32, f32, TriMeshFlags)>,
    /// Bodies on each terrain, if there is room.
    pub bodies: usize,
    /// Steps of most runs.
    pub steps: usize,
    /// Runs of each scene on each backend.
    pub repeats: usize,
    /// Cells of half a unit along a side of the terrain for single bodies and sensors.
    pub cells: u32,
    /// Cells of a unit along a side of the terrain that is crossed once.
    pub world_cells: u32,
    /// Small meshes that come and go.
    pub small_meshes: usize,
    /// Cells of half a unit along a side of the terrains for all flags and robots.
    pub deformable_cells: u32,
    pub heads: usize,
    /// Segments around the tubes of tori, each time for a pile of its own.
    pub tubes: Vec<u32>,
    /// Cells of half a unit along a side of the terrains for single queries.
    pub query_cells: Vec<u32>,
}

impl EverydayPlan {
    /// Terrains of 2048 to two million triangles; ten minutes on two cores.
    pub fn standard() -> Self {
        let grounds = [32, 100, 400, 1000].into_iter().flat_map(|cells| {
            let of = move |cell| [(cells, cell, PLAIN), (cells, cell, FIXED)];
            [1.0, 0.25].into_iter().flat_map(of)
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
            heads: 300,
            tubes: vec![13, 26, 52, 104],
            query_cells: vec![23, 100, 400, 1000],
        }
    }

    /// For trying, not for quoting: about a minute.
    pub fn quick() -> Self {
        Self {
            grounds: vec![
                (32, 1.0, PLAIN),
                (100, 1.0, PLAIN),
                (100, 1.0, FIXED),
                (400, 0.25, PLAIN),
            ],
            steps: 100,
            repeats: 3,
            world_cells: 512,
            small_meshes: 1000,
            heads: 100,
            tubes: vec![13, 26],
            query_cells: vec![100, 400],
            ..Self::standard()
        }
    }
}

/// Measures all parts.
pub fn everyday(plan: &EverydayPlan, progress: &Progress) -> Results {
    let mut worlds = Worlds { plan, progress, rows: Vec::new() };
    for group in &plan.groups {
        worlds.group(*group);
    }
    Results::new("everyday", worlds.rows)
}

struct Worlds<'a> {
    plan: &'a EverydayPlan,
    progress: &'a Progress,
    rows: Vec<Row>,
}

impl Worlds<'_> {
    fn group(&mut self, group: Group) {
        let plan = self.plan;
        let large = || Ground::new(plan.cells, 0.5, FIXED);
        match group {
            Group::Terrains => {
                for &(cells, cell, flags) in &plan.grounds {
                    let ground = Ground::new(cells, cell, flags);
                    self.measure(&scenes::bodies(&ground, plan.bodies, plan.steps));
                }
            }
            Group::Single => {
                let (large, world) = (large(), Ground::new(plan.world_cells, 1.0, PLAIN));
                let small = Ground::new(64, 0.5, PLAIN);
                self.measure(&scenes::bouncing(&large, 5 * plan.steps));
                self.measure(&scenes::crossing(&world, 2 * plan.steps));
                let small_meshes = scenes::rolling_population(&small, plan.small_meshes);
                self.measure(&[small_meshes, scenes::on_half_space(plan.bodies, plan.steps)]);
            }
            Group::Flags => {
                let all = Ground::new(plan.deformable_cells, 0.5, TriMeshFlags::all());
                let fixed = Ground::new(plan.deformable_cells, 0.5, FIXED);
                self.measure(&scenes::all_flags(&all, plan.steps));
                self.measure(&robots::robots(&fixed, plan.steps));
            }
            Group::Sensors => self.measure(&scenes::sensors(&large(), plan.steps)),
            Group::Pile => self.measure(&[scenes::pile(plan.heads, plan.steps)]),
            Group::Fine => {
                let tori = plan.tubes.iter().map(|&tube| scenes::tori(tube, plan.steps));
                let coarsest = plan.tubes.iter().min();
                let parts = coarsest.map(|&tube| scenes::decomposed_tori(tube, plan.steps));
                let parts = parts.into_iter().chain([scenes::parts(plan.steps)]);
                self.measure(&tori.chain(parts).collect::<Vec<_>>());
            }
            #[cfg(feature = "parallel")]
            Group::Threads => self.threads(),
            Group::Queries => self.queries(),
        }
    }

    fn queries(&mut self) {
        self.progress.phase("queries on terrains", self.plan.query_cells.len());
        for &cells in &self.plan.query_cells {
            let ground = Ground::new(cells, 0.5, PLAIN);
            self.rows.extend(queries::queries(&ground, self.plan.repeats));
            self.progress.step();
        }
    }

    #[cfg(feature = "parallel")]
    fn threads(&mut self) {
        let plan = self.plan;
        for threads in std::collections::BTreeSet::from([1, 2, parallel::threads()]) {
            let [heavy, light] =
                [scenes::tori(52, plan.steps), scenes::pile(plan.heads, plan.steps)];
            let scenes = [scenes::two_tori(108, plan.steps / 4), heavy, light];
            self.measure(&scenes.map(|scene| scene.on_threads(THREADS, threads)));
        }
    }

    fn measure(&mut self, scenes: &[Everyday]) {
        for scene in scenes {
            self.rows.extend(scene.measure(self.plan.repeats, self.progress));
        }
    }
}
