//! Same inputs, same bits: whole worlds run again and again, on other numbers of threads, and under
//! a dispatcher that remembers nothing.

use std::fmt;

use rapier_integration::SbbkDispatcher;
use rayon::ThreadPoolBuilder;
use serde_json::Value;

use super::Progress;
use crate::backend::Backend;
use crate::metrics::{Fingerprint, StepTimes, Summary, timed_step};
use crate::report::{Results, Row, Table, TableSpec, faster, number, time};
use crate::scene::{BoxStack, HeadOnSlope, HelicopterBallDrop, MonkeyPile, Scene};

const WORLDS: &str = "determinism";

/// What to run.
pub struct DeterminismPlan {
    /// The scenes.
    pub scenes: Vec<Box<dyn Scene>>,
    /// Steps of each run.
    pub steps: usize,
    /// Numbers of threads. They make a difference only under Rapier's feature `parallel`.
    pub thread_counts: Vec<usize>,
}

impl DeterminismPlan {
    /// The scenes of this crate, some hundred steps each. `heads` is the size of the pile.
    pub fn standard(heads: usize, thread_counts: Vec<usize>) -> Self {
        let scenes: Vec<Box<dyn Scene>> = vec![
            Box::new(MonkeyPile::with_heads(heads)),
            Box::new(MonkeyPile { contact_recycling: false, ..MonkeyPile::with_heads(heads / 2) }),
            Box::new(HelicopterBallDrop::default()),
            Box::new(BoxStack::default()),
            Box::new(HeadOnSlope::default()),
        ];
        Self { scenes, steps: 300, thread_counts }
    }
}

/// How a scene is run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    /// On so many threads.
    Threads(usize),
    /// The same again, on the first number of threads.
    Again,
    /// With a new dispatcher before each step: no tree, no candidate, no feature is known.
    Forgetful,
}

impl fmt::Display for Way {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Threads(count) => write!(f, "{count} threads"),
            Self::Again => f.pad("again"),
            Self::Forgetful => f.pad("forgetful"),
        }
    }
}

/// Runs all scenes in all ways.
pub fn determinism(plan: &DeterminismPlan, progress: &Progress) -> Results {
    let mut rows = Vec::new();
    for scene in &plan.scenes {
        for backend in [Backend::Stock, Backend::Sbbk] {
            let threads = plan.thread_counts.iter().map(|&count| Way::Threads(count));
            let forgetful = (backend == Backend::Sbbk).then_some(Way::Forgetful);
            for way in threads.chain([Way::Again]).chain(forgetful) {
                let name = scene.name();
                progress.phase(format!("{name}, {backend}, {way}"), plan.steps);
                let row = run(&**scene, backend, way, plan, progress);
                rows.push(row.key("scene", name).key("run", way.to_string()));
            }
        }
    }
    progress.finish();
    let tables = tables(&rows, plan.steps);
    Results::new(rows, tables, Vec::new())
}

/// The scenes whose runs under SBBK differ though they repeat under stock: SBBK's own fault.
pub fn broken(results: &Results) -> Vec<String> {
    let mut scenes: Vec<&Value> = results.rows.iter().filter_map(|row| row.get("scene")).collect();
    scenes.dedup();
    let is_same = |scene: &Value, backend: Backend| {
        let runs = results
            .rows
            .iter()
            .filter(|row| row.get("scene") == Some(scene) && row.is("backend", backend));
        let mut fingerprints = runs.map(|row| row.get("fingerprint"));
        let first = fingerprints.next();
        fingerprints.all(|fingerprint| Some(fingerprint) == first)
    };
    let is_broken =
        |scene: &&Value| is_same(scene, Backend::Stock) && !is_same(scene, Backend::Sbbk);
    scenes.into_iter().filter(is_broken).map(Value::to_string).collect()
}

fn run(
    scene: &dyn Scene,
    backend: Backend,
    way: Way,
    plan: &DeterminismPlan,
    progress: &Progress,
) -> Row {
    let mut world = scene.build().world;
    let installed = backend.install(&mut world);
    let threads = match way {
        Way::Threads(count) => count,
        Way::Again | Way::Forgetful => plan.thread_counts.first().copied().unwrap_or(1),
    };
    // Rapier uses the pool that a step is called in.
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.expect("the system can start threads");
    let mut times = Vec::with_capacity(plan.steps);
    for _ in 0..plan.steps {
        if way == Way::Forgetful {
            world.narrow_phase.set_query_dispatcher(SbbkDispatcher::default());
        }
        times.push(pool.install(|| timed_step(&mut world, &installed.probe)));
        progress.step();
    }
    let summary = |time: fn(&StepTimes) -> f64| Summary::of(times.iter().map(time));
    let manifolds: usize = world.contact_pairs().map(|pair| pair.manifolds().len()).sum();
    Row::new(WORLDS, backend)
        .with("fingerprint", Fingerprint::of(&world).to_string())
        .with("manifold_count", manifolds)
        .with("narrow_phase", summary(|times| times.narrow_phase))
        .with("step", summary(|times| times.step))
}

fn tables(rows: &[Row], steps: usize) -> Vec<Table> {
    let side = |header: &str, path| {
        let [stock, sbbk] = [Backend::Stock, Backend::Sbbk]
            .map(|backend| time(&format!("{backend}, {header}"), path).of(backend));
        [stock, sbbk]
    };
    let [narrow, narrow_sbbk] = side("narrow phase", "narrow_phase");
    let [step, step_sbbk] = side("step", "step");
    let worlds = TableSpec::new(
        format!("Worlds after {steps} steps, bit for bit; milliseconds a step"),
        WORLDS,
        &["scene", "run"],
        [
            number("manifolds", "manifold_count").of("sbbk"),
            number("hash, stock", "fingerprint").of("stock"),
            number("hash, sbbk", "fingerprint").of("sbbk"),
            narrow,
            narrow_sbbk,
            faster("ratio", "narrow_phase.mean", "stock").of("sbbk"),
            step,
            step_sbbk,
            faster("ratio", "step.mean", "stock").of("sbbk"),
        ],
    )
    .note(
        "hash: poses, velocities, contacts in their order, features and impulses; all runs of a \
             scene under one backend should have the same",
    )
    .note(
        "forgetful: a new dispatcher before each step, so that no tree, candidate or feature is \
             known, and the time to build the trees is in it",
    )
    .note(
        "times: min / median over the steps; ratios: of means; more threads than one are used \
             only under Rapier's feature `parallel`",
    );
    vec![worlds.of(rows)]
}
