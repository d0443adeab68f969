//! A mesh and a convex shape in motion: the soonest impact of a triangle.
//!
//! A plane that no point of the triangle or of the shape crosses separates them. So a triangle is
//! first advanced along one plane after another, and only near an impact by its distance.

use std::cell::Cell;

use glamx::{DVec3, Vec3};
use parry3d::bounding_volume::Aabb;
use parry3d::math::Real;
use parry3d::query::NonlinearRigidMotion;
use sbbk_core::query::{Advance, AdvanceOptions, Bodies, advance};
use sbbk_core::surface::area_vector;
use sbbk_core::traverse::{Placement, TestedBox};
use sbbk_core::volumes::rounding::gamma;

use super::Found;
use super::nonlinear::{NonlinearCast, lever, place, turned};
use crate::pair::{ConvexSearch, STRETCH, lowest};

/// Duration of the first window, as a multiple of the time in which the nearest triangle may be
/// met. Higher: more triangles that are not met are advanced; lower: more windows.
const WINDOW: f64 = 4.0;

/// Steps along one plane. Higher: fewer contacts are computed; lower: planes that have turned away
/// are left sooner.
const PLANE_STEPS: usize = 64;

/// Distance at the start up to which a shape is in contact, as a share of its thickness. In contact
/// it may sink deeper by the same length. Higher: shapes that slide into a wall sink deeper; lower:
/// rolling shapes stop at internal edges.
const SINK: f64 = 0.1;

/// A mesh and a convex shape in motion.
pub(super) struct MovingConvex<'a, 'q> {
    search: ConvexSearch<'a>,
    cast: &'q NonlinearCast<'q>,
    options: AdvanceOptions,
    /// Depth that the shape must gain to come out behind a triangle, as in Parry. For a half-space,
    /// the depth that the mesh must gain.
    thickness: f64,
    /// Depth of the contact at the start, if there is one and the cast does not stop there.
    sunk: Option<f64>,
}

impl<'a, 'q> MovingConvex<'a, 'q> {
    pub(super) fn new(search: ConvexSearch<'a>, cast: &'q NonlinearCast<'q>) -> Self {
        let options = cast.options(search.mesh_place.swap(search.balls()));
        let [_, ball] = search.balls();
        // A half-space is endless: the mesh is what may sink in.
        let thickness = match ball.radius.is_finite() {
            true => search.shape.ccd_thickness(),
            false => search.mesh.root().extents().min_element(),
        };
        let thickness = f64::from(thickness);
        Self { search, cast, options, thickness, sunk: None }
    }

    /// Returns the motions of the mesh and of the shape.
    fn motions(&self) -> [&'q NonlinearRigidMotion; 2] {
        self.search.mesh_place.swap(self.cast.motions)
    }

    /// Returns the first impact. A cast that does not stop at contacts of the start only counts
    /// triangles that the shape may come out behind.
    pub(super) fn first_impact(&mut self) -> Option<Advance<Found>> {
        let AdvanceOptions { start, end, tolerance, .. } = self.options;
        // False for NaN.
        let is_possible = start <= end;
        if !is_possible {
            return None;
        }
        let balls = self.search.mesh_place.swap(self.search.balls());
        let [first, end] = self.cast.meeting_of_balls(balls, &self.options)?;
        if !self.cast.stop_at_penetration {
            self.search.place(&self.cast.placement_at(start));
            let contact = self.search.deepest(tolerance.max(SINK * self.thickness));
            self.sunk = contact.map(|contact| -contact.contact.distance);
        }
        let (mut from, mut window) = (first, 0.0);
        loop {
            self.search.place(&self.cast.placement_at(from));
            let axis;
            (window, axis) = self.window(from, window)?;
            let until = (from + window).min(end);
            if let Some(found) = self.soonest(from, until, axis) {
                let is_at_start = found.time == start;
                return if is_at_start { self.deepest_at_start() } else { None }.or(Some(found));
            }
            if until >= end {
                return None;
            }
            from = until;
        }
    }

    /// Returns the duration of the next window, and the normal of the nearest triangle. It is a
    /// unit vector of space toward the mesh. A mesh that does not turn takes one window and has no
    /// normal.
    fn window(&self, from: f64, previous: f64) -> Option<(f64, Option<DVec3>)> {
        let AdvanceOptions { end, speed_bound, tolerance, .. } = self.options;
        if self.sweep().is_some() {
            return Some((f64::INFINITY, None));
        }
        let reach = (speed_bound * (end - from)).max(0.0) + tolerance;
        let nearest = self.search.nearest(reach)?.contact;
        let [_, shape] = self.motions();
        let axis = (place(shape, from).rotation * -nearest.normal).try_normalize();
        let distance = nearest.distance.max(1.0e3 * tolerance);
        let window = (WINDOW * distance / speed_bound).max(2.0 * previous);
        // An infinite or unknown speed bounds nothing.
        Some((if window > 0.0 { window } else { f64::INFINITY }, axis))
    }

    /// A box of the mesh's frame that holds the shape at the start, however it turns, and its
    /// velocity. `None` if the mesh turns, or a half-space.
    fn sweep(&self) -> Option<(Aabb, DVec3)> {
        let search = &self.search;
        let [mesh, shape] = self.motions();
        let [_, ball] = search.balls();
        let turns = shape.angvel != Vec3::ZERO;
        if mesh.angvel != Vec3::ZERO || turns && !ball.radius.is_finite() {
            return None;
        }
        let to_mesh = place(mesh, self.options.start).inverse;
        let velocity = to_mesh * (shape.linvel.as_dvec3() - mesh.linvel.as_dvec3());
        if !turns {
            return Some((search.aabb_in_mesh(), velocity));
        }
        let centre = search.placed.in_mesh(shape.local_center.as_dvec3());
        let reach = (lever(shape, &ball) * (1.0 + STRETCH)) as Real;
        Some((Aabb::from_half_extents(centre, Vec3::splat(reach)), velocity))
    }

    fn soonest(&self, from: f64, until: f64, axis: Option<DVec3>) -> Option<Advance<Found>> {
        let first = Cell::new(None::<Advance<Found>>);
        let time = |triangle, limit: f64| {
            let found = self.triangle_impact(triangle, from, (from + limit).min(until))?;
            if first.get().is_none_or(|first| found.time < first.time) {
                first.set(Some(found));
            }
            Some(found.time - from)
        };
        let front = axis.map(|axis| Front::new(self, axis, from));
        let clear = |node| front.as_ref().map_or(0.0, |front| front.clear_of_box(self, node));
        self.search.soonest(until - from, self.options.speed_bound, self.sweep(), clear, time);
        first.into_inner()
    }

    /// First impact of a triangle within a span of time.
    fn triangle_impact(&self, triangle: u32, from: f64, until: f64) -> Option<Advance<Found>> {
        let mut one = MovingTriangle::new(self, triangle);
        let end = self.options.end;
        let is_slid_over =
            self.deepest().is_some_and(|deepest| one.clear_of_own_plane(deepest, from, end) > end);
        if is_slid_over {
            return None;
        }
        let start = from + one.clear_of_own_plane(0.0, from, until);
        let options = AdvanceOptions { start, end: until, ..self.options };
        let found = advance(&mut one, &[], |time| self.cast.placement_at(time), options)?;
        if self.counts(&mut one, &found, from) {
            return Some(found);
        }
        self.meets_again(&mut one, found.time, until)
    }

    /// True if an impact counts. An impact at the start counts only if the shape then approaches by
    /// its thickness, or sinks deeper.
    fn counts(&self, one: &mut MovingTriangle<'_>, found: &Advance<Found>, from: f64) -> bool {
        let Self { cast, options, thickness, .. } = self;
        if cast.stop_at_penetration {
            return true;
        }
        if found.time <= from {
            return cast.approaches(&found.pair, from, thickness + options.tolerance);
        }
        let Some(deepest) = self.deepest() else { return true };
        cast.approaches(&found.pair, found.time, *thickness)
            || [1.0, 2.0, 3.0].into_iter().any(|third| {
                let time = found.time + (options.end - found.time) * third / 3.0;
                let pair = one.nearest(&cast.placement_at(time), 0.0, &[]);
                pair.is_some_and(|pair| -pair.distance > deepest)
            })
    }

    /// Depth up to which the shape may sink in, if it is in contact at the start.
    fn deepest(&self) -> Option<f64> {
        Some(self.sunk?.max(0.0) + SINK * self.thickness)
    }

    /// First impact after one that does not count. A shape that turns may come down with another
    /// end, so samples of its motion are tested, like in Parry.
    fn meets_again(
        &self,
        one: &mut MovingTriangle<'_>,
        from: f64,
        until: f64,
    ) -> Option<Advance<Found>> {
        let Self { cast, options, thickness, .. } = self;
        let mut looks = cast.looks(*thickness as Real);
        looks.by_ref().take_while(|&time| time <= until).filter(|&time| time > from).find_map(
            |time| {
                let placement_at = |time| cast.placement_at(time);
                let pair = one.nearest(&placement_at(time), f64::INFINITY, &[])?;
                if !cast.approaches(&pair, time, thickness + pair.distance.max(0.0)) {
                    return None;
                }
                let options = AdvanceOptions { start: time, end: until, ..*options };
                let found = advance(one, &[], placement_at, options)?;
                (found.time == time || self.counts(one, &found, time)).then_some(found)
            },
        )
    }

    /// The deepest of the triangles that are impacts at the start.
    fn deepest_at_start(&self) -> Option<Advance<Found>> {
        let AdvanceOptions { start, tolerance, .. } = self.options;
        let mut deepest = None::<Found>;
        self.search.within(tolerance, |found| {
            let pair = Found::of_triangle(&found, &self.search);
            let length = self.thickness + tolerance;
            let counts =
                self.cast.stop_at_penetration || self.cast.approaches(&pair, start, length);
            if counts && deepest.is_none_or(|deepest| pair.distance < deepest.distance) {
                deepest = Some(pair);
            }
        });
        let placement = self.cast.placement_at(start);
        deepest.map(|pair| Advance { time: start, pair, placement, has_converged: true })
    }
}

/// A plane that the shape touches at a time, and the speeds at which bodies approach across it.
///
/// A point at `r` from the centre of its motion has the velocity `w × r` against the centre. The
/// part along `a` is `a·(w × r) = r·(a × w)`, and `r` keeps its length.
struct Front {
    /// The axis across the plane, in the frame of the mesh. It points from the shape to the mesh.
    in_mesh: DVec3,
    /// Heights of the shape, and of a ball that holds it however it turns, above the origin of the
    /// mesh.
    heights: [f64; 2],
    /// Speeds of the shape, and of the ball, toward the centre of the mesh's motion.
    speeds: [f64; 2],
    /// Speed of the mesh's points per length of their lever.
    turn: f64,
    tolerance: f64,
}

impl Front {
    fn new(moving: &MovingConvex<'_, '_>, axis: DVec3, time: f64) -> Self {
        let search = &moving.search;
        let [mesh, shape] = moving.motions();
        let [mesh_place, shape_place] = [mesh, shape].map(|motion| place(motion, time));
        let lever = lever(shape, &search.balls()[1]);
        let height = search.height_along(shape_place.rotation.transpose() * axis);
        let centre = axis.dot(shape_place.to_frame1(shape.local_center, Vec3::ZERO));
        let heights = [axis.dot(shape_place.translation) + height, centre + lever];
        let linear = (shape.linvel.as_dvec3() - mesh.linvel.as_dvec3()).dot(axis);
        Self {
            in_mesh: mesh_place.rotation.transpose() * axis,
            heights: heights.map(|height| height - axis.dot(mesh_place.translation)),
            speeds: [linear + turned(axis.cross(shape.angvel.as_dvec3()), lever), linear],
            turn: axis.cross(mesh.angvel.as_dvec3()).length(),
            tolerance: moving.options.tolerance,
        }
    }

    /// Returns a time in which the shape does not reach a part of the mesh. The part has the least
    /// coordinate `lowest` along the axis, and is at most `lever` from the centre of the mesh's
    /// motion.
    fn clear(&self, lowest: f64, lever: f64) -> f64 {
        let clear = [0, 1].map(|i| {
            let gap = lowest - self.heights[i] - self.tolerance;
            let speed = (self.speeds[i] + self.turn * lever) * (1.0 + STRETCH);
            if gap > 0.0 && speed <= 0.0 {
                return f64::INFINITY;
            }
            // The maximum of a number and a NaN is the number.
            (gap.max(0.0) / speed).max(0.0)
        });
        clear[0].max(clear[1])
    }

    /// Returns [`clear`](Self::clear) of a box of the mesh.
    fn clear_of_box(&self, moving: &MovingConvex<'_, '_>, node: TestedBox) -> f64 {
        let [mesh, _] = moving.motions();
        let (centre, extent) = node.centre_extent();
        let lost = f64::from(gamma(8) * moving.search.mesh.magnitude());
        let arm = centre.as_dvec3() - mesh.local_center.as_dvec3();
        let lever = arm.length() + extent.as_dvec3().length() + 2.0 * lost;
        self.clear(lowest(node, self.in_mesh) - 2.0 * lost, lever)
    }
}

/// One triangle of the mesh and the shape.
struct MovingTriangle<'a> {
    moving: &'a MovingConvex<'a, 'a>,
    triangle: u32,
    corners: [DVec3; 3],
    /// Greatest distance of a corner from the centre of the mesh's motion.
    lever: f64,
    /// Bound on the acceleration of points against the other body, as they turn.
    acceleration: f64,
}

impl<'a> MovingTriangle<'a> {
    fn new(moving: &'a MovingConvex<'a, 'a>, triangle: u32) -> Self {
        let MovingConvex { search, .. } = moving;
        let motions = moving.motions();
        let corners = search.mesh.corners(triangle).map(Vec3::as_dvec3);
        let centre = motions[0].local_center.as_dvec3();
        let farthest = corners.iter().map(|corner| corner.distance(centre)).fold(0.0, f64::max);
        let levers = [farthest, lever(motions[1], &search.balls()[1])];
        let turns = motions.map(|motion| motion.angvel.as_dvec3());
        let acceleration = (0..2).map(|i| turns[i].length() * turned(turns[i], levers[i])).sum();
        Self { moving, triangle, corners, lever: farthest, acceleration }
    }

    /// Returns the time for which a plane `depth` below the triangle separates it from the shape.
    /// It is infinite if that holds until `end`.
    fn clear_of_own_plane(&self, depth: f64, from: f64, end: f64) -> f64 {
        let MovingConvex { search, .. } = self.moving;
        let mesh = place(self.moving.motions()[0], from);
        let Some(normal) = (mesh.rotation * area_vector(&self.corners)).try_normalize() else {
            return 0.0;
        };
        let inside = search.placed.in_mesh(search.balls()[1].centre.as_dvec3()).as_dvec3();
        let is_toward = (mesh.rotation * (self.corners[0] - inside)).dot(normal) >= 0.0;
        self.clear_along(if is_toward { normal } else { -normal }, depth, from, end)
    }

    /// Returns the time for which a plane across `axis` separates the shape from the triangle. It
    /// is infinite if that holds until `end`. `axis` is a unit vector of space from the shape to
    /// the triangle, which is moved by `depth` along it.
    ///
    /// A point leaves the chord between its places at two times by at most `a t² / 8`. Here `a`
    /// bounds its acceleration, and `t` is the time between. The gap obeys the same bound.
    fn clear_along(&self, axis: DVec3, depth: f64, from: f64, end: f64) -> f64 {
        let tolerance = self.moving.options.tolerance;
        let front = Front::new(self.moving, axis, from);
        let [a, b, c] = self.corners.map(|corner| front.in_mesh.dot(corner));
        let by_speed = front.clear(a.min(b).min(c) + depth, self.lever);
        if from + by_speed > end {
            return f64::INFINITY;
        }
        let gap_at = |time| depth + self.gap(axis, time);
        let (mut time, mut gap, mut slope) = (from + by_speed, gap_at(from + by_speed), 0.0);
        for _ in 0..PLANE_STEPS {
            let is_apart = gap > tolerance;
            if !is_apart {
                break;
            }
            let by_bend = (4.0 * gap / self.acceleration).sqrt();
            let by_slope = if slope > 0.0 { 1.2 * gap / slope } else { f64::INFINITY };
            let step = by_bend.min(by_slope).min(end - time);
            let bend = 0.125 * self.acceleration * step * step;
            let next = gap_at(time + step);
            if next >= bend {
                (time, gap) = (time + step, next);
                if time >= end {
                    return f64::INFINITY;
                }
                continue;
            }
            // After an infinite time `next` is NaN.
            let is_known = next.is_finite() && gap > bend;
            if !is_known {
                break;
            }
            slope = (gap - next) / step;
            time += step * (gap - bend) / (gap - next);
            gap = gap_at(time);
        }
        time - from
    }

    /// Returns the distance from the greatest coordinate of the shape to the least one of the
    /// triangle, along an axis of space.
    fn gap(&self, axis: DVec3, time: f64) -> f64 {
        let MovingConvex { search, .. } = self.moving;
        let [mesh, shape] = self.moving.motions().map(|motion| place(motion, time));
        let in_mesh: DVec3 = mesh.rotation.transpose() * axis;
        let [a, b, c] = self.corners.map(|corner| in_mesh.dot(corner));
        let lowest = a.min(b).min(c) + axis.dot(mesh.translation);
        let in_shape: DVec3 = shape.rotation.transpose() * axis;
        lowest - (search.height_along(in_shape) + axis.dot(shape.translation))
    }
}

impl Bodies for MovingTriangle<'_> {
    type Pair = Found;

    fn nearest(&mut self, placement: &Placement, reach: f64, _: &[[u32; 2]]) -> Option<Found> {
        let MovingConvex { search, .. } = self.moving;
        let placed = search.placed_at(placement);
        let found = search.triangle(&placed, self.triangle, reach)?;
        Some(Found::of_placed(&found, search.mesh_place, &placed))
    }

    fn within(&mut self, placement: &Placement, reach: f64, found: impl FnMut(Found)) {
        self.nearest(placement, reach, &[]).into_iter().for_each(found);
    }

    fn clear_time(&mut self, nearest: &Found, time: f64) -> f64 {
        let MovingConvex { search, options, .. } = self.moving;
        let [_, shape] = self.moving.motions();
        let [_, normal] = search.mesh_place.swap(nearest.normals);
        let axis: DVec3 = place(shape, time).rotation * normal.as_dvec3();
        self.clear_along(axis.normalize(), 0.0, time, options.end)
    }
}
