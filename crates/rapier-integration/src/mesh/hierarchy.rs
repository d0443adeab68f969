//! Parry's own hierarchy of a mesh, as a tree to descend.
//!
//! It is there before the first query, always that of the mesh as it is now, and in the order of
//! stock's manifolds. So a pair needs nothing else where triangles meet something simple, or where
//! a tree of our own would take longer to build than stock takes to do without.

use std::ops::ControlFlow;

use glamx::Vec3;
use parry3d::bounding_volume::{Aabb, BoundingVolume};
use parry3d::math::{Pose, Real};
use parry3d::partitioning::BvhNode;
use parry3d::query::PointProjection;
use parry3d::shape::{CompositeShape, CompositeShapeRef, Shape, TriMesh};
use sbbk_core::traverse::TestedBox;
use sbbk_core::volumes::Sphere;
use sbbk_core::volumes::rounding::gamma;

use super::identity::MeshToken;
use super::soundness::whole_ones;

/// Whether Parry's hierarchy of a mesh has something within `margin` of the box around a shape at
/// `pos12`, or about: as stock begins. Not to be asked about a broken mesh.
pub(crate) fn is_near(mesh: &TriMesh, shape: &dyn Shape, pos12: &Pose, margin: Real) -> bool {
    !is_finite(&mesh.bvh().root_aabb()) || has_near(mesh, &shape.compute_aabb(pos12), pos12, margin)
}

/// The same of two meshes: of the larger one, and the box of the other.
pub(crate) fn are_near([mesh1, mesh2]: [&TriMesh; 2], pos12: &Pose, margin: Real) -> bool {
    let roots = [mesh1, mesh2].map(|mesh| mesh.bvh().root_aabb());
    if !roots.iter().all(is_finite) {
        return true;
    }
    let [size1, size2] = roots.map(|root| root.half_extents().length_squared());
    if size1 < size2 {
        let pos21 = pos12.inverse();
        has_near(mesh2, &roots[0].transform_by(&pos21), &pos21, margin)
    } else {
        has_near(mesh1, &roots[1].transform_by(pos12), pos12, margin)
    }
}

/// Whether the smaller mesh may be inside the larger one, as its first vertex is covered.
pub(crate) fn may_be_inside([mesh1, mesh2]: [&TriMesh; 2], pos12: &Pose) -> bool {
    let [size1, size2] =
        [mesh1, mesh2].map(|mesh| mesh.bvh().root_aabb().half_extents().length_squared());
    let first = |mesh: &TriMesh| mesh.vertices()[mesh.indices()[0][0] as usize];
    if size1 < size2 {
        is_covered(mesh2, pos12.inverse() * first(mesh1))
    } else {
        is_covered(mesh1, pos12 * first(mesh2))
    }
}

/// Whether the box of some triangle lies in each of the six directions of the axes from a point: so it is
/// for every point inside a closed mesh, and not above a terrain.
pub(crate) fn is_covered(mesh: &TriMesh, point: Vec3) -> bool {
    let root = mesh.bvh().root_aabb();
    if !root.contains_local_point(point) {
        return false;
    }
    let sides = [root.mins - point, root.maxs - point];
    let mut ways = sides.map(|side| [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| side * axis));
    let ways = ways.as_flattened_mut();
    // A short way is the one that is most likely clear, and soonest looked along.
    ways.sort_unstable_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
    ways.iter().all(|&way| {
        // Beyond the side, where rounding may leave a face out.
        let way = BvhNode::leaf(Aabb::from_points([point, point + 2.0 * way]), 0);
        mesh.bvh().leaves(|node| node.intersects(&way)).next().is_some()
    })
}

/// Of [`nearest`], from where a point counts as inside: nearest to such a one is a face.
pub(crate) const BEHIND: Real = 0.9;

/// The point of a mesh that is nearest to another, its triangle, and how far that is seen from behind:
/// the cosine of the angle to its back, 0 of a point on it.
pub(crate) fn nearest(mesh: &TriMesh, point: Vec3) -> Option<(u32, PointProjection, Real)> {
    let (triangle, nearest) =
        CompositeShapeRef(mesh).project_local_point(point, Real::MAX, false)?;
    let away = (point - nearest.point).normalize_or_zero();
    let behind = mesh.triangle(triangle).normal().map_or(0.0, |normal| -away.dot(normal));
    Some((triangle, nearest, behind))
}

fn is_finite(aabb: &Aabb) -> bool {
    aabb.mins.is_finite() && aabb.maxs.is_finite()
}

/// Whether the hierarchy of a mesh has something within `margin` of a box that was placed at `pos12`,
/// or about.
fn has_near(mesh: &TriMesh, aabb: &Aabb, pos12: &Pose, margin: Real) -> bool {
    // Some thirty operations on coordinates that are, before and after a turn, no larger than twice
    // these.
    let size = aabb.mins.abs().max(aabb.maxs.abs()).max_element();
    let grown = margin.max(0.0) + gamma(64) * 2.0 * (size + pos12.translation.abs().max_element());
    // Nowhere without a finite pose: then this is NaN.
    let is_somewhere = grown >= 0.0;
    if !is_somewhere {
        return false;
    }
    let aabb = BvhNode::leaf(aabb.loosened(grown), 0);
    mesh.bvh().leaves(|node| node.intersects(&aabb)).next().is_some()
}

/// The hierarchy of a mesh during one query.
#[derive(Copy, Clone)]
pub(crate) struct Hierarchy<'a> {
    pub(crate) mesh: &'a TriMesh,
    pub(super) token: MeshToken,
    /// The cache of the dispatcher that asks.
    pub(super) owner: u64,
    /// Some vertices are NaN or infinite: boxes above them mean nothing, and triangles that have
    /// them touch nothing.
    pub(super) is_broken: bool,
    /// The box around the mesh: of a broken one around its whole triangles.
    root: Aabb,
}

impl<'a> Hierarchy<'a> {
    pub(crate) fn token(&self) -> MeshToken {
        self.token
    }

    pub(crate) fn is_broken(&self) -> bool {
        self.is_broken
    }

    /// Whether the mesh stays as it is as long as its token does.
    pub(crate) fn is_rigid(&self) -> bool {
        !self.mesh.is_deformable()
    }

    pub(super) fn new(mesh: &'a TriMesh, token: MeshToken, owner: u64, is_broken: bool) -> Self {
        let mut seen = Self { mesh, token, owner, is_broken, root: mesh.bvh().root_aabb() };
        if is_broken {
            let boxes = whole_ones(mesh).map(|index| mesh.triangle(index).local_aabb());
            seen.root = around(boxes);
        }
        seen
    }

    /// The box around the mesh.
    pub(crate) fn root(&self) -> &Aabb {
        &self.root
    }

    /// By which stock chooses the hierarchy to walk first.
    pub(crate) fn size_squared(&self) -> Real {
        self.root.half_extents().length_squared()
    }

    /// The root box in the frame that the mesh is in at `pose`, grown by `reach` and by what
    /// rounding takes from it. Without a finite pose the mesh is nowhere: a box that meets none.
    pub(crate) fn placed_root(&self, pose: &Pose, reach: Real) -> Aabb {
        let root = self.root();
        let size = root.half_extents().length() + root.center().length();
        let grown = reach + gamma(64) * (size + pose.translation.length() + reach);
        let is_somewhere = grown >= 0.0;
        if is_somewhere { root.transform_by(pose).loosened(grown) } else { Aabb::new_invalid() }
    }

    /// The largest absolute coordinate.
    pub(crate) fn magnitude(&self) -> Real {
        let root = self.root();
        root.mins.abs().max(root.maxs.abs()).max_element()
    }

    /// A ball around the mesh.
    pub(crate) fn ball(&self) -> Sphere {
        let root = self.root();
        let (centre, half) = (root.center(), root.half_extents().length());
        Sphere { centre, radius: half + gamma(8) * (centre.length() + half) }
    }

    /// Calls `found` with the triangles whose boxes, and those above them, meet what `meets` tells of,
    /// in stock order, until it has enough.
    #[inline(always)]
    pub(crate) fn near(
        &self,
        meets: impl Fn(TestedBox) -> bool,
        mut found: impl FnMut(u32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        if self.is_broken {
            let mut near = whole_ones(self.mesh).filter(|&index| meets(self.tested(&[index])));
            return near.try_for_each(found);
        }
        for triangle in self.mesh.bvh().leaves(|node| meets(box_of(node))) {
            found(triangle)?;
        }
        ControlFlow::Continue(())
    }

    /// The box around some triangles.
    pub(crate) fn tested(&self, triangles: &[u32]) -> TestedBox {
        let corners = || triangles.iter().flat_map(|&triangle| self.corners(triangle));
        let low = corners().fold(Vec3::INFINITY, Vec3::min);
        TestedBox::new(low, corners().fold(Vec3::NEG_INFINITY, Vec3::max))
    }

    /// The corners of a triangle.
    #[inline(always)]
    pub(crate) fn corners(&self, triangle: u32) -> [Vec3; 3] {
        // Not by `TriMesh::triangle`: what that writes as twelve bytes is read as sixteen, which
        // waits for the store (12 ns).
        let (vertices, [a, b, c]) = (self.mesh.vertices(), self.mesh.indices()[triangle as usize]);
        [vertices[a as usize], vertices[b as usize], vertices[c as usize]]
    }
}

/// The box of a node of Parry's.
#[inline(always)]
pub(crate) fn box_of(node: &BvhNode) -> TestedBox {
    TestedBox::new(node.mins(), node.maxs())
}

fn around(boxes: impl Iterator<Item = Aabb>) -> Aabb {
    boxes.fold(Aabb::new_invalid(), |all, one| all.merged(&one))
}

#[cfg(test)]
mod tests {
    use parry3d::shape::TriMeshFlags;

    use super::*;

    /// Triangles in a row along x, some with a corner that is not finite. Would catch one of these that
    /// is found, a whole one that boxes above it hide, one that is far, and a box around all that is
    /// none.
    #[test]
    fn whole_triangles_of_a_broken_mesh_are_found_in_their_order() {
        let corner = |i: u32| match i {
            3 => Vec3::NAN,
            40 => Vec3::INFINITY,
            _ => Vec3::new((i / 3) as f32, (i % 3) as f32, (i % 3 / 2) as f32),
        };
        let triangles = (0..20).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let vertices = (0..60).map(corner).collect();
        let mesh = TriMesh::with_flags(vertices, triangles, TriMeshFlags::DEFORMABLE).unwrap();
        let seen = Hierarchy::new(&mesh, MeshToken::of(&mesh), 0, true);
        let near = |box_of_it: TestedBox| {
            let mut found = Vec::new();
            let (centre, extent) = box_of_it.centre_extent();
            let meets = |node: TestedBox| {
                let (other, other_extent) = node.centre_extent();
                let apart = (other - centre).abs().cmpgt(extent + other_extent);
                !apart.any()
            };
            let _ = seen.near(meets, |triangle| {
                found.push(triangle);
                ControlFlow::Continue(())
            });
            found
        };
        let whole: Vec<u32> = (0..20).filter(|i| ![1, 13].contains(i)).collect();
        assert_eq!(near(TestedBox::new(Vec3::splat(-1.0), Vec3::splat(30.0))), whole);
        assert_eq!(near(TestedBox::new(Vec3::splat(3.9), Vec3::new(5.1, 30.0, 30.0))), []);
        assert_eq!(
            near(TestedBox::new(Vec3::new(3.9, 0.0, 0.0), Vec3::new(5.1, 1.0, 1.0))),
            [4, 5]
        );
        assert_eq!((seen.root().mins, seen.root().maxs), (Vec3::ZERO, Vec3::new(19.0, 2.0, 1.0)));
    }
}
