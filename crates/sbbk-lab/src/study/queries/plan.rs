//! Which meshes, how many poses, how often.

use crate::mesh::{self, Mesh};

/// What to ask, and how thoroughly.
#[derive(Clone, Debug)]
pub struct QueriesPlan {
    /// The meshes, scaled to two units; and the poses of each at every place.
    pub meshes: Vec<(Mesh, usize)>,
    /// Of these, how many are judged, at most.
    pub judged: usize,
    /// How often all queries are timed.
    pub repeats: usize,
}

/// Longest side of the meshes, in units.
pub const SIZE: f32 = 2.0;

impl QueriesPlan {
    /// Meshes of 288 to 20,000 triangles, within two minutes.
    pub fn standard() -> Self {
        let meshes = [
            (mesh::monkey_head_with(6), 20),
            (mesh::monkey_head_with(11), 12),
            (mesh::helicopter(), 6),
            (mesh::torus(0.7, 0.3, 72, 35), 5),
            (mesh::monkey_head_with(50), 3),
        ];
        Self { meshes: meshes.into(), judged: 4, repeats: 3 }
    }

    /// The two smallest meshes, for trying.
    pub fn quick() -> Self {
        let meshes = Self::standard().meshes.into_iter().take(2);
        let meshes = meshes.map(|(mesh, _)| (mesh, 8)).collect();
        Self { meshes, judged: 4, repeats: 3 }
    }
}
