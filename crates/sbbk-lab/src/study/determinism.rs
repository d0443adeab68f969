//! Same inputs, same bits: whole worlds run again and again, on other numbers of threads, and
//! under a dispatcher that remembers nothing.

use std::fmt;

use rapier_integration::SbbkDispatcher;
use rapier3d::pipeline::PhysicsWorld;
use rayon::{ThreadPool, ThreadPoolBuilder};
use serde::Serialize;

use super::{Progress, StudyError};
use crate::backend::Backend;
use crate::metrics::{Environment, Fingerprint, StepTimes, Summary, timed_step};
use crate::scene::{BoxStack, HeadOnSlope, HelicopterBallDrop, MonkeyPile, Scene};

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

/// How a scene was run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Way {
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

/// One run of a scene.
#[derive(Clone, Debug, Serialize)]
pub struct DeterminismRun {
    /// How.
    pub way: Way,
    /// The world after the last step.
    pub fingerprint: Fingerprint,
    /// Narrow phase, milliseconds a step.
    pub narrow_phase: Summary,
    /// Whole step, milliseconds.
    pub step: Summary,
}

/// All runs of a scene under one backend.
#[derive(Clone, Debug, Serialize)]
pub struct DeterminismRow {
    /// What the scene calls itself.
    pub scene: String,
    /// Who answered: stock or SBBK.
    pub backend: Backend,
    /// Contact manifolds after the last step.
    pub manifold_count: usize,
    /// The first one is what the others should be.
    pub runs: Vec<DeterminismRun>,
}

impl DeterminismRow {
    /// Whether all runs ended in the same world.
    pub fn is_same(&self) -> bool {
        self.runs.iter().all(|run| run.fingerprint == self.runs[0].fingerprint)
    }
}

/// What was found.
#[derive(Clone, Debug, Serialize)]
pub struct Determinism {
    /// Where.
    pub environment: Environment,
    /// Steps of each run.
    pub steps: usize,
    /// Scene by scene, stock and SBBK.
    pub rows: Vec<DeterminismRow>,
}

impl Determinism {
    /// The scenes whose runs under SBBK differ though they repeat under stock: SBBK's own fault.
    pub fn broken(&self) -> impl Iterator<Item = &DeterminismRow> {
        let pairs = self.rows.chunks_exact(2);
        pairs.filter(|pair| pair[0].is_same() && !pair[1].is_same()).map(|pair| &pair[1])
    }
}

/// Runs all scenes in all ways.
///
/// Errors: a scene cannot be built.
pub fn determinism(plan: &DeterminismPlan, progress: &Progress) -> Result<Determinism, StudyError> {
    let mut rows = Vec::new();
    for scene in &plan.scenes {
        for backend in [Backend::Stock, Backend::Sbbk] {
            rows.push(run_all(&**scene, backend, plan, progress)?);
        }
    }
    progress.finish();
    Ok(Determinism { environment: Environment::detect(), steps: plan.steps, rows })
}

fn run_all(
    scene: &dyn Scene,
    backend: Backend,
    plan: &DeterminismPlan,
    progress: &Progress,
) -> Result<DeterminismRow, StudyError> {
    let mut ways: Vec<Way> = plan.thread_counts.iter().map(|&count| Way::Threads(count)).collect();
    ways.push(Way::Again);
    ways.extend((backend == Backend::Sbbk).then_some(Way::Forgetful));
    let mut row =
        DeterminismRow { scene: scene.name(), backend, manifold_count: 0, runs: Vec::new() };
    for way in ways {
        progress.phase(format!("{}, {backend}, {way}", row.scene), plan.steps);
        let (run, world) = run_once(scene, backend, way, plan, progress)?;
        row.manifold_count = world.contact_pairs().map(|pair| pair.manifolds().len()).sum();
        row.runs.push(run);
    }
    Ok(row)
}

fn run_once(
    scene: &dyn Scene,
    backend: Backend,
    way: Way,
    plan: &DeterminismPlan,
    progress: &Progress,
) -> Result<(DeterminismRun, PhysicsWorld), StudyError> {
    let mut world = scene.build()?.world;
    let installed = backend.install(&mut world);
    let threads = match way {
        Way::Threads(count) => count,
        Way::Again | Way::Forgetful => plan.thread_counts.first().copied().unwrap_or(1),
    };
    let pool = pool(threads);
    let mut times = Vec::with_capacity(plan.steps);
    for _ in 0..plan.steps {
        if way == Way::Forgetful {
            world.narrow_phase.set_query_dispatcher(SbbkDispatcher::default());
        }
        times.push(pool.install(|| timed_step(&mut world, &installed.probe)));
        progress.step();
    }
    let summary =
        |time: fn(&StepTimes) -> f64| Summary::of(times.iter().map(time)).expect("a run has steps");
    let run = DeterminismRun {
        way,
        fingerprint: Fingerprint::of(&world),
        narrow_phase: summary(|times| times.narrow_phase),
        step: summary(|times| times.step),
    };
    Ok((run, world))
}

/// Rapier uses the pool that a step is called in.
fn pool(threads: usize) -> ThreadPool {
    ThreadPoolBuilder::new().num_threads(threads).build().expect("the system can start threads")
}
