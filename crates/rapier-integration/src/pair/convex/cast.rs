//! Linear casts of a convex shape against a mesh.
//!
//! The distance of two convex bodies is a convex function of time. Newton's method from the start
//! therefore approaches the first impact from before. It also shows that there is no impact.
//! Normals of curved shapes are not exact: after a step that goes too far, the next one uses the
//! rule of false position.

use std::cell::Cell;

use glamx::DVec3;
use parry3d::math::Real;
use sbbk_core::contact::convex::ConvexContact;
use sbbk_core::query::{Cast, CastOptions, first_minimum, first_that_counts};
use sbbk_core::surface::area_vector;

use super::contact::{core_contact, core_support};
use super::search::{ConvexSearch, FoundTriangle, SupportPlane};
use crate::mesh::is_minimum;
use crate::pair::pose::MeshPlace;

/// Bodies that are this much farther than the target at the start are within it, as a share of
/// size. At this share of their speed they do not approach. Contacts within this may count as
/// touching.
const WITHIN_TARGET: f64 = 1.0e-10;

/// Bodies that are this much farther than the target have arrived, as a share of size and travel.
/// Higher: less exact times; lower: contacts of bodies that touch, which take longer.
const ARRIVED: f64 = 1.0e-8;

/// Steps at most. Grazing impacts gain a binary digit a step; others take two or three steps.
const STEP_LIMIT: usize = 100;

impl ConvexSearch<'_> {
    /// The first impact of shape 2 of the pair, which moves by `velocity12` in the frame of shape 1. The points of each
    /// body are where they were at the start.
    pub(crate) fn cast(
        &self,
        velocity12: DVec3,
        options: CastOptions,
    ) -> Option<Cast<FoundTriangle>> {
        let is_finite = velocity12.is_finite() && self.placed.placement.is_finite();
        if !options.is_possible() || !is_finite {
            return None;
        }
        let placement = &self.placed.placement;
        let (of_triangle, of_shape) = match self.mesh_place {
            MeshPlace::First => (-(placement.rotation * velocity12), velocity12),
            MeshPlace::Second => (velocity12, -(placement.inverse * velocity12)),
        };
        let velocities = [of_triangle, of_shape];
        first_minimum(
            &options,
            |counts| self.first_impact(velocities, options, counts),
            |cast| self.is_minimum(cast),
            |distance| self.first_within(distance).is_some(),
        )
    }

    /// Returns the first impact that `counts`. Each velocity is in the frame of the other body.
    fn first_impact(
        &self,
        [of_triangle, of_shape]: [DVec3; 2],
        options: CastOptions,
        counts: impl Fn(&Cast<FoundTriangle>) -> bool,
    ) -> Option<Cast<FoundTriangle>> {
        let CastOptions { max_time, target_distance: target, .. } = options;
        let time = self.time(self.aabb_in_mesh(), of_shape, target);
        let latest = f64::from(max_time);
        let plane = Cell::new(None::<SupportPlane>);
        let time_along = |of: SupportPlane, node| {
            let approach = of.normal.dot(of_triangle);
            let time = (of.gap_of_box(node) - f64::from(target)) / approach;
            if approach > 0.0 && time.is_finite() { time as Real } else { 0.0 }
        };
        let time = |node| time(node).max(plane.get().map_or(0.0, |of| time_along(of, node)));
        self.least(latest, time, |triangle, best| {
            let latest = latest.min(best);
            let cast = |target_distance: Real, last: Option<&Cast<_>>| {
                let options = CastOptions { target_distance, ..options };
                self.cast_triangle(triangle, of_triangle, options, latest, last)
            };
            let distance = |cast: &Cast<FoundTriangle>| cast.pair.contact.distance;
            let cast = first_that_counts(target, cast, distance, &counts)?;
            let time = cast.time as Real;
            let is_less = f64::from(time) < best;
            if is_less {
                plane.set(Some(self.support_plane(cast.pair.contact.normal)));
            }
            is_less.then_some((time, cast))
        })
    }

    /// Returns false if the mesh is nearer to the shape beside the point of an impact.
    fn is_minimum(&self, Cast { pair: found, .. }: &Cast<FoundTriangle>) -> bool {
        let place = self.placed.in_mesh(found.contact.on_triangle).as_dvec3();
        let [direction, _] = self.placed.directions(found.contact.normal);
        let distance = found.contact.distance;
        distance <= 0.0 || is_minimum(self.mesh.mesh, found.triangle, place, (direction, distance))
    }

    /// The first impact of a triangle that moves in the frame of the shape. `last` is the impact at
    /// a greater target distance.
    fn cast_triangle(
        &self,
        triangle: u32,
        velocity: DVec3,
        options: CastOptions,
        latest: f64,
        last: Option<&Cast<FoundTriangle>>,
    ) -> Option<Cast<FoundTriangle>> {
        let start = self.placed.in_part(self.mesh.corners(triangle));
        let (size, target) = (self.size(&start), f64::from(options.target_distance));
        let cast = TriangleCast { search: self, triangle, start, size, velocity, target, latest };
        if let Some(Cast { time, pair: FoundTriangle { contact, .. }, .. }) = last {
            let (time, left, normal) = (*time, contact.distance - target, contact.normal);
            if left > WITHIN_TARGET * size {
                return cast.advance(Apart { time, left, normal });
            }
        }
        match cast.plane_at_start().filter(|apart| apart.left > WITHIN_TARGET * size) {
            Some(apart) => cast.advance(apart),
            None => cast.at_start(options.stop_at_penetration),
        }
    }
}

/// A time at which a triangle and a shape are farther apart than the target, by `left`.
#[derive(Copy, Clone)]
struct Apart {
    time: f64,
    left: f64,
    /// Unit vector from the triangle to the shape.
    normal: DVec3,
}

/// A triangle that moves in the frame of a shape.
struct TriangleCast<'a> {
    search: &'a ConvexSearch<'a>,
    triangle: u32,
    /// Corners at the start.
    start: [DVec3; 3],
    /// Sum of coordinates.
    size: f64,
    velocity: DVec3,
    target: f64,
    latest: f64,
}

impl TriangleCast<'_> {
    /// Returns by how much the plane of the triangle is farther from the shape than the target at
    /// the start.
    fn plane_at_start(&self) -> Option<Apart> {
        let (a, ConvexSearch { placed, convex, hull, .. }) = (self.start[0], self.search);
        let normal = area_vector(&self.start).try_normalize()?;
        let centre = placed.extent.ball().centre.as_dvec3();
        let normal = if normal.dot(centre - a) < 0.0 { -normal } else { normal };
        let lowest = core_support(*convex, hull, -normal)?;
        let width = normal.dot(lowest - a) - f64::from(convex.radius());
        Some(Apart { time: 0.0, left: width - self.target, normal })
    }

    fn at_start(&self, stop_at_penetration: bool) -> Option<Cast<FoundTriangle>> {
        let contact = self.contact(0.0)?;
        let left = contact.distance - self.target;
        if left > WITHIN_TARGET * self.size {
            return self.advance(Apart { time: 0.0, left, normal: contact.normal });
        }
        let approach = self.approach(contact.normal);
        let counts = stop_at_penetration || approach > WITHIN_TARGET * self.velocity.length();
        let is_penetrating = contact.distance < self.target;
        counts.then(|| Cast { time: 0.0, pair: self.found(contact), is_penetrating })
    }

    /// Newton's method, from a time at which a plane separates the bodies.
    fn advance(&self, mut apart: Apart) -> Option<Cast<FoundTriangle>> {
        let mut time = self.next_time(&apart)?;
        for _ in 0..STEP_LIMIT {
            let mut contact = self.contact(time)?;
            let (left, slack) = (contact.distance - self.target, self.slack(time));
            if left > slack {
                apart = Apart { time, left, normal: contact.normal };
                time = self.next_time(&apart)?;
            } else if left < -slack && (time - apart.time) * self.velocity.length() > slack {
                time = apart.time + (time - apart.time) * apart.left / (apart.left - left);
            } else {
                let radius = f64::from(self.search.convex.radius());
                if contact.distance + radius <= WITHIN_TARGET * self.size {
                    // Bodies that touch have no better normal than those just apart.
                    contact.normal = apart.normal;
                }
                let approach = self.approach(contact.normal);
                let rest = if approach > 0.0 { left.max(0.0) / approach } else { 0.0 };
                let time = (time + rest).min(self.latest);
                return Some(Cast { time, pair: self.found(contact), is_penetrating: false });
            }
        }
        None
    }

    /// The time at which the separating plane is half of [`ARRIVED`] from the target; `None` if
    /// that is too late.
    fn next_time(&self, apart: &Apart) -> Option<f64> {
        let clear = apart.left / self.approach(apart.normal);
        // Negative, infinite or NaN if the bodies do not approach.
        let is_in_time = clear >= 0.0 && apart.time + clear <= self.latest;
        let short = 0.5 * self.slack(apart.time + clear);
        let share = ((apart.left - short) / apart.left).max(0.0);
        is_in_time.then_some(apart.time + clear * share)
    }

    fn slack(&self, time: f64) -> f64 {
        ARRIVED * (self.size + (self.velocity * time).abs().element_sum())
    }

    /// Speed at which the bodies approach along a normal.
    fn approach(&self, normal: DVec3) -> f64 {
        normal.dot(self.velocity)
    }

    /// Contact at a time, with the point on the triangle where it was at the start; `None` if the
    /// bodies are too far apart to meet in time.
    fn contact(&self, time: f64) -> Option<ConvexContact> {
        let Self { search, velocity, target, latest, .. } = *self;
        let travel = velocity * time;
        let corners = self.start.map(|corner| corner + travel);
        let radius = f64::from(search.convex.radius());
        let margin = (radius + target + velocity.length() * (latest - time)) * (1.0 + 1.0e-9);
        let margin = margin + self.slack(time);
        let ConvexSearch { placed, convex, hull, .. } = search;
        let mut contact = core_contact(placed, &corners, *convex, hull, margin)?;
        contact.distance -= radius;
        contact.on_shape -= contact.normal * radius;
        contact.on_triangle -= travel;
        Some(contact)
    }

    fn found(&self, contact: ConvexContact) -> FoundTriangle {
        let is_touching = contact.distance <= ARRIVED * self.size;
        FoundTriangle { triangle: self.triangle, contact, is_touching }
    }
}
