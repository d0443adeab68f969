//! Trees built ahead of the first query that is timed.

use rapier3d::geometry::{ContactManifold, SharedShape, TriMesh};
use rapier3d::math::Pose;
use rapier3d::parry::query::ContactManifoldsWorkspace;

use super::{SharedDispatcher, shape_address};

/// What a dispatcher remembers after it was asked about each of some meshes: SBBK builds trees of
/// small meshes unasked, up to 8192 triangles at once, and may drop them when no pair needs them any
/// more. Building is measured on its own, so that times of queries and steps should not hold it.
/// Larger meshes stay without trees.
pub struct Primed(#[expect(dead_code, reason = "kept alive")] Vec<ContactManifoldsWorkspace>);

impl Primed {
    /// Asks `dispatcher` about each distinct mesh among `shapes`, against itself.
    pub fn new<'a>(
        dispatcher: &SharedDispatcher,
        shapes: impl IntoIterator<Item = &'a SharedShape>,
    ) -> Self {
        let is_mesh = |shape: &&&SharedShape| shape.as_shape::<TriMesh>().is_some();
        let meshes = shapes.into_iter();
        let mut meshes: Vec<&SharedShape> = meshes.filter(|shape| is_mesh(&shape)).collect();
        meshes.sort_by_key(|shape| shape_address(&***shape));
        meshes.dedup_by_key(|shape| shape_address(&***shape));
        let ask = |mesh: &SharedShape| {
            let (mut manifolds, mut workspace) = (Vec::<ContactManifold>::new(), None);
            // The boxes touch, or SBBK would not need the tree; hardly any triangles do.
            let width = mesh.compute_local_aabb().extents().x;
            let pos12 = Pose::translation(width, 0.0, 0.0);
            dispatcher
                .contact_manifolds(&pos12, &**mesh, &**mesh, 0.0, &mut manifolds, &mut workspace)
                .ok()?;
            workspace
        };
        Self(meshes.into_iter().filter_map(ask).collect())
    }
}
