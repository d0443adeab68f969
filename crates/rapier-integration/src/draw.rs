//! Lines that show contacts, patches, candidates and layers of trees, for any renderer of lines.
//!
//! Each function calls a closure with the ends and the colour of a line. The example `draw` hands
//! the lines to Rapier's debug renderer. Bevy's gizmos take `gizmos.line(a, b, Color::hsla(h, s, l,
//! a))` of `[h, s, l, a] = colour`.

use parry3d::math::{Pose, Real, Vector};
use parry3d::query::ContactManifold;
use parry3d::shape::Shape;
pub use sbbk_core::draw::{
    BOX, CANDIDATES, Colour, KDOP, SPHERE, aabb, candidates, kdop, layer, sphere,
};

/// Colour of contact points that are apart.
pub const APART: Colour = [200.0, 0.9, 0.6, 1.0];
/// Colour of contact points that overlap.
pub const OVERLAPPING: Colour = [0.0, 1.0, 0.5, 1.0];
/// Colour of normals.
pub const NORMAL: Colour = [60.0, 1.0, 0.5, 1.0];
/// Colour of [`patches`].
pub const PATCH: Colour = [120.0, 1.0, 0.5, 1.0];
/// Colours of the [`triangles`] of the two shapes.
pub const TRIANGLES: [Colour; 2] = [[300.0, 0.8, 0.6, 1.0], [30.0, 0.9, 0.6, 1.0]];

/// Draws the contact points of manifolds between shapes at these poses. Each point has a line
/// between the shapes, and its normal.
///
/// ```
/// use parry3d::math::Pose;
/// use parry3d::query::{ContactManifold, PersistentQueryDispatcher, Unsupported};
/// use parry3d::shape::{Ball, TriMesh};
/// use rapier_integration::{SbbkDispatcher, draw};
///
/// let (vertices, indices) = Ball::new(1.0).to_trimesh(24, 12);
/// let mesh = TriMesh::new(vertices, indices).unwrap();
/// let poses = [&Pose::IDENTITY, &Pose::translation(1.99, 0.0, 0.0)];
/// let (mut manifolds, mut workspace) = (Vec::<ContactManifold<(), ()>>::new(), None);
/// SbbkDispatcher::default()
///     .contact_manifolds(poses[1], &mesh, &mesh, 0.02, &mut manifolds, &mut workspace)?;
///
/// let mut lines = Vec::new();
/// let mut line = |a, b, colour| lines.push((a, b, colour));
/// draw::contacts(&manifolds, poses, 0.1, &mut line);
/// draw::triangles(&manifolds, [&mesh, &mesh], poses, &mut line);
/// assert!(lines.len() >= 8);
/// # Ok::<(), Unsupported>(())
/// ```
pub fn contacts<M, C>(
    manifolds: &[ContactManifold<M, C>],
    poses: [&Pose; 2],
    normal_length: Real,
    mut line: impl FnMut(Vector, Vector, Colour),
) {
    for manifold in manifolds {
        let [pose1, pose2] = placed(manifold, poses);
        for point in &manifold.points {
            let [p1, p2] = [pose1 * point.local_p1, pose2 * point.local_p2];
            let normal = pose1.rotation * (normal_length * manifold.local_n1);
            line(p1, p2, if point.dist > 0.0 { APART } else { OVERLAPPING });
            line(p1, p1 + normal, NORMAL);
        }
    }
}

/// Draws lines between all points of each manifold, on the first shape.
pub fn patches<M, C>(
    manifolds: &[ContactManifold<M, C>],
    poses: [&Pose; 2],
    mut line: impl FnMut(Vector, Vector, Colour),
) {
    for manifold in manifolds {
        let [pose, _] = placed(manifold, poses);
        for (index, one) in manifold.points.iter().enumerate() {
            for other in &manifold.points[..index] {
                line(pose * one.local_p1, pose * other.local_p1, PATCH);
            }
        }
    }
}

/// Returns the poses of the subshapes of a manifold.
fn placed<M, C>(manifold: &ContactManifold<M, C>, [pose1, pose2]: [&Pose; 2]) -> [Pose; 2] {
    [(pose1, manifold.subshape_pos1()), (pose2, manifold.subshape_pos2())]
        .map(|(pose, subshape)| subshape.map_or(*pose, |subshape| *pose * *subshape))
}

/// Draws the triangles of meshes that manifolds refer to.
pub fn triangles<M, C>(
    manifolds: &[ContactManifold<M, C>],
    shapes: [&dyn Shape; 2],
    poses: [&Pose; 2],
    mut line: impl FnMut(Vector, Vector, Colour),
) {
    for manifold in manifolds {
        for (side, triangle) in [manifold.subshape1, manifold.subshape2].into_iter().enumerate() {
            let mesh = shapes[side].as_trimesh();
            let Some(mesh) = mesh.filter(|mesh| (triangle as usize) < mesh.indices().len()) else {
                continue;
            };
            let [a, b, c] = mesh.triangle(triangle).vertices().map(|corner| poses[side] * corner);
            for (from, to) in [(a, b), (b, c), (c, a)] {
                line(from, to, TRIANGLES[side]);
            }
        }
    }
}
