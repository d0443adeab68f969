//! The floor under the time of collision detection: the same manifolds, written with no search.
//!
//! Three worlds start equal. One is asked as a user asks it, and its answers are recorded. One is
//! answered by the same dispatcher, timed; one gets the recorded answers, timed: as its manifolds are
//! the same, it stays equal bit for bit. What that takes is Rapier's own broad and narrow phase, and the
//! writing of what the solver needs.

use std::sync::Arc;

use super::Progress;
use super::pile::PilePlan;
use crate::backend::{Backend, Primed, Probe, SharedDispatcher, Tape, Taped, Timed};
use crate::metrics::{Environment, Fingerprint, StepTimes, Summary, timed_step};
use crate::report::{Results, Row, Table, TableSpec, faster, time};
use crate::scene::{MonkeyPile, Scene, SceneWorld};

const STUDY: &str = "floor";
const WAYS: [&str; 2] = ["searched", "written only"];

/// What to run.
#[derive(Clone, Debug)]
pub struct FloorPlan {
    /// Sizes of piles.
    pub heads: Vec<usize>,
    /// Steps after the free fall.
    pub steps: usize,
    /// Runs of each.
    pub repeats: usize,
}

impl FloorPlan {
    /// Piles of 200 and 2000 heads, two seconds of motion.
    pub fn standard() -> Self {
        Self { heads: vec![200, 2000], steps: 120, repeats: 3 }
    }

    /// A smaller pile, once: for trying, not for quoting.
    pub fn quick() -> Self {
        Self { heads: vec![50], steps: 60, repeats: 1 }
    }
}

/// Runs piles with every contact and with patches.
pub fn floor(plan: &FloorPlan, progress: &Progress) -> Results {
    let mut rows = Vec::new();
    for &heads in &plan.heads {
        let scene = MonkeyPile::with_heads(heads);
        for backend in [Backend::Sbbk, Backend::Every] {
            let steps = plan.repeats * (PilePlan::FREE_FALL + plan.steps);
            progress.phase(format!("{heads} heads, {backend}"), steps);
            let runs = (0..plan.repeats).map(|_| run(&scene, backend, plan.steps, progress));
            let runs: Vec<Run> = runs.collect();
            for (way, name) in WAYS.into_iter().enumerate() {
                let summary = |time: fn(&StepTimes) -> f64| {
                    let mean = |times: &Vec<StepTimes>| {
                        times.iter().map(time).sum::<f64>() / times.len() as f64
                    };
                    Summary::of(runs.iter().map(|run| mean(&run.times[way])))
                };
                let row =
                    Row::new(STUDY, name).key("heads", heads).key("contacts", backend.to_string());
                rows.push(
                    row.with("collision_detection", summary(StepTimes::collision_detection))
                        .with("queries", summary(|times| times.mesh_mesh + times.mesh_other))
                        .with("solver", summary(|times| times.solver))
                        .with("step", summary(|times| times.step))
                        .with("are_equal", runs.iter().all(|run| run.are_equal)),
                );
            }
        }
    }
    progress.finish();
    let tables = vec![table(plan, &rows)];
    Results { environment: Environment::detect(), rows, tables, panels: Vec::new() }
}

struct Run {
    /// Searched, and written only.
    times: [Vec<StepTimes>; 2],
    /// Whether the worlds ended equal, bit for bit.
    are_equal: bool,
}

fn run(scene: &MonkeyPile, backend: Backend, steps: usize, progress: &Progress) -> Run {
    let (tape, probes) = (Tape::default(), [(); 3].map(|()| Probe::default()));
    let mut worlds = Vec::new();
    for (i, probe) in probes.iter().enumerate() {
        probe.time_every(PilePlan::QUERY_STRIDE);
        let SceneWorld { mut world, .. } = scene.build();
        let dispatcher = backend.dispatcher();
        let shapes = world.colliders.iter().map(|(_, collider)| collider.shared_shape());
        let primed = Primed::new(&dispatcher, shapes);
        let inner: SharedDispatcher = match i {
            0 => dispatcher.shared,
            1 => Arc::new(Taped::playing(&tape, dispatcher.shared)),
            _ => Arc::new(Taped::recording(&tape, dispatcher.shared)),
        };
        world.narrow_phase.set_query_dispatcher(Timed::new(inner, probe.clone()));
        worlds.push((world, primed));
    }
    let mut times = [const { Vec::new() }; 2];
    for step in 0..PilePlan::FREE_FALL + steps {
        worlds[2].0.step();
        for way in [step % 2, 1 - step % 2] {
            let taken = timed_step(&mut worlds[way].0, &probes[way]);
            if step >= PilePlan::FREE_FALL {
                times[way].push(taken);
            }
        }
        progress.step();
    }
    let [first, others @ ..] = &worlds[..] else { unreachable!("there are three") };
    let hash = Fingerprint::of(&first.0);
    let are_equal = others.iter().all(|other| Fingerprint::of(&other.0) == hash);
    Run { times, are_equal }
}

fn table(plan: &FloorPlan, rows: &[Row]) -> Table {
    let [searched, written] = WAYS;
    let spec = TableSpec::new(
        "The pile with and without a search for its contacts: milliseconds a step",
        STUDY,
        &["heads", "contacts"],
        [
            time("broad + narrow", "collision_detection").of(searched),
            time("floor", "collision_detection").of(written),
            faster("times the floor", "collision_detection.median", written).of(searched).inverse(),
            time("queries", "queries").of(searched),
            time("writing", "queries").of(written),
            time("solver", "solver").of(searched),
            time("step", "step").of(searched),
            time("step at the floor", "step").of(written),
        ],
    );
    spec.note(format!(
        "means of the {} steps after the first heads land, min / median over {} runs; floor: the \
             same manifolds written from a recording, in a world that stays equal bit for bit",
        plan.steps, plan.repeats
    ))
    .of(rows)
}
