//! Whole runs of a scene on one backend.

use super::{WorldState, judged_step, timed_step};
use crate::prelude::*;

/// Steps and samples of a run.
#[derive(Clone, Copy, Debug, Default)]
pub struct RunPlan {
    /// Steps at the start that are neither timed nor sampled.
    pub warm_up: usize,
    /// Number of steps after them.
    pub steps: usize,
    /// Steps between two samples of state and error; 0 for none. Sampled steps are not timed.
    pub sample_every: usize,
    /// At most this many mesh pairs are judged in each sampled step and way (fresh, updated).
    pub sample_size: usize,
}

impl RunPlan {
    /// All steps, the warm-up included.
    pub fn step_count(&self) -> usize {
        self.warm_up + self.steps
    }
}

/// What [`run`] measured.
#[derive(Debug)]
pub struct Run {
    pub backend: Backend,
    /// Times of the steps that were not sampled, in order.
    pub times: Vec<StepTimes>,
    pub samples: Vec<Sample>,
}

/// Measurements of a sampled step.
///
/// Both errors are judged at the poses at the start of the step, where Rapier asks.
#[derive(Debug)]
pub struct Sample {
    /// The world after the step.
    pub state: WorldState,
    /// Error of fresh answers: pairs sampled from all those of the broad phase, asked with
    /// nothing known about them for all contacts of triangles.
    pub fresh: ErrorCount,
    /// Error of the answers that Rapier got: pairs sampled from those that it updated in this
    /// step, with their manifolds and workspace of earlier steps. Pairs that Rapier recycled were
    /// not asked; their contacts are up to 0.05 units old on any backend, and not judged. Contacts of
    /// surfaces are judged as [such](super::Truth::judge_surfaces).
    pub updated: ErrorCount,
    /// The pairs, for asking other backends.
    pub pairs: Vec<Sequence>,
}

impl Run {
    /// Steps a second, over the timed steps.
    pub fn frames_per_second(&self) -> f64 {
        let total: f64 = self.times.iter().map(|times| times.step).sum();
        1e3 * self.times.len() as f64 / total
    }

    /// Mean over the timed steps, in milliseconds; NaN without steps.
    pub fn mean(&self, time: impl Fn(&StepTimes) -> f64) -> f64 {
        self.times.iter().map(time).sum::<f64>() / self.times.len() as f64
    }

    /// Errors of all samples together.
    pub fn total(&self, error: impl Fn(&Sample) -> ErrorCount) -> ErrorCount {
        self.samples.iter().map(error).sum()
    }
}

/// A run under way, step by step: several runs can take turns.
pub struct Runner {
    built: SceneWorld,
    installed: Installed,
    plan: RunPlan,
    step: usize,
    run: Run,
}

impl Runner {
    /// A run of `scene` on `backend` before its first step.
    pub fn new(scene: &dyn Scene, backend: Backend, plan: RunPlan) -> Self {
        let mut built = scene.build();
        let installed = backend.install(&mut built.world);
        let run = Run { backend, times: Vec::with_capacity(plan.steps), samples: Vec::new() };
        Self { built, installed, plan, step: 0, run }
    }

    /// Steps once: untimed in the warm-up, else timed or sampled.
    pub fn step(&mut self) {
        self.step += 1;
        // Steps are counted from one, and only zero is a multiple of zero.
        let is_sampled = self.step.is_multiple_of(self.plan.sample_every);
        let SceneWorld { world, .. } = &mut self.built;
        if self.step <= self.plan.warm_up {
            world.step();
        } else if is_sampled {
            let sample = self.sampled_step();
            self.run.samples.push(sample);
        } else {
            self.run.times.push(timed_step(world));
        }
    }

    fn sampled_step(&mut self) -> Sample {
        let SceneWorld { world, watched } = &mut self.built;
        let (backend, limit) = (self.run.backend, self.plan.sample_size);
        let mut updated = ErrorCount::default();
        let pairs = Sequence::captured(world, |world| {
            updated = judged_step(world, &self.installed.probe, limit, backend.has_surfaces());
        });
        let sampled = sample_indices(pairs.len(), limit).into_iter();
        let sampled: Vec<Sequence> = sampled.map(|index| pairs[index].clone()).collect();
        let dispatcher = backend.per_triangle();
        let _primed = Primed::new(&dispatcher, sampled.iter().flat_map(|pair| &pair.shapes));
        let [fresh] = Sequence::errors(&sampled, [&dispatcher.shared], |index, step| {
            (step == 0).then(|| sampled[index].truth(step))
        });
        let fresh = ErrorCount { sampled_from: pairs.len(), ..fresh.pairs };
        Sample { state: WorldState::of(world, watched), fresh, updated, pairs }
    }

    pub fn finish(self) -> Run {
        self.run
    }
}

/// Runs `scene` on `backend` from start to end.
pub fn run(scene: &dyn Scene, backend: Backend, plan: RunPlan) -> Run {
    let mut runner = Runner::new(scene, backend, plan);
    (0..plan.step_count()).for_each(|_| runner.step());
    runner.run
}
