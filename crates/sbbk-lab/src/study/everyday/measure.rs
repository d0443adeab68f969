//! Runs of a scene under stock Rapier and under SBBK, in turns. Brute force in f64 judges contacts
//! of both.

use crate::prelude::*;
use rapier_integration::{PreparedTree, SbbkDispatcher};

use crate::study::pair::SIDES;
use crate::study::runs::timed_step;

/// A world that can be built again and again, and its drive.
pub(super) struct Everyday<'a> {
    /// Study and keys of the rows.
    pub row: Row,
    pub steps: usize,
    pub build: Box<dyn Fn() -> Driven + 'a>,
    /// Shapes that SBBK prepares before the first step.
    pub prepared: Vec<SharedShape>,
}

/// Called before each step with its number, from 0. Returns the time of its own queries, which
/// counts as collision detection.
pub(super) type Drive = dyn FnMut(&mut PhysicsWorld, usize) -> Duration;

pub(super) struct Driven {
    pub world: PhysicsWorld,
    pub drive: Box<Drive>,
}

impl Driven {
    /// A world without a drive.
    pub fn alone(world: PhysicsWorld) -> Self {
        Self::by(world, |_, _| ())
    }

    /// A world with a drive that asks nothing.
    pub fn by(
        world: PhysicsWorld,
        mut drive: impl FnMut(&mut PhysicsWorld, usize) + 'static,
    ) -> Self {
        let drive = move |world: &mut PhysicsWorld, step| {
            drive(world, step);
            Duration::ZERO
        };
        Self { world, drive: Box::new(drive) }
    }
}

/// Steps between two samples of memory.
const MEMORY_EVERY: usize = 10;
/// Looks at the contacts of a run; worlds with few pairs are looked at after so many steps.
const COMPARISONS: usize = 3;
const FEW_PAIRS: usize = 3;
const FEW_EVERY: usize = 4;
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

    /// Makes the scene run on `threads` threads.
    #[cfg(feature = "parallel")]
    pub fn on_threads(self, study: &'static str, threads: usize) -> Self {
        let build = move || {
            let mut driven = (self.build)();
            let pool = driven.world.configure_thread_pool(threads);
            pool.expect("the machine has memory for threads");
            driven
        };
        let row = Row { study, ..self.row }.key("threads", threads);
        Self { row, build: Box::new(build), ..self }
    }

    /// Runs the scene `repeats` times on both backends, step by step in turns.
    pub fn measure(&self, repeats: usize, progress: &Progress) -> [Row; 2] {
        let repeats = repeats.max(1);
        progress.phase(self.row.scene(), self.steps * repeats);
        let mut sides: [Side; 2] = Default::default();
        let mut comparison = Comparison::new();
        for repeat in 0..repeats {
            self.run(&mut sides, (repeat == 0).then_some(&mut comparison), progress);
        }
        [0, 1].map(|index| {
            let (backend, side) = (SIDES[index].to_string(), &sides[index]);
            let mebibytes = |bytes: usize| bytes as f64 / (1 << 20) as f64;
            Row { backend, ..self.row.clone() }
                .with("steps", self.steps)
                .with("detection", Summary::of(side.detection.iter().copied()))
                .with("step", Summary::of(side.step.iter().copied()))
                .with("mesh_mebibytes", mebibytes(side.mesh_bytes))
                .with("plugin_mebibytes", mebibytes(side.plugin_bytes))
                .with("judged", comparison.judged[index])
        })
    }

    /// Runs both worlds at once, each first in turn.
    fn run(
        &self,
        sides: &mut [Side; 2],
        mut comparison: Option<&mut Comparison>,
        progress: &Progress,
    ) {
        let dispatcher = SbbkDispatcher::default();
        let prepare = |shape| dispatcher.prepare_shape(shape).ok()?;
        let _trees: Vec<PreparedTree> = self.prepared.iter().filter_map(prepare).collect();
        let mut worlds = [(self.build)(), (self.build)()];
        worlds[1].world.narrow_phase.set_query_dispatcher(dispatcher.clone());
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
        let asked = 1e3 * drive(world, step).as_secs_f64();
        let timed = timed_step(world);
        let timed = [(&mut self.detection, timed.narrow_phase), (&mut self.step, timed.step)];
        for (times, time) in timed {
            let time = 1e3 * (asked + time);
            match times.get_mut(step) {
                Some(least) => *least = least.min(time),
                None => times.push(time),
            }
        }
    }
}

/// Parry's own memory of the meshes of a world, each counted once.
fn mesh_bytes(world: &PhysicsWorld) -> usize {
    let shapes = world.colliders.iter().map(|(_, collider)| collider.shared_shape());
    let meshes = shapes.filter_map(|shape| Some((Arc::as_ptr(&shape.0), shape.as_trimesh()?)));
    let meshes: HashMap<*const (), usize> =
        meshes.map(|(address, mesh)| (address.cast(), mesh.total_memory_size())).collect();
    meshes.into_values().sum()
}

/// Pairs that are judged at most: in all, and of one step. Higher: slower studies; lower: less
/// certain verdicts.
const JUDGED: usize = 20;
const JUDGED_AT_ONCE: usize = 7;

/// Wrong contacts of stock and of SBBK, without memory of a pair, for all contacts of triangles.
struct Comparison {
    dispatchers: [Dispatcher; 2],
    judged: [Errors; 2],
}

impl Comparison {
    fn new() -> Self {
        let dispatchers = SIDES.map(|backend| backend.per_triangle([]));
        Self { dispatchers, judged: Default::default() }
    }

    /// Judges some of the pairs of the broad phase of a world.
    fn look(&mut self, world: &PhysicsWorld) {
        let limit = JUDGED_AT_ONCE.min(JUDGED - self.judged[0].pairs.min(JUDGED));
        if limit == 0 {
            return;
        }
        let contacts = world.contact_pairs().map(|pair| [pair.collider1, pair.collider2]);
        let contacts: Vec<Sequence> = contacts.filter_map(|pair| plain_pair(world, pair)).collect();
        let sensors = world.intersection_pairs().map(|(one, _, two, ..)| [one, two]);
        let sensors: Vec<Sequence> = sensors.filter_map(|pair| plain_pair(world, pair)).collect();
        let shapes = contacts.iter().chain(&sensors).flat_map(|pair| &pair.shapes);
        self.dispatchers[1].prepare(shapes);
        let touches = |pair: &Sequence| {
            self.dispatchers.iter().any(|dispatcher| {
                let answer = pair.first_answer(dispatcher);
                answer.iter().any(|manifold| !manifold.points.is_empty())
            })
        };
        let touching: Vec<Sequence> = contacts.into_iter().filter(touches).collect();
        let touching: Vec<Sequence> = sample(&touching, limit).cloned().collect();
        let found = Sequence::errors(&touching, &self.dispatchers, |_| true);
        for (errors, found) in self.judged.iter_mut().zip(found) {
            *errors += found.without_normals();
        }
        sample(&sensors, limit).for_each(|pair| self.judge_sensor(pair));
    }

    /// Judges if the surfaces of two meshes meet; ignores other shapes.
    fn judge_sensor(&mut self, pair: &Sequence) {
        let [shape1, shape2] = &pair.shapes;
        if shape1.as_trimesh().and(shape2.as_trimesh()).is_none() {
            return;
        }
        let meets = pair.truth(0).meets();
        for (errors, dispatcher) in self.judged.iter_mut().zip(&self.dispatchers) {
            let answer = dispatcher.intersection_test(&pair.poses[0], &**shape1, &**shape2);
            let answer = answer.is_ok_and(|answer| answer.intersecting);
            errors.pairs += 1;
            errors.true_pairs += 1;
            errors.missed += usize::from(meets && !answer);
            errors.phantom += usize::from(answer && !meets);
        }
    }
}

/// Returns a pair at its pose in a world. `None` without a mesh, and with `FIX_INTERNAL_EDGES`:
/// that flag changes the contacts of triangles.
fn plain_pair(world: &PhysicsWorld, pair: [ColliderHandle; 2]) -> Option<Sequence> {
    let pair = Sequence::of(world, pair);
    let mut meshes = pair.shapes.iter().filter_map(|shape| shape.as_trimesh()).peekable();
    meshes.peek()?;
    let is_fixed = meshes.any(|mesh| mesh.flags().contains(TriMeshFlags::FIX_INTERNAL_EDGES));
    (!is_fixed).then_some(pair)
}
