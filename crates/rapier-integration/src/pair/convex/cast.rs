//! When a convex shape, moving along a line against a mesh, first comes within a distance.
//!
//! The distance of two convex bodies is a convex function of time, so Newton's method from the start
//! comes to the first impact from before, as for two triangles, or shows that there is none. The
//! directions of curved shapes are not exact: where a step goes too far, the next one is by the rule of
//! false position.

use glamx::DVec3;
use parry3d::math::Real;
use parry3d::partitioning::BvhNode;
use parry3d::query::details::ShapeCastOptions;

use super::features::core_contact;
use super::near::time_of;
use super::nearest::{ConvexSearch, FoundTriangle};
use crate::mesh::box_of;
use crate::pair::pose::MeshPlace;

/// Bodies have come as close as the target if they are this much farther, as a share of size and
/// travel: within this, contacts may count as touching.
const ARRIVED: f64 = 1.0e-10;

/// Steps at most. Grazing impacts gain a binary digit a step; others take two or three steps.
const STEP_LIMIT: usize = 100;

/// An impact.
pub(crate) struct FoundCast {
    /// When, as a multiple of the velocity.
    pub(crate) time: f64,
    /// The contact then: on each body where the point was at the start.
    pub(crate) found: FoundTriangle,
    /// Whether they are closer than the target distance, or cross, at the start.
    pub(crate) is_penetrating: bool,
}

impl ConvexSearch<'_> {
    /// The first impact of shape 2 of the pair, which moves by `velocity12` in the frame of shape 1.
    pub(crate) fn cast(
        &self,
        mesh_place: MeshPlace,
        velocity12: DVec3,
        options: ShapeCastOptions,
    ) -> Option<FoundCast> {
        let ShapeCastOptions { max_time_of_impact, target_distance, .. } = options;
        let target = target_distance.max(0.0);
        let is_possible = max_time_of_impact >= 0.0 && target.is_finite();
        if !is_possible || !velocity12.is_finite() || !self.placed.placement.is_finite() {
            return None;
        }
        // Of a triangle in the frame of the shape, and of the shape in the frame of the mesh.
        let placement = &self.placed.placement;
        let (of_triangle, of_shape) = match mesh_place {
            MeshPlace::First => (-(placement.rotation * velocity12), velocity12),
            MeshPlace::Second => (velocity12, -(placement.inverse * velocity12)),
        };
        let around = self.shape.compute_aabb(self.placed.pose_in_mesh());
        let time = time_of(&self.placed, self.convex, &self.mesh, around, of_shape, target);
        let latest = f64::from(max_time_of_impact);
        // Parry asks for costs below the limit: with the next number above it those equal count too.
        let found = self.mesh.mesh.bvh().find_best(
            max_time_of_impact.next_up(),
            |node: &BvhNode, _| time(box_of(node)),
            |triangle, best| {
                let latest = latest.min(best.into());
                let cast = self.cast_triangle(triangle, of_triangle, options, latest)?;
                Some((cast.time as Real, cast))
            },
        );
        found.map(|(_, (_, cast))| cast)
    }

    /// The first impact of a triangle that moves in the frame of the shape.
    fn cast_triangle(
        &self,
        triangle: u32,
        velocity: DVec3,
        options: ShapeCastOptions,
        latest: f64,
    ) -> Option<FoundCast> {
        let start = self.placed.place(self.mesh.corners(triangle));
        let size = self.size(&start);
        let (radius, target) =
            (f64::from(self.convex.radius()), f64::from(options.target_distance.max(0.0)));
        let speed = velocity.length();
        let mut time = 0.0;
        // When the bodies were last known to be apart, by how much, and along which direction.
        let mut before: Option<(f64, f64, DVec3)> = None;
        for _ in 0..STEP_LIMIT {
            let travel = velocity * time;
            let corners = start.map(|corner| corner + travel);
            let mut contact = core_contact(&corners, self.convex, &self.hull, f64::INFINITY)?;
            let is_core_apart = contact.distance > ARRIVED * size;
            contact.distance -= radius;
            contact.on_shape -= contact.normal * radius;
            contact.on_triangle -= travel;
            let left = contact.distance - target;
            let slack = ARRIVED * (size + travel.abs().element_sum());
            // The shape moves away along the normal as the triangle does along minus that.
            let approach = contact.normal.dot(velocity);
            if left <= slack {
                let is_touching = contact.distance <= slack;
                let Some((earlier, share, normal)) = before else {
                    let counts = options.stop_at_penetration || approach > 0.0;
                    let found = FoundTriangle { triangle, contact, is_touching };
                    let is_penetrating = contact.distance < target;
                    return counts.then_some(FoundCast { time: 0.0, found, is_penetrating });
                };
                if left < -slack && (time - earlier) * speed > slack {
                    time = earlier + (time - earlier) * share / (share - left);
                    continue;
                }
                if !is_core_apart {
                    // That of bodies just apart: those that touch have no better one.
                    contact.normal = normal;
                }
                let found = FoundTriangle { triangle, contact, is_touching };
                return Some(FoundCast { time, found, is_penetrating: false });
            }
            if approach <= 0.0 {
                return None;
            }
            before = Some((time, left, contact.normal));
            time += left / approach;
            // Not "later than": a NaN is no time.
            let in_time = time <= latest;
            if !in_time {
                return None;
            }
        }
        None
    }
}
