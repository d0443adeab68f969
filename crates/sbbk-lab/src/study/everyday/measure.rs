//! Runs of a scene under stock Rapier and under SBBK, in turns.

use std::path::Path;
use std::time::{Duration, Instant};

use rapier_integration::{PreparedTree, SbbkDispatcher};
use rapier3d::geometry::SharedShape;
use rapier3d::pipeline::PhysicsWorld;

use super::judged::Comparison;
use crate::backend::{Backend, shape_address};
use crate::metrics::Summary;
use crate::progress::Progress;
use crate::replay::{self, Recorder};
use crate::report::{ReportError, Row};
use crate::study::pair::Contest;

/// A world that can be built again and again, and its drive.
pub(super) struct Everyday<'a> {
    /// Study and keys of the rows.
    pub row: Row,
    pub steps: usize,
    pub build: Box<dyn Fn() -> Driven + 'a>,
    /// Shapes that SBBK prepares before the first step.
    pub prepared: Vec<SharedShape>,
}

/// A world and its drive.
pub(super) struct Driven {
    pub world: PhysicsWorld,
    pub drive: Drive,
}

/// Called before each step with its number, from 0. Returns the time of its own queries, which
/// counts as collision detection.
pub(super) type Drive = Box<dyn FnMut(&mut PhysicsWorld, usize) -> Duration>;

impl Driven {
    /// A world without a drive.
    pub fn alone(world: PhysicsWorld) -> Self {
        Self::by(world, |_, _| Duration::ZERO)
    }

    pub fn by(
        world: PhysicsWorld,
        drive: impl FnMut(&mut PhysicsWorld, usize) -> Duration + 'static,
    ) -> Self {
        Self { world, drive: Box::new(drive) }
    }
}

/// Steps between two samples of memory.
const MEMORY_EVERY: usize = 10;
/// Looks at the contacts of a run; worlds with few pairs are looked at after so many steps.
const COMPARISONS: usize = 3;
const FEW_PAIRS: usize = 3;
const FEW_EVERY: usize = 4;
/// A median is slower above this factor and this many microseconds.
const NOISE: f64 = 1.05;
const IGNORED: f64 = 1.0;
/// A worst step is worse above this many microseconds.
const WORST: f64 = 2000.0;

/// Compares median and worst step of SBBK with stock; `ignored` and `worst` have the unit of the
/// times.
pub(super) fn verdict(stock: [f64; 2], sbbk: [f64; 2], ignored: f64, worst: f64) -> &'static str {
    let [is_slower, is_worse] =
        [sbbk[0] > (NOISE * stock[0]).max(stock[0] + ignored), sbbk[1] > stock[1] + worst];
    match (is_slower, is_worse) {
        (false, false) => "ok",
        (true, false) => "slower",
        (false, true) => "worst step",
        (true, true) => "slower, worst step",
    }
}

/// Times of one backend: for each step the least over the repeats, in microseconds, as every run of
/// a backend does the same.
#[derive(Default)]
struct Side {
    detection: Vec<f64>,
    step: Vec<f64>,
    mesh_bytes: usize,
    plugin_bytes: usize,
}

impl<'a> Everyday<'a> {
    /// A scene with nothing prepared.
    pub fn new(row: Row, steps: usize, build: impl Fn() -> Driven + 'a) -> Self {
        Self { row, steps, build: Box::new(build), prepared: Vec::new() }
    }

    /// Steps of [`Self::measure`].
    pub fn step_count(&self, repeats: usize) -> usize {
        self.steps * repeats.max(1)
    }

    /// Runs the scene `repeats` times on both backends, step by step in turns. Counts the steps.
    pub fn measure(&self, repeats: usize, progress: &Progress) -> [Row; 2] {
        let mut sides: [Side; 2] = Default::default();
        let mut comparison = Comparison::new();
        for repeat in 0..repeats.max(1) {
            self.run(&mut sides, (repeat == 0).then_some(&mut comparison), progress);
        }
        let summaries = sides.each_ref().map(|side| {
            [&side.detection, &side.step].map(|times| Summary::of(times.iter().copied()))
        });
        let [stock, sbbk] =
            summaries.map(|[detection, _]| detection.map_or([0.0; 2], |d| [d.median, d.max]));
        let is_bad = |time: &&f64| **time > stock[1] + WORST;
        let row = |side: usize| {
            let backend = Contest::BACKENDS[side].to_string();
            let mebibytes = |bytes: usize| bytes as f64 / (1 << 20) as f64;
            Row { backend, ..self.row.clone() }
                .with("steps", self.steps)
                .with("detection", summaries[side][0])
                .with("step", summaries[side][1])
                .with("mesh_mebibytes", mebibytes(sides[side].mesh_bytes))
                .with("plugin_mebibytes", mebibytes(sides[side].plugin_bytes))
                .with("judged", comparison.judged[side])
        };
        let sbbk = row(1)
            .with("verdict", verdict(stock, sbbk, IGNORED, WORST))
            .with("bad_steps", sides[1].detection.iter().filter(is_bad).count());
        [row(0), sbbk]
    }

    /// Runs the scene on both backends and writes a page that plays both runs.
    ///
    /// Errors: the page cannot be written.
    pub fn play(&self, path: &Path) -> Result<(), ReportError> {
        let sbbk = SbbkDispatcher::default();
        let mut runs = Vec::new();
        for (backend, dispatcher) in [(Backend::Stock, None), (Backend::Sbbk, Some(&sbbk))] {
            let (Driven { mut world, mut drive }, _prepared) = self.start(dispatcher);
            let mut recorder = Recorder::new(backend, &world);
            for step in 0..self.steps {
                drive(&mut world, step);
                recorder.step(&mut world);
            }
            runs.push(recorder);
        }
        replay::write(path, &self.name(), &runs)
    }

    /// Name in tables, which `--scene` is compared with.
    pub fn name(&self) -> String {
        let keys = self.row.keys.iter();
        let keys = keys.map(|(key, value)| match value.as_str() {
            Some(text) => text.to_owned(),
            None => format!("{value} {key}"),
        });
        keys.collect::<Vec<_>>().join(", ")
    }

    fn start(&self, dispatcher: Option<&SbbkDispatcher>) -> (Driven, Vec<Option<PreparedTree>>) {
        let mut driven = (self.build)();
        let Some(dispatcher) = dispatcher else { return (driven, Vec::new()) };
        driven.world.narrow_phase.set_query_dispatcher(dispatcher.clone());
        let trees = self.prepared.iter().filter_map(|shape| dispatcher.prepare_shape(shape).ok());
        (driven, trees.collect())
    }

    /// Runs both worlds at once, each first in turn.
    fn run(
        &self,
        sides: &mut [Side; 2],
        mut comparison: Option<&mut Comparison>,
        progress: &Progress,
    ) {
        let dispatcher = SbbkDispatcher::default();
        let (stock, _) = self.start(None);
        let (sbbk, _prepared) = self.start(Some(&dispatcher));
        let mut worlds = [stock, sbbk];
        for Driven { world, .. } in &mut worlds {
            world.physics_pipeline.counters.enable();
        }
        for step in 0..self.steps {
            for i in [step % 2, 1 - step % 2] {
                sides[i].step(&mut worlds[i], step);
            }
            if step % MEMORY_EVERY == 0 {
                for (side, Driven { world, .. }) in sides.iter_mut().zip(&worlds) {
                    side.mesh_bytes = side.mesh_bytes.max(mesh_bytes(world));
                }
                sides[1].plugin_bytes = sides[1].plugin_bytes.max(dispatcher.stats().tree_bytes);
            }
            if let Some(comparison) = &mut comparison {
                let stock = &worlds[0].world;
                let is_single = stock.contact_pairs().nth(FEW_PAIRS).is_none();
                let every = if is_single { FEW_EVERY } else { (self.steps / COMPARISONS).max(1) };
                if (step + 1) % every == 0 {
                    comparison.look(stock);
                }
            }
            progress.step();
        }
    }
}

impl Side {
    fn step(&mut self, Driven { world, drive }: &mut Driven, step: usize) {
        let asked = drive(world, step);
        let start = Instant::now();
        world.step();
        let whole = start.elapsed() + asked;
        let detection = asked + world.physics_pipeline.counters.cd.narrow_phase_time.time();
        keep_least(&mut self.detection, step, detection);
        keep_least(&mut self.step, step, whole);
    }
}

fn keep_least(times: &mut Vec<f64>, step: usize, time: Duration) {
    let time = 1e6 * time.as_secs_f64();
    match times.get_mut(step) {
        Some(least) => *least = least.min(time),
        None => times.push(time),
    }
}

/// Parry's own memory of the meshes of a world, each counted once.
fn mesh_bytes(world: &PhysicsWorld) -> usize {
    let shapes = world.colliders.iter().map(|(_, collider)| collider.shape());
    let meshes = shapes.filter_map(|shape| Some((shape_address(shape), shape.as_trimesh()?)));
    let mut meshes: Vec<_> =
        meshes.map(|(address, mesh)| (address, mesh.total_memory_size())).collect();
    meshes.sort_unstable();
    meshes.dedup();
    meshes.into_iter().map(|(_, bytes)| bytes).sum()
}
