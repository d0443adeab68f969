//! Depth of meshes in each other, by winding number in f64 and distance to the surface.

use crate::prelude::*;
use std::f64::consts::TAU;

use rapier3d::parry::bounding_volume::Aabb;

/// A mesh with its winding numbers.
pub(super) struct Depths {
    vertices: Vec<Vec3>,
    triangles: Vec<[DVec3; 3]>,
    bounds: Aabb,
    shape: SharedShape,
}

impl Depths {
    pub fn new(mesh: &Mesh) -> Self {
        let corners = (0..mesh.triangle_count()).map(|index| mesh.corners(index));
        Self {
            vertices: mesh.vertices.clone(),
            triangles: corners.map(|corners| corners.map(Vec3::as_dvec3)).collect(),
            bounds: mesh.bounds(),
            shape: mesh.shape(),
        }
    }

    /// Distance of a point to the surface if it is inside, else 0.
    pub fn of(&self, point: Vec3) -> f32 {
        if !self.bounds.contains_local_point(point) || self.winding(point.as_dvec3()) < 0.5 {
            return 0.0;
        }
        (self.shape.project_local_point(point, false).point - point).length()
    }

    /// Depth of the deepest vertex of each mesh in the other; NaN if a pose is NaN.
    pub fn between(&self, pose: &Pose3, other: &Self, others: &Pose3) -> f32 {
        if !(pose.translation + others.translation).is_finite() {
            return f32::NAN;
        }
        let one_way = |outer: &Self, inner: &Self, pose: Pose3| {
            let points = inner.vertices.iter().map(|&vertex| pose.transform_point(vertex));
            points.map(|point| outer.of(point)).fold(0.0, f32::max)
        };
        let pos12 = pose.inv_mul(others);
        one_way(self, other, pos12).max(one_way(other, self, pos12.inverse()))
    }

    /// Winding number of a point (A. van Oosterom, J. Strackee, "The solid angle of
    /// a plane triangle", 1983).
    fn winding(&self, point: DVec3) -> f64 {
        let angles = self.triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|corner| corner - point);
            let [la, lb, lc] = [a.length(), b.length(), c.length()];
            let denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
            a.dot(b.cross(c)).atan2(denominator)
        });
        angles.sum::<f64>() / TAU
    }
}

/// Mean and greatest depth of at most `limit` touching pairs of dynamic bodies, which all have this
/// mesh.
pub(super) fn touching_pairs(world: &PhysicsWorld, depths: &Depths, limit: usize) -> [f64; 2] {
    let pairs = world.contact_pairs().filter_map(|pair| {
        let colliders = [pair.collider1, pair.collider2].map(|handle| &world.colliders[handle]);
        let moves = colliders.iter().all(|collider| {
            collider.parent().is_some_and(|parent| world.bodies[parent].is_dynamic())
        });
        let touches = pair.manifolds().iter().any(|manifold| !manifold.points.is_empty());
        (moves && touches).then(|| colliders.map(|collider| *collider.position()))
    });
    let pairs: Vec<[Pose3; 2]> = pairs.collect();
    let sampled = sample(&pairs, limit);
    let (count, mut mean, mut max) = (sampled.len() as f64, 0.0, 0.0_f64);
    for [one, two] in sampled {
        let depth = f64::from(depths.between(one, depths, two));
        mean += depth / count;
        max = max.max(depth);
    }
    [mean, max]
}
