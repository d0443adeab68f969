//! Heads that fall on a terrain in a whole world: how many stay on it.

use serde::Serialize;

use crate::backend::Backend;
use crate::scene::{Ground, HeadsOnTerrain, Scene, SceneError};
use crate::study::Progress;

/// Heads that fall, as the side of a square.
const SIDE_COUNT: usize = 4;
/// How many fall.
pub const HEAD_COUNT: usize = SIDE_COUNT * SIDE_COUNT;
/// A head whose origin is lower than this, in units, is under the terrain, whose valleys are less deep.
const UNDER: f32 = -2.0;

/// Heads on one ground, under one backend.
#[derive(Clone, Debug, Serialize)]
pub struct Fall {
    /// Who answered.
    pub backend: Backend,
    /// What the terrain was.
    pub ground: Ground,
    /// How many are not under the terrain, after each step of a sixtieth of a second.
    pub heads_above: Vec<usize>,
}

impl Fall {
    /// The world before they fall.
    pub fn scene(ground: Ground) -> HeadsOnTerrain {
        HeadsOnTerrain { side_count: SIDE_COUNT, cells: 24, ground }
    }

    /// How many are left at the end.
    pub fn left(&self) -> usize {
        self.heads_above.last().copied().unwrap_or(HEAD_COUNT)
    }
}

/// Both dispatchers on a height field, and SBBK on the mesh of the same triangles.
pub(super) fn falls(steps: usize, progress: &Progress) -> Result<Vec<Fall>, SceneError> {
    let ways = [
        (Backend::Stock, Ground::HeightField),
        (Backend::Sbbk, Ground::Mesh),
        (Backend::Sbbk, Ground::HeightField),
    ];
    progress.phase("falling heads", ways.len());
    let fall = |(backend, ground)| {
        progress.step();
        fall(backend, ground, steps)
    };
    ways.into_iter().map(fall).collect()
}

fn fall(backend: Backend, ground: Ground, steps: usize) -> Result<Fall, SceneError> {
    let mut built = Fall::scene(ground).build()?;
    let _installed = backend.install(&mut built.world);
    let heads_above = (0..steps).map(|_| {
        built.world.step();
        let heights = built.watched.iter().map(|&body| built.world.bodies[body].translation().y);
        heights.filter(|&height| height > UNDER).count()
    });
    Ok(Fall { backend, ground, heads_above: heads_above.collect() })
}
