//! Whole runs of a scene on several backends: times, and wrong contacts.
//!
//! Two runs of one scene soon differ, as chaos turns a different last bit into another trajectory.
//! So first queries of the same pairs at the same poses are timed as well.

use super::pair::times;
use crate::prelude::*;

/// Pairs at the same poses that are judged at most.
const JUDGED: usize = 200;

/// Runs of a scene.
#[derive(Clone, Debug)]
pub struct RunPlan {
    /// Backends that run the whole scene. The first one gives the poses for all.
    pub backends: Vec<Backend>,
    /// Runs of each backend. Only the first run is judged.
    pub repeats: usize,
    /// Steps at the start that are neither timed nor judged.
    pub warm_up: usize,
    /// Number of steps after them.
    pub steps: usize,
    /// Steps between two judged ones, which are not timed.
    pub judge_every: usize,
    /// Pairs of meshes that are judged at most in such a step and way (fresh, updated).
    pub judged_pairs: usize,
    /// Sweeps of each backend over all pairs at the same poses, if any.
    pub same_poses: usize,
}

impl RunPlan {
    /// Steps until the lowest heads of a pile land.
    pub const FREE_FALL: usize = 27;

    /// All steps, the warm-up included.
    pub fn step_count(&self) -> usize {
        self.warm_up + self.steps
    }
}

/// Runs a pile, and times its pairs at the same poses.
pub fn pile(scene: &MonkeyPile, plan: &RunPlan, progress: &Progress) -> Vec<Row> {
    let row = Row::new("pile, whole runs", "").key("heads", scene.heads).key("scene", scene.name());
    let runs = run(scene, plan, progress);
    let mut rows: Vec<Row> = runs.iter().map(|runs| summed_up(&row, runs)).collect();
    if plan.same_poses > 0 {
        progress.phase(format!("{}, same poses", scene.name()), 1);
        let row = Row { study: "pile, same poses", ..row };
        rows.extend(same_poses(&row, &runs[0][0].pairs, plan.same_poses));
    }
    rows
}

/// Runs one pile as a study of its own.
pub fn one_pile(scene: &MonkeyPile, plan: &RunPlan, progress: &Progress) -> Results {
    Results::new("pile", pile(scene, plan, progress))
}

/// Runs a scene on all backends step by step in turns, so that a slow spell of the machine slows
/// all of them. Returns the runs of each backend.
pub(super) fn run(scene: &dyn Scene, plan: &RunPlan, progress: &Progress) -> Vec<Vec<Run>> {
    let mut all: Vec<Vec<Run>> = plan.backends.iter().map(|_| Vec::new()).collect();
    progress.phase(scene.name(), plan.repeats * plan.step_count());
    for repeat in 0..plan.repeats {
        let runs = plan.backends.iter().map(|&backend| Run::new(scene, backend));
        let mut runs: Vec<Run> = runs.collect();
        let count = runs.len();
        for step in 1..=plan.step_count() {
            let is_judged = repeat == 0 && step.is_multiple_of(plan.judge_every);
            for turn in 0..count {
                let run = &mut runs[(step + turn) % count];
                match step > plan.warm_up {
                    false => run.built.world.step(),
                    true if is_judged => run.judged_step(plan.judged_pairs),
                    true => run.times.push(timed_step(&mut run.built.world)),
                }
            }
            progress.step();
        }
        all.iter_mut().zip(runs).for_each(|(all, run)| all.push(run));
    }
    all
}

/// A run of a scene on one backend.
pub(super) struct Run {
    built: SceneWorld,
    dispatcher: Dispatcher,
    /// Times of the steps that were not judged, in order.
    times: Vec<StepTimes>,
    /// Errors of first queries for all contacts of triangles. The pairs are sampled from the broad
    /// phase.
    fresh: Errors,
    /// Errors of the answers that Rapier got about the same pairs.
    updated: Errors,
    /// The pairs before the last judged step, for asking other backends.
    pairs: Vec<Sequence>,
}

impl Run {
    fn new(scene: &dyn Scene, backend: Backend) -> Self {
        let mut built = scene.build();
        let dispatcher = backend.install(&mut built.world);
        let (times, pairs) = (Vec::new(), Vec::new());
        let [fresh, updated] = Default::default();
        Self { built, dispatcher, times, fresh, updated, pairs }
    }

    /// Steps once, and judges contacts at the poses at the start of the step, where Rapier asks. It
    /// recycles none in this step.
    fn judged_step(&mut self, limit: usize) {
        let world = &mut self.built.world;
        let colliders;
        (self.pairs, colliders) = Sequence::captured(world);
        let some: Vec<Sequence> = sample(&self.pairs, limit).cloned().collect();
        let dispatcher =
            self.dispatcher.backend.per_triangle(some.iter().flat_map(|pair| &pair.shapes));
        let fresh = Sequence::errors(&some, &[dispatcher], |_| true);
        self.fresh += fresh[0].without_normals();

        let recycles = world.integration_parameters.contact_recycling;
        world.integration_parameters.contact_recycling = false;
        world.step();
        world.integration_parameters.contact_recycling = recycles;
        for (pair, [one, two]) in some.iter().zip(sample(&colliders, limit)) {
            let found = world.narrow_phase.contact_pair(*one, *two);
            let manifolds = found.map_or(&[][..], |pair| pair.manifolds());
            let truth = pair.truth(0);
            let errors = match self.dispatcher.backend {
                Backend::Stock => truth.judge(manifolds),
                _ => truth.judge_surfaces(manifolds),
            };
            self.updated += errors.without_normals();
        }
    }

    /// Mean over the timed steps, in milliseconds.
    fn mean(&self, time: impl Fn(&StepTimes) -> f64) -> f64 {
        self.times.iter().map(time).sum::<f64>() / self.times.len() as f64
    }
}

/// Sums up the runs of one backend. Times are means over the timed steps of a run, in milliseconds.
pub(super) fn summed_up(row: &Row, runs: &[Run]) -> Row {
    let first = &runs[0];
    type Time = fn(&StepTimes) -> f64;
    let times: [(&str, Time); 5] = [
        ("step", |times| times.step),
        ("broad_phase", |times| times.broad_phase),
        ("narrow_phase", |times| times.narrow_phase),
        // The paper's "whole time of CD process".
        ("collision_detection", |times| times.broad_phase + times.narrow_phase),
        ("solver", |times| times.solver),
    ];
    let row = Row { backend: first.dispatcher.backend.to_string(), ..row.clone() };
    let row = times.into_iter().fold(row, |row, (name, time)| {
        row.with(name, Summary::of(runs.iter().map(|run| run.mean(time))))
    });
    let frames = runs.iter().map(|run| 1e3 / run.mean(|times| times.step));
    with_state(row, &first.built)
        .with("frames_per_second", Summary::of(frames))
        .with("fresh", first.fresh)
        .with("updated", first.updated)
}

/// Adds contacts, depths and heights of a world.
fn with_state(row: Row, SceneWorld { world, watched }: &SceneWorld) -> Row {
    let manifolds = world.contact_pairs().flat_map(|pair| pair.manifolds());
    let points = manifolds.map(|manifold| manifold.points.len()).filter(|&count| count > 0);
    let points: Vec<usize> = points.collect();
    let deepest = world.contact_pairs().filter_map(|pair| pair.find_deepest_contact());
    let depths = Summary::of(deepest.map(|(_, point)| f64::from(-point.dist).max(0.0)));
    let heights = watched.iter().map(|&body| f64::from(world.bodies[body].center_of_mass().y));
    row.with("manifolds", points.len())
        .with("points", points.iter().sum::<usize>())
        .with("mean_height", Summary::of(heights).map(|heights| heights.mean))
        .with("mean_depth", depths.map(|depths| depths.mean))
        .with("max_depth", depths.map(|depths| depths.max))
}

/// Times first queries of all pairs: milliseconds for all.
fn same_poses(row: &Row, pairs: &[Sequence], repeats: usize) -> Vec<Row> {
    let shapes = pairs.iter().flat_map(|pair| &pair.shapes);
    let dispatchers = Backend::ALL.map(|backend| backend.per_triangle(shapes.clone()));
    let judged: Vec<Sequence> = sample(pairs, JUDGED).cloned().collect();
    let errors = Sequence::errors(&judged, &dispatchers, |_| true);
    let times = times(&dispatchers, repeats, pairs);
    let rows = Backend::ALL.into_iter().zip(times).zip(errors).map(|((backend, times), errors)| {
        let times = times.iter().map(|time| 1e3 * time.as_secs_f64());
        Row { backend: backend.to_string(), ..row.clone() }
            .with("fresh", Summary::of(times))
            .with("fresh_error", errors.without_normals())
    });
    rows.collect()
}

/// Times of one step, in milliseconds.
///
/// Broad phase, narrow phase and solver are Rapier's own timers. The narrow phase holds the
/// contact queries and what Rapier does with their manifolds (solver contacts, clustering).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct StepTimes {
    /// The whole step, from outside.
    pub step: f64,
    /// Broad phase: before the narrow phase, and the update after the bodies moved.
    broad_phase: f64,
    /// Narrow phase, queries included.
    pub narrow_phase: f64,
    /// Constraint solver.
    solver: f64,
}

/// Steps `world` once.
pub(super) fn timed_step(world: &mut PhysicsWorld) -> StepTimes {
    world.physics_pipeline.counters.enable();
    let start = Instant::now();
    world.step();
    let step = 1e3 * start.elapsed().as_secs_f64();
    let counters = &world.physics_pipeline.counters;
    StepTimes {
        step,
        broad_phase: counters.cd.broad_phase_time.time_ms()
            + counters.cd.final_broad_phase_time.time_ms(),
        narrow_phase: counters.cd.narrow_phase_time.time_ms(),
        solver: counters.stages.solver_time.time_ms(),
    }
}
