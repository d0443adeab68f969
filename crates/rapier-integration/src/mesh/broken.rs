//! A deformable mesh of which some vertices are NaN or infinite: a simulation that has gone wrong
//! in one place.
//!
//! Its other triangles touch as before; those of such a vertex touch nothing. Parry looks at some
//! of them, and then can panic, or loses others: the boxes of its hierarchy mean nothing above a
//! NaN.

use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::{Pose, Real};
use parry3d::shape::{CompositeShape, TriMesh};
use sbbk_core::tree::{BuildError, BuildOptions, Tree};
use sbbk_core::volumes::rounding::gamma;

/// A tree, and the triangles that are broken, in ascending order: the tree has them as points
/// somewhere on the mesh.
///
/// # Errors
/// Why the mesh cannot have a tree, if no triangle is whole or for another reason.
pub(super) fn build(
    mesh: &TriMesh,
    options: &BuildOptions,
) -> Result<(Tree, Vec<u32>), BuildError> {
    let (vertices, triangles) = (mesh.vertices(), mesh.indices());
    let is_finite = |&vertex: &u32| vertices.get(vertex as usize).is_some_and(|v| v.is_finite());
    let is_whole = |triangle: &[u32; 3]| triangle.iter().all(is_finite);
    let whole = triangles.iter().find(|triangle| is_whole(triangle));
    // Without one the build says why not.
    let Some(&[somewhere, ..]) = whole else {
        return Ok((Tree::build(vertices, triangles, options)?, Vec::new()));
    };
    let (mut standing_in, mut broken) = (triangles.to_vec(), Vec::new());
    for (index, triangle) in standing_in.iter_mut().enumerate() {
        if !is_whole(triangle) {
            broken.push(index as u32);
            *triangle = [somewhere; 3];
        }
    }
    Ok((Tree::build(vertices, &standing_in, options)?, broken))
}

/// The box around a mesh, as Parry's hierarchy has it; `None` if it is not finite, or if the mesh
/// deforms and is broken.
pub(crate) fn root_box(mesh: &TriMesh) -> Option<Aabb> {
    let root = mesh.bvh().root_aabb();
    let has_box = root.mins.is_finite() && root.maxs.is_finite();
    let is_whole = || mesh.vertices().iter().all(|vertex| vertex.is_finite());
    (has_box && (!mesh.is_deformable() || is_whole())).then_some(root)
}

/// The same in the frame that the mesh is in at `pose`, grown by `reach` and by what rounding takes
/// from it. Without a finite pose the mesh is nowhere: a box that meets none.
pub(crate) fn placed_root_box(mesh: &TriMesh, pose: &Pose, reach: Real) -> Option<Aabb> {
    let root = root_box(mesh)?;
    let size = root.half_extents().length() + root.center().length();
    let grown = reach + gamma(64) * (size + pose.translation.length() + reach);
    let is_somewhere = grown >= 0.0;
    Some(if is_somewhere { root.transform_by(pose).loosened(grown) } else { Aabb::new_invalid() })
}
