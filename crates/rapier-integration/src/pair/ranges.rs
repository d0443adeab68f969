//! Distances up to which contacts of surfaces are searched and filtered.

use parry3d::math::{Pose, Real};
use parry3d::partitioning::BvhNode;

use super::field::Field;
use super::pose::PairPose;
use super::reduce::FILTERED;
use super::triangle_shape::TriangleShape;
use crate::mesh::MeshView;

/// Greatest [`reach`] of fine meshes in filter distances: 0.04 radii. A body of one length unit has a
/// radius of half a unit, and Rapier predicts 0.02 units by default. Higher: fine meshes cost more;
/// lower: bodies come deeper into others before they meet.
const REACH: f64 = 0.4;

/// Greatest product of the numbers of triangles near the other shape with which all pairs are candidates.
/// Higher: small bodies cost more time and memory. Lower: thin plates with soft CCD turn through sheets.
const MOST_PAIRS: usize = 1 << 14;

/// Distance in prediction distances beyond which a contact of edges or vertices needs a normal near
/// both triangle normals. Higher: gears are braked by edges that pass each other; lower: edges meet
/// with less warning.
pub(super) const DISTANT: f64 = 0.25;

/// Least cosine between the normal of a [`DISTANT`] contact and both triangle normals. Higher:
/// smooth bodies lose contacts; lower: gears are braked.
pub(super) const NEAR_NORMAL: f64 = 0.87;

/// Returns the distance up to which contacts must be local minima, from the radius of the smaller shape.
pub(super) fn filter_distance(has_surface: bool, radius: Real) -> f64 {
    if has_surface { f64::from(FILTERED * radius) } else { f64::INFINITY }
}

/// Returns the unit of the filter: the prediction distance, or less for small shapes.
pub(super) fn filter_unit(pose: &PairPose, filter_distance: f64) -> f64 {
    f64::from(pose.prediction).min(filter_distance)
}

/// Returns the distance up to which all contacts of two shapes made of triangles are found.
pub(super) fn reach(
    shapes: &[TriangleShape<'_>; 2],
    pose: &PairPose,
    filter_distance: f64,
) -> Real {
    let most = (REACH * filter_distance) as Real;
    // A prediction distance that is NaN finds nothing.
    if most < pose.prediction && !are_few(shapes, pose) { most } else { pose.prediction }
}

/// Returns true if few pairs of triangles may be within the prediction distance.
fn are_few(shapes: &[TriangleShape<'_>; 2], pose: &PairPose) -> bool {
    let PairPose { pos12, prediction, .. } = *pose;
    let poses = [pos12, pos12.inverse()];
    match shapes {
        [TriangleShape::Mesh(one), TriangleShape::Mesh(two)] => {
            are_few_of_meshes([one.view, two.view], poses, prediction)
        }
        [TriangleShape::Field(field), TriangleShape::Mesh(mesh)] => {
            are_few_of_field(field.field, mesh.view, &poses[0], prediction)
        }
        [TriangleShape::Mesh(mesh), TriangleShape::Field(field)] => {
            are_few_of_field(field.field, mesh.view, &poses[1], prediction)
        }
        [TriangleShape::Field(_), TriangleShape::Field(_)] => true,
    }
}

/// `poses` has each mesh's partner in its frame.
fn are_few_of_meshes(meshes: [&MeshView<'_>; 2], poses: [Pose; 2], prediction: Real) -> bool {
    let count = |i: usize, most: usize| {
        let around = BvhNode::leaf(meshes[1 - i].placed_root(&poses[i], prediction), 0);
        meshes[i].mesh.bvh().leaves(|node| node.intersects(&around)).take(most + 1).count()
    };
    let least = MOST_PAIRS.isqrt();
    match [0, 1].map(|i| count(i, least)) {
        [one, _] if one <= least => one * count(1, MOST_PAIRS / one.max(1)) <= MOST_PAIRS,
        [_, two] if two <= least => two * count(0, MOST_PAIRS / two.max(1)) <= MOST_PAIRS,
        _ => false,
    }
}

/// `pose` is that of the mesh in the frame of the field.
fn are_few_of_field(field: Field<'_>, mesh: &MeshView<'_>, pose: &Pose, prediction: Real) -> bool {
    let under = field.count_under(&mesh.placed_root(pose, prediction));
    mesh.mesh.indices().len() as f64 * under <= MOST_PAIRS as f64
}
