//! Rays through the BVH of a mesh, which tell the kind of the mesh and the sides of its triangles.

use std::ops::ControlFlow;

use glamx::DVec3;
use parry3d::bounding_volume::BoundingVolume;
use parry3d::math::Real;
use parry3d::partitioning::BvhNode;
use parry3d::shape::TriMesh;
use sbbk_core::surface::{RayTriangles, area_vector};

/// Rays through the BVH of a mesh.
pub(super) struct MeshRays<'a>(pub(super) &'a TriMesh);

impl RayTriangles for MeshRays<'_> {
    fn count(&self) -> u32 {
        self.0.indices().len() as u32
    }

    fn corners(&self, triangle: u32) -> [DVec3; 3] {
        let corners = self.0.indices()[triangle as usize];
        corners.map(|corner| self.0.vertices()[corner as usize].as_dvec3())
    }

    fn bounds(&self) -> [DVec3; 2] {
        let bounds = self.0.bvh().root_aabb();
        [bounds.mins, bounds.maxs].map(|corner| corner.as_dvec3())
    }

    fn near(&self, triangle: u32, slack: f64, visit: &mut dyn FnMut(u32) -> ControlFlow<()>) {
        let bounds = self.0.triangle(triangle).local_aabb().loosened((slack as Real).next_up());
        let bounds = BvhNode::leaf(bounds, 0);
        let corners @ [a, ..] = self.corners(triangle);
        let normal = area_vector(&corners).normalize_or_zero();
        // The box of a slanted triangle may hold a whole mesh.
        let is_near = |node: &BvhNode| {
            let [low, high] = [node.mins(), node.maxs()].map(|corner| corner.as_dvec3());
            let height = normal.dot(0.5 * (low + high) - a).abs();
            node.intersects(&bounds) && height <= normal.abs().dot(0.5 * (high - low)) + slack
        };
        let _ = self.0.bvh().leaves(is_near).try_for_each(visit);
    }

    fn along(&self, start: DVec3, direction: DVec3, visit: &mut dyn FnMut(u32) -> ControlFlow<()>) {
        let inverse = direction.recip();
        let is_met = |node: &BvhNode| {
            let [low, high] =
                [node.mins(), node.maxs()].map(|corner| (corner.as_dvec3() - start) * inverse);
            let (first, last) = (low.min(high).max_element(), low.max(high).min_element());
            last >= 0.0 && first <= last + RAY_ROUNDING * last
        };
        let _ = self.0.bvh().leaves(is_met).try_for_each(visit);
    }
}

/// Rounding of the lengths at which rays meet boxes.
const RAY_ROUNDING: f64 = 1.0e-12;
