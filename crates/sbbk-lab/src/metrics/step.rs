//! Timed steps of a world.

use crate::prelude::*;

/// Times of one step, in milliseconds.
///
/// Broad phase, narrow phase and solver are Rapier's own timers. The narrow phase holds the
/// contact queries and what Rapier does with their manifolds (solver contacts, clustering).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepTimes {
    /// The whole step, from outside.
    pub step: f64,
    /// Broad phase: before the narrow phase, and the update after the bodies moved.
    pub broad_phase: f64,
    /// Narrow phase, queries included.
    pub narrow_phase: f64,
    /// Constraint solver.
    pub solver: f64,
}

impl StepTimes {
    /// Broad and narrow phase: the paper's "whole time of CD process", in milliseconds.
    pub fn collision_detection(&self) -> f64 {
        self.broad_phase + self.narrow_phase
    }
}

/// Steps `world` once.
pub fn timed_step(world: &mut PhysicsWorld) -> StepTimes {
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
