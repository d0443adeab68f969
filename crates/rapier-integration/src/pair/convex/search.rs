//! Queries of a mesh and one convex shape: nearest, touching and deepest triangles.

use std::cell::Cell;
use std::ops::ControlFlow;

use glamx::{DVec3, Vec3};
use parry3d::bounding_volume::Aabb;
use parry3d::math::{Pose, Real};
use parry3d::partitioning::BvhNode;
use parry3d::shape::Shape;
use sbbk_core::contact::convex::ConvexContact;
use sbbk_core::traverse::{DescentCounts, Placement, TestedBox};
use sbbk_core::volumes::Sphere;
use sbbk_core::volumes::rounding::gamma;

use super::contact::{core_contact, core_support, core_touches};
use super::near::{lowest, plane, triangles_near};
use super::parts::{Part, PlacedPart};
use super::shape::{ConvexShape, Extent, KeptHull};
use crate::mesh::{MeshView, box_of};
use crate::pair::pose::{MeshPlace, PairPose, ROUNDING};

/// Distance up to which bodies touch, as a share of their coordinates in the frame of the shape:
/// the rounding of a distance of zero. Higher: bodies touch early; lower: rounding separates
/// bodies.
const TOUCHING: f64 = 1.0e-12;

/// Limit, as a share of the smaller body's size, above which searches for the deepest contact first
/// look for one that is near. Changes time alone. Higher: slower far from the mesh; lower: slower
/// near it.
pub(crate) const WIDE: f64 = 0.1;

/// A mesh and one convex shape at a pose.
pub(crate) struct ConvexSearch<'a> {
    pub(crate) mesh: MeshView<'a>,
    pub(crate) mesh_place: MeshPlace,
    pub(crate) shape: &'a dyn Shape,
    pub(super) convex: ConvexShape<'a>,
    pub(crate) placed: PlacedPart,
    /// The shape in the frame of the mesh.
    pub(super) pose_in_mesh: Pose,
    pub(super) hull: KeptHull,
}

/// A triangle of the mesh and its contact.
#[derive(Copy, Clone)]
pub(crate) struct FoundTriangle {
    pub(crate) triangle: u32,
    /// In the frame of the shape, from the mesh to the shape.
    pub(crate) contact: ConvexContact,
    pub(crate) is_touching: bool,
}

/// A plane on which the shape stands, across the normal of a contact. All of the mesh that is
/// farther than the contact is below the plane by more than its distance.
#[derive(Copy, Clone)]
pub(super) struct SupportPlane {
    /// Unit vector from the mesh to the shape, in the frame of the shape.
    pub(super) normal: DVec3,
    /// The normal in the frame of the mesh, where the plane is at `height`.
    normal_in_mesh: DVec3,
    height: f64,
}

impl SupportPlane {
    /// Returns the gap between a triangle and the shape along the normal. No distance is less, as
    /// the distance is the greatest gap of all directions.
    fn gap(&self, corners: [Vec3; 3]) -> f64 {
        let heights = corners.map(|corner| self.normal_in_mesh.dot(corner.as_dvec3()));
        self.height - heights.into_iter().fold(f64::NEG_INFINITY, f64::max)
    }

    /// Returns the gap between a box of the mesh and the shape along the normal.
    pub(super) fn gap_of_box(&self, node: TestedBox) -> f64 {
        self.height + lowest(node, -self.normal_in_mesh)
    }
}

impl<'a> ConvexSearch<'a> {
    /// `convex` is `shape`. `pos12` is the pose of shape 2 in the frame of shape 1.
    pub(crate) fn new(
        mesh: MeshView<'a>,
        shape: &'a dyn Shape,
        convex: ConvexShape<'a>,
        mesh_place: MeshPlace,
        pos12: &Pose,
    ) -> Self {
        let part = Part { pose: None, shape: convex, cone: None };
        let pose = PairPose::new(pos12, 0.0);
        let placed = PlacedPart::new(0, &part, mesh_place.placements(&pose), Extent::of(convex));
        let pose_in_mesh = mesh_place.shape_in_mesh(pos12);
        Self { mesh, mesh_place, shape, convex, placed, pose_in_mesh, hull: KeptHull::default() }
    }

    /// Moves shape 2 to a placement in the frame of shape 1.
    pub(crate) fn place(&mut self, placement: &Placement) {
        self.placed = self.placed_at(placement);
        self.pose_in_mesh = self.placed.pose_in_mesh();
    }

    /// Returns the shape where shape 2 is at a placement in the frame of shape 1.
    pub(crate) fn placed_at(&self, placement: &Placement) -> PlacedPart {
        self.placed.moved(self.mesh_place, placement)
    }

    /// Returns balls around the mesh and the shape.
    pub(crate) fn balls(&self) -> [Sphere; 2] {
        [self.mesh.ball(), self.placed.extent.ball()]
    }

    /// Returns an upper bound of how far the shape reaches along a direction of any length.
    pub(crate) fn height_along(&self, direction: DVec3) -> f64 {
        self.placed.extent.height_along(self.convex, direction)
    }

    /// Returns the box around the shape in the frame of the mesh.
    pub(crate) fn aabb_in_mesh(&self) -> Aabb {
        self.shape.compute_aabb(&self.pose_in_mesh)
    }

    /// Returns the first triangle found that is within a distance of the shape, or crosses it.
    pub(crate) fn first_within(&self, distance: f64) -> Option<u32> {
        let radius = f64::from(self.convex.radius());
        let (mut found, margin) = (None, (distance as Real).next_up());
        let counts = &mut DescentCounts::default();
        triangles_near(&self.placed, self.convex, &self.mesh, margin, counts, |triangle| {
            let corners = self.placed.in_part(self.mesh.corners(triangle));
            let reach = distance + TOUCHING * self.size(&corners) + radius;
            if core_touches(&self.placed, &corners, self.convex, &self.hull, reach) {
                found = Some(triangle);
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(())
        });
        found
    }

    /// Returns the deepest triangle or, if none crosses, the nearest within `limit`.
    pub(crate) fn deepest(&self, limit: f64) -> Option<FoundTriangle> {
        if limit.is_nan() {
            return None;
        }
        // Far from the surface too many triangles are within the limit.
        if limit > WIDE * f64::from(self.placed.extent.size()) {
            let nearest = self.nearest(limit)?;
            return if nearest.is_touching { self.deepest(0.0) } else { Some(nearest) };
        }
        let mut deepest = None::<(FoundTriangle, SupportPlane)>;
        self.visit_near(limit, |triangle| {
            let least = deepest.map_or(f64::INFINITY, |(found, _)| found.contact.distance);
            if deepest.is_some_and(|(_, plane)| plane.gap(self.mesh.corners(triangle)) >= least) {
                return;
            }
            let found = self.triangle(&self.placed, triangle, limit);
            if let Some(found) = found.filter(|found| found.contact.distance < least) {
                deepest = Some((found, self.support_plane(found.contact.normal)));
            }
        });
        deepest.map(|(found, _)| found)
    }

    /// Returns the plane across a normal in the frame of the shape on which the shape stands. It is
    /// lower by the rounding of heights.
    pub(super) fn support_plane(&self, normal: DVec3) -> SupportPlane {
        let Placement { rotation, translation, .. } = self.placed.placement;
        let support = core_support(self.convex, &self.hull, -normal);
        let radius = f64::from(self.convex.radius());
        let lowest = support.map_or(f64::NEG_INFINITY, |point| normal.dot(point) - radius);
        let size = f64::from(self.placed.extent.size() + self.mesh.magnitude());
        let height = lowest - normal.dot(translation) - ROUNDING * (size + translation.length());
        SupportPlane { normal, normal_in_mesh: rotation.transpose() * normal, height }
    }

    /// Calls `found` with the triangles that touch or are within `limit`.
    pub(crate) fn within(&self, limit: f64, mut found: impl FnMut(FoundTriangle)) {
        self.visit_near(limit, |triangle| {
            self.triangle(&self.placed, triangle, limit).into_iter().for_each(&mut found);
        });
    }

    fn visit_near(&self, limit: f64, mut visit: impl FnMut(u32)) {
        let margin = (limit.max(0.0) as Real).next_up();
        let counts = &mut DescentCounts::default();
        triangles_near(&self.placed, self.convex, &self.mesh, margin, counts, |triangle| {
            visit(triangle);
            ControlFlow::Continue(())
        });
    }

    /// Returns the nearest triangle within `limit`: one that touches, if any does.
    pub(crate) fn nearest(&self, limit: f64) -> Option<FoundTriangle> {
        let (gap, plane) = (self.gap(self.aabb_in_mesh()), Cell::new(None::<SupportPlane>));
        let gap = |node| gap(node).max(plane.get().map_or(0.0, |of| of.gap_of_box(node) as Real));
        self.least(limit, gap, |triangle, limit| {
            let found = self.triangle(&self.placed, triangle, limit)?;
            plane.set(Some(self.support_plane(found.contact.normal)));
            Some(((found.contact.distance as Real).max(0.0), found))
        })
    }

    /// Calls `time` with triangles that may have the least time up to a limit. No time is less than
    /// the distance divided by `speed`, or than the time in which a box is `clear`. A `sweep` is a
    /// box around the shape, and its velocity in the frame of the mesh.
    pub(crate) fn soonest(
        &self,
        limit: f64,
        speed: f64,
        sweep: Option<(Aabb, DVec3)>,
        clear: impl Fn(TestedBox) -> f64,
        time: impl Fn(u32, f64) -> Option<f64>,
    ) {
        let time = |triangle, limit| Some((time(triangle, limit)? as Real, ()));
        let _ = if let Some((around, velocity)) = sweep {
            self.least(limit, self.time(around, velocity, 0.0), time)
        } else {
            let (gap, unit) = (self.gap(self.aabb_in_mesh()), (1.0 / speed) as Real);
            let bound = |node| (gap(node) * unit).max((clear(node) as Real).next_down());
            self.least(limit, bound, time)
        };
    }

    /// Returns a lower bound of the distance between a box of the mesh and the shape. `around` is
    /// the box around the shape in the frame of the mesh.
    fn gap(&self, around: Aabb) -> impl Fn(TestedBox) -> Real {
        let plane = match self.convex {
            ConvexShape::HalfSpace(half_space) => {
                Some(plane(&self.placed.placement, half_space, self.mesh.magnitude(), 0.0))
            }
            _ => None,
        };
        let lost = self.rounding(&around);
        move |node| {
            if let Some((normal, height)) = plane {
                return ((lowest(node, normal) - height) as Real).next_down().max(0.0);
            }
            let (centre, extent) = node.centre_extent();
            let gap = (centre - around.center()).abs() - (extent + around.half_extents());
            (gap.max(Vec3::ZERO).length() * (1.0 - gamma(8)) - lost).max(0.0)
        }
    }

    /// Returns a bound of the rounding of boxes: some twenty operations.
    fn rounding(&self, around: &Aabb) -> Real {
        let size = around.mins.abs().max(around.maxs.abs()).max_element();
        gamma(32) * self.mesh.magnitude().max(size)
    }

    /// Returns a lower bound of the time until a box of the mesh is within `target` of the moving
    /// shape. The bound is `Real::MAX` if the two pass each other. `velocity` and `around`, the box
    /// around the shape, are in the frame of the mesh.
    pub(super) fn time(
        &self,
        around: Aabb,
        velocity: DVec3,
        target: Real,
    ) -> impl Fn(TestedBox) -> Real {
        let gap = self.gap(around);
        let slack = f64::from(target) + f64::from(self.rounding(&around));
        let is_infinite = matches!(self.convex, ConvexShape::HalfSpace(_));
        // Allows for the rounding of poses and boxes, and so of the velocity's direction.
        let speed = velocity.length() * f64::from(1.0 + gamma(8));
        let lost = f64::from(gamma(8)) * speed;
        let (speeds, signs) = (velocity.abs(), velocity.signum());
        let (per_fast, per_slow) = ((speeds + lost).recip(), (speeds - lost).recip());
        let is_slow = speeds.cmple(DVec3::splat(lost));
        let per_speed = speed.recip();
        // Earliest and latest time at which the boxes overlap, grown by the target.
        let overlap = move |node: TestedBox| {
            let (centre, extent) = node.centre_extent();
            let offset = (centre - around.center()).as_dvec3();
            let reach = (extent + around.half_extents()).as_dvec3() + slack;
            let ahead = DVec3::select(is_slow, offset.abs(), offset * signs);
            let last = DVec3::select(is_slow, DVec3::INFINITY, (ahead + reach) * per_slow);
            (((ahead - reach) * per_fast).max_element().max(0.0), last.min_element())
        };
        move |node| {
            let (start, end) = if is_infinite { (0.0, f64::INFINITY) } else { overlap(node) };
            let time = || start.max((f64::from(gap(node)) - f64::from(target)) * per_speed);
            // False for NaN, as of a velocity of zero.
            let is_time = |time: f64| time <= end && time < f64::from(Real::MAX);
            let time = if is_time(start) { time() } else { f64::INFINITY };
            if is_time(time) { (time as Real).next_down().max(0.0) } else { Real::MAX }
        }
    }

    /// Returns the triangle with the least cost up to a limit. `bound` is a lower bound of the
    /// costs in a box.
    pub(super) fn least<T>(
        &self,
        limit: f64,
        bound: impl Fn(TestedBox) -> Real,
        cost: impl Fn(u32, f64) -> Option<(Real, T)>,
    ) -> Option<T> {
        if !self.placed.placement.is_finite() || limit.is_nan() {
            return None;
        }
        // Parry returns costs below the limit only.
        let limit = (limit.min(f64::from(Real::MAX)) as Real).next_up();
        let found = self.mesh.mesh.bvh().find_best(
            limit,
            |node: &BvhNode, _| bound(box_of(node)),
            |triangle, best| {
                // A flat shape may meet many triangles of a floor at once. Costs that round to the
                // best one are of no use.
                let less = f64::from(best).midpoint(best.next_down().into());
                cost(triangle, if best < limit { less } else { best.into() })
            },
        );
        found.map(|(_, (_, found))| found)
    }

    /// Returns a triangle with its contact, if it touches or is within `margin`.
    pub(crate) fn triangle(
        &self,
        placed: &PlacedPart,
        triangle: u32,
        margin: f64,
    ) -> Option<FoundTriangle> {
        let corners = placed.in_part(self.mesh.corners(triangle));
        let touching = TOUCHING * self.size(&corners);
        let radius = f64::from(self.convex.radius());
        let reach = margin.max(touching) + radius;
        let mut contact = core_contact(placed, &corners, self.convex, &self.hull, reach)?;
        contact.distance -= radius;
        contact.on_shape -= contact.normal * radius;
        Some(FoundTriangle { triangle, contact, is_touching: contact.distance <= touching })
    }

    /// Returns the sum of coordinates in the frame of the shape.
    pub(super) fn size(&self, [a, b, c]: &[DVec3; 3]) -> f64 {
        f64::from(self.placed.extent.size()) + (a.abs() + b.abs() + c.abs()).element_sum()
    }
}
