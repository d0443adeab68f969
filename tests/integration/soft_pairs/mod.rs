//! Meshes that may deform. Each frame has the contacts of a rigid mesh built anew.

use crate::prelude::*;

/// Vertices that are no numbers.
mod broken;
/// Random deformations, motions, and hosts that lose or share state.
mod histories;
/// Rapier's soft bodies.
mod worlds;

/// The answer for a rigid mesh built anew.
pub fn anew(question: &Question) -> Vec<Manifold> {
    let mesh = question.mesh();
    let rigid = rebuilt(mesh, mesh.flags() - TriMeshFlags::DEFORMABLE);
    Question { shapes: [question.shapes[0], &rigid], ..*question }.fresh(&per_triangle())
}

/// Panics unless both have the same manifolds, in any order, bit for bit up to the sign of a zero.
pub fn assert_same_set(found: &[Manifold], expected: &[Manifold]) {
    let [found, expected] = [found, expected].map(|manifolds| {
        let mut sorted = manifolds.to_vec();
        sorted.sort_by_key(triangles);
        sorted
    });
    assert_same(&found, &expected, 0.0);
}

/// A floor of boxes, with balls and a bar on it.
pub fn furniture(bar: SharedShape) -> Compound {
    let mut parts = Vec::new();
    for (x, z) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
        parts.push((Pose::translation(x, -0.1, z), SharedShape::cuboid(1.0, 0.2, 1.0)));
        parts.push((Pose::translation(0.4 * x, 0.1, 0.4 * z), SharedShape::ball(0.2)));
    }
    parts.push((Pose::translation(0.1, 0.2, 0.0), bar));
    Compound::new(parts)
}
