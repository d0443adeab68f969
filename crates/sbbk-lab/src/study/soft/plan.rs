//! All of it in one go.

use serde::Serialize;

use super::heads::{SoftHeadsRow, soft_heads};
use super::refit::{RefitStudy, refit};
use crate::metrics::Environment;
use crate::scene::{Scene, SoftHeads};
use crate::study::{Progress, StudyError};

/// How much to measure.
#[derive(Clone, Copy, Debug)]
pub struct SoftPlan {
    /// Soft heads.
    pub heads: usize,
    /// Steps of each run.
    pub steps: usize,
    /// Timed runs of each backend.
    pub repeats: usize,
    /// Every so many steps of a run of its own are judged.
    pub judged_every: usize,
    /// Subdivision of the large ball: 8 times its square triangles.
    pub detail: u32,
    /// Frames through which the ball deforms; at least one.
    pub frames: usize,
}

impl SoftPlan {
    /// Within two minutes on two cores.
    pub fn standard() -> Self {
        Self { heads: 6, steps: 90, repeats: 3, judged_every: 10, detail: 112, frames: 500 }
    }

    /// Some seconds.
    pub fn quick() -> Self {
        Self { heads: 3, repeats: 1, judged_every: 15, detail: 35, frames: 50, ..Self::standard() }
    }
}

/// What [`soft`] found.
#[derive(Clone, Debug, Serialize)]
pub struct Soft {
    /// Machine and build.
    pub environment: Environment,
    /// The scene's name.
    pub scene: String,
    /// By backend.
    pub heads: Vec<SoftHeadsRow>,
    /// The large mesh.
    pub refit: RefitStudy,
}

/// Measures both.
///
/// Errors: a mesh does not serve.
pub fn soft(plan: &SoftPlan, progress: &Progress) -> Result<Soft, StudyError> {
    let scene = SoftHeads::with_heads(plan.heads);
    let study = Soft {
        environment: Environment::detect(),
        scene: scene.name(),
        heads: soft_heads(&scene, plan, progress)?,
        refit: refit(plan, progress)?,
    };
    progress.finish();
    Ok(study)
}
