//! Velocities of a pile after one step, beside those of a converged step.
//!
//! A single backend runs the scene. At some moments every backend makes the same step, with
//! several numbers of solver iterations (Rapier's substeps). The *reference* makes the step with
//! every contact, without recycling and clusters, and with far more iterations. Bodies are led
//! along the run for some steps before, so that each solver starts from its own impulses.
//!
//! The error is the change of velocities against the reference, in shares of its contact impulses.
//! Velocities are weighted by mass: their norm is the root of twice the kinetic energy.

use crate::prelude::*;
mod led;

use self::led::{Led, Motion, Norm};

/// Extent of the comparison.
#[derive(Clone, Debug)]
pub struct OneStepPlan {
    /// Heads in the pile.
    pub heads: usize,
    /// Backends that are compared.
    pub backends: Vec<Backend>,
    /// Solver iterations.
    pub substeps: Vec<usize>,
    /// Numbers of the steps in the run.
    pub moments: Vec<usize>,
    /// Solver iterations of the reference.
    pub reference_substeps: usize,
}

impl OneStepPlan {
    /// 200 heads, from landing to rest.
    pub fn standard() -> Self {
        Self {
            heads: 200,
            backends: vec![Backend::Stock, Backend::Sbbk, Backend::Every],
            substeps: vec![1, 2, 4, 8, 16, 32],
            moments: (45..=300).step_by(15).collect(),
            reference_substeps: 256,
        }
    }

    /// 50 heads at three times: for trying, not for quoting.
    pub fn quick() -> Self {
        Self {
            heads: 50,
            substeps: vec![1, 4, 16],
            moments: vec![45, 75, 150],
            reference_substeps: 128,
            ..Self::standard()
        }
    }
}

/// Backend of the run and of the reference: one with every contact.
const REFERENCE: Backend = Backend::Every;
/// Steps before the measured one, in which bodies are led and impulses grow.
const LEAD: usize = 6;

/// A way to make a step.
#[derive(Clone, Copy, Debug)]
struct Way {
    backend: Backend,
    substeps: usize,
    /// True if Rapier merges the contacts of a pair into clusters, and recycles them.
    is_thinned: bool,
}

/// Measurements of one way.
#[derive(Default)]
struct Seen {
    errors: Vec<f64>,
    times: Vec<f64>,
    points: Vec<f64>,
}

pub fn one_step(plan: &OneStepPlan, progress: &Progress) -> Results {
    let scene = &MonkeyPile::with_heads(plan.heads);
    let reference =
        Way { backend: REFERENCE, substeps: plan.reference_substeps, is_thinned: false };
    let mut ways = Vec::new();
    for &substeps in &plan.substeps {
        let way = |&backend: &Backend| Way { backend, substeps, is_thinned: true };
        ways.extend(plan.backends.iter().map(way));
    }

    let last = plan.moments.iter().copied().max().unwrap_or(0);
    progress.phase(format!("{}, the run", scene.name()), last);
    let run = led::run(scene, REFERENCE, last, || progress.step());
    progress.phase(format!("{}, its steps", scene.name()), plan.moments.len() * ways.len());
    let mut seen: Vec<Seen> = ways.iter().map(|_| Seen::default()).collect();
    for &moment in &plan.moments {
        let lead = &run[moment.saturating_sub(LEAD)..=moment];
        let (right, _) = step(scene, &reference, lead);
        let free = Led::without_contacts(scene).lead(&run[moment..=moment]);
        let norm = Norm::of(scene, &run[moment]);
        let impulse = norm.distance(&right, &free);
        // A slow spell of the machine slows all ways.
        for index in 0..ways.len() {
            let index = (index + moment) % ways.len();
            let (motions, mut led) = step(scene, &ways[index], lead);
            let seen = &mut seen[index];
            seen.errors.push(norm.distance(&motions, &right) / impulse);
            seen.points.push(solver_points(&led.built.world) as f64);
            seen.times.append(&mut led.times);
            progress.step();
        }
    }
    let rows = ways.iter().zip(seen).map(|(way, seen)| row(scene, way, seen));
    Results::new("one_step", rows.collect())
}

/// The step after those that lead to it.
fn step(scene: &dyn Scene, way: &Way, lead: &[Vec<Motion>]) -> (Vec<Motion>, Led) {
    let mut led = Led::new(scene, way.backend);
    let parameters = &mut led.built.world.integration_parameters;
    parameters.num_solver_iterations = way.substeps;
    if !way.is_thinned {
        parameters.contact_clustering = false;
        parameters.contact_recycling = false;
    }
    (led.lead(lead), led)
}

fn row(scene: &dyn Scene, way: &Way, seen: Seen) -> Row {
    Row::new("one step", way.backend)
        .key("scene", scene.name())
        .key("substeps", way.substeps)
        .with("error", Summary::of(seen.errors))
        .with("points", Summary::of(seen.points))
        .with("step", Summary::of(seen.times))
}
