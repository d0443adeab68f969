//! Tests of directions at a point of a surface against the triangles around that point.

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::Arc;

use arrayvec::ArrayVec;
use glamx::DVec3;

use super::crowd::{Crowd, Found};
use super::facets::{Facets, Wedge, half_edge, visit_ring};
use super::memo::{PlaceMemo, key};
use super::sides::Side;
use super::slopes::{Bend, FLAT, Heights, LONG, RISE, RISE_TO_FACE, Signs, Slopes, angle};
use super::triangle::{area_vector, clip, longest_side, seam, touches};
use crate::contact::Feature;
use crate::contact::convex::{PointSupport, convex_contact};
use crate::simd::each;

/// The surface around a triangle, which tests directions against the one-ring of a vertex or an
/// edge, or against a face.
#[derive(Clone, Copy)]
pub struct Around<F> {
    /// The triangles of the surface.
    pub facets: F,
    /// The side that the triangle in question has.
    pub side: Side,
}

/// Triangles near the point of an impact that are looked at. Higher: slow casts at the hub of a
/// fan. Lower: casts along walls stop where many triangles meet.
const MOST_NEAR: usize = 64;

/// Share of the coordinates that rounding to f32 may open between triangles that touch. Higher:
/// triangles across a gap count as touching. Lower: casts stop at T-junctions of a wall that they
/// slide along.
const ROUNDING: f64 = 1.0e-6;

impl<F: Facets> Around<F> {
    /// True if no triangle of a feature's one-ring comes nearer to the other body in a unit
    /// direction. The direction must not lead into the solid.
    ///
    /// The direction leads from a point of the feature to the nearest point of the other body. From
    /// a face it is the normal; from an edge or a vertex it is within the Voronoi region. `contact`
    /// has that point and the feature of the other body, if known. A neighbour may come slightly
    /// nearer where the surface bends; within a flat side, edges and vertices are no local minima.
    pub fn is_local_minimum(
        &self,
        triangle: u32,
        feature: Feature,
        direction: DVec3,
        contact: Option<(DVec3, Feature)>,
    ) -> bool {
        if feature == Feature::Face {
            let (height, is_upright) = self.over_face(triangle, direction);
            let leads_in = self.outward() * height < 0.0;
            return is_upright && !leads_in;
        }
        let to_face = matches!(contact, Some((_, Feature::Face)));
        let most = if to_face { RISE_TO_FACE } else { RISE };
        let normal = self.normal(triangle);
        let least = self.facets.cones(triangle).least_square(to_face);
        if normal.dot(direction).powi(2) < least * normal.length_squared() {
            return false;
        }
        let (rise, bend, signs) = self.first_slopes(triangle, feature, (direction, most), normal);
        if rise > most * most || bend.is_some_and(|bend| bend.is_exceeded(rise, most)) {
            return false;
        }
        if bend.is_some() && self.facets.is_whole(triangle, feature) {
            return !self.leads_in(triangle, feature, direction, &signs);
        }
        let place = contact.map(|(place, _)| place);
        let slopes = self.all_slopes(triangle, feature, direction, place);
        // The memory is for triangles of all sides.
        (!self.is_solid() || self.height_out(triangle, &slopes) >= 0.0)
            && (slopes.rise <= FLAT * FLAT
                || !self.is_exceeded(triangle, feature, slopes, most, place))
    }

    /// Returns the rise of a one-ring towards a direction, its bend from a plane, and the signs of
    /// its heights. The walk ends at a rise above `most`. After [`LONG`] triangles there is no
    /// bend.
    #[inline(always)]
    fn first_slopes(
        &self,
        triangle: u32,
        feature: Feature,
        (direction, most): (DVec3, f64),
        normal: DVec3,
    ) -> (f64, Option<Bend>, Signs) {
        let (mut slopes, mut bend) = (Slopes::default(), Bend::from(normal));
        let (mut count, mut signs) = (0, Signs::default());
        self.visit(triangle, feature, |Wedge { edges: [u, v], are_new, .. }| {
            for (edge, is_new) in [(u, are_new[0]), (v, are_new[1])] {
                if is_new {
                    slopes.add(edge, direction);
                    bend.add(edge);
                }
            }
            if self.is_solid() {
                signs.add(self.outward() * u.cross(v).dot(direction));
            }
            count += 1;
            let is_over = slopes.rise > most * most || count > LONG;
            if is_over { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        (slopes.rise, (count <= LONG).then_some(bend), signs)
    }

    /// Returns true if a triangle that touches a place on a triangle rises towards a point, by a
    /// slope whose sine is above `most`. A triangle across a gap rises if it is nearer to the point
    /// than the place is. The direction and the distance lead from the place to the point. Looks at
    /// few triangles where many meet.
    pub fn rises(
        &self,
        triangle: u32,
        place: DVec3,
        (direction, distance): (DVec3, f64),
        most: f64,
    ) -> bool {
        let mut slopes = Slopes::default();
        let rounding = ROUNDING * place.abs().max_element();
        self.visit_touching(triangle, place, MOST_NEAR, |_, corners, ends| {
            if !touches(corners, [DVec3::ZERO; 2], rounding) {
                let point = PointSupport(distance * direction);
                let nearest = convex_contact(corners, &point, f64::INFINITY);
                let point = nearest.map_or(DVec3::ZERO, |nearest| nearest.on_triangle);
                // By how much the square of the distance is less.
                let gain = 2.0 * distance * direction.dot(point) - point.length_squared();
                let least = most * distance * point.length();
                if gain > least {
                    slopes.rise = f64::INFINITY;
                }
            } else {
                ends.for_each(|end| slopes.add(end, direction));
                // The steepest way may lead between the corners.
                let uphill = direction.reject_from(area_vector(corners));
                let rise = uphill.length_squared();
                let way = longest_side(corners) * uphill.normalize_or_zero();
                let is_inside = |[from, to]: [DVec3; 2]| from.distance(to) > 4.0 * rounding;
                let leads_on = || clip(corners, [DVec3::ZERO, way], rounding);
                if rise > most * most && leads_on().is_some_and(is_inside) {
                    slopes.rise = slopes.rise.max(rise);
                }
            }
            if slopes.rise > most * most {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        slopes.rise > most * most
    }

    /// True if the body is on one side of the triangle, and nothing on the other.
    pub fn is_solid(&self) -> bool {
        self.side.outward().is_some()
    }

    /// Sign with which the normal of the triangle leads out of the solid; 0 for sheets.
    fn outward(&self) -> f64 {
        self.side.outward().unwrap_or(0.0)
    }

    /// True if a unit direction from a feature leads into the solid; false for sheets.
    pub fn points_inside(&self, triangle: u32, feature: Feature, direction: DVec3) -> bool {
        if !self.is_solid() {
            return false;
        }
        if feature == Feature::Face {
            let (height, is_upright) = self.over_face(triangle, direction);
            return is_upright && self.outward() * height < 0.0;
        }
        let (mut count, mut signs) = (0, Signs::default());
        let is_closed = self.visit(triangle, feature, |Wedge { edges: [u, v], .. }| {
            signs.add(self.outward() * u.cross(v).dot(direction));
            count += 1;
            if count > LONG { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        if count > LONG || !is_closed && !self.facets.is_whole(triangle, feature) {
            let slopes = self.all_slopes(triangle, feature, direction, None);
            return self.height_out(triangle, &slopes) < 0.0;
        }
        self.leads_in(triangle, feature, direction, &signs)
    }

    /// True if a unit direction that leads into the solid leads behind all triangles of a closed,
    /// short one-ring. The way then begins in the solid: directions outside of it lead in front of
    /// one.
    pub fn leads_behind_all(&self, triangle: u32, feature: Feature, direction: DVec3) -> bool {
        let mut count = 0;
        let is_behind = |wedge: Wedge| {
            count += 1;
            let is_behind = self.outward() * wedge.area().dot(direction) < 0.0;
            let goes_on = is_behind && count <= LONG;
            if goes_on { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        };
        feature == Feature::Face
            || self.facets.is_whole(triangle, feature) && self.visit(triangle, feature, is_behind)
    }

    /// Returns the sign with which the normal of a triangle leads out of the solid: 0 for walls
    /// within, 1 for sheets.
    fn outward_of(&self, triangle: u32) -> f64 {
        if self.is_solid() { self.facets.outward(triangle) } else { 1.0 }
    }

    /// Returns the height of slopes out of the solid. A body that is in a room has the solid on the
    /// other side.
    fn height_out(&self, triangle: u32, slopes: &Slopes) -> f64 {
        self.outward() * self.facets.outward(triangle) * slopes.height
    }

    /// Returns true if a direction leads into the solid, by its heights over the triangles of a
    /// one-ring.
    fn leads_in(&self, triangle: u32, feature: Feature, direction: DVec3, signs: &Signs) -> bool {
        signs.lead_in().unwrap_or_else(|| {
            let mut heights = Heights::default();
            self.visit(triangle, feature, |wedge| {
                heights.add(wedge.area(), wedge.angle(feature));
                ControlFlow::Continue(())
            });
            self.outward() * heights.along(direction) < 0.0
        })
    }

    /// Returns the first triangle of a vertex's one-ring, and a number of the ring. Sums in the
    /// order of a ring that starts there have the same bits for all triangles of the ring.
    pub(super) fn first_of_ring(&self, triangle: u32, feature: Feature) -> (u32, Feature, u32) {
        if !matches!(feature, Feature::Vertex(_)) {
            return (triangle, feature, PlaceMemo::SHORT);
        }
        let (mut first, mut ring) = (half_edge(triangle, feature), PlaceMemo::SHORT);
        let memo = self.facets.memo();
        if let Some(known) = memo.and_then(|memo| memo.rings.get(&first)) {
            (first, ring) = (known, known);
        } else {
            let mut count = 0;
            self.visit(triangle, feature, |wedge| {
                first = first.min(wedge.half_edge);
                count += 1;
                ControlFlow::Continue(())
            });
            if count > LONG {
                ring = first;
                if let Some(memo) = memo {
                    let (ring, _) = self.ring(triangle, feature);
                    ring.into_iter().for_each(|half_edge| memo.rings.insert(half_edge, first));
                }
            }
        }
        (first / 3, Feature::Vertex((first % 3) as u8), ring)
    }

    /// Returns the slopes of all triangles that touch a point of a feature, which many may share.
    /// Without a `place`, the point is the middle of an edge.
    fn all_slopes(
        &self,
        triangle: u32,
        feature: Feature,
        direction: DVec3,
        place: Option<DVec3>,
    ) -> Slopes {
        let place = self.place(triangle, feature, place);
        let (triangle, feature, ring) = self.first_of_ring(triangle, feature);
        let (memo, key) = (self.facets.memo(), (ring, self.is_solid(), key(place)));
        if let Some(crowd) = memo.and_then(|memo| memo.crowds.get(&key)) {
            return crowd.slopes(direction);
        }
        let mut slopes = Slopes::default();
        let add = |way| slopes.add(way, direction);
        let Found { heights, count, .. } = self.visit_ways(triangle, feature, place, add);
        if count <= LONG {
            return Slopes { height: heights.along(direction), ..slopes };
        }
        let crowd = self.crowd(triangle, feature, place);
        let slopes = crowd.slopes(direction);
        memo.inspect(|memo| memo.crowds.insert(key, Arc::new(crowd)));
        slopes
    }

    /// Returns the surface at a place where many triangles meet.
    fn crowd(&self, triangle: u32, feature: Feature, place: DVec3) -> Crowd {
        let mut ways = Vec::new();
        let found = self.visit_ways(triangle, feature, place, |way| ways.push(way));
        let mut bend = Bend::from(found.area);
        ways.iter().for_each(|way| bend.add(*way));
        Crowd::new(ways, found.heights, bend)
    }

    /// Calls `visit` with the ways from a place to the corners of all triangles there.
    fn visit_ways(
        &self,
        triangle: u32,
        feature: Feature,
        place: DVec3,
        mut visit: impl FnMut(DVec3),
    ) -> Found {
        let mut found = Found::default();
        // Triangles of a one-ring have one winding.
        let outward = self.outward_of(triangle);
        let is_closed = self.visit(triangle, feature, |wedge| {
            wedge.edges.into_iter().for_each(&mut visit);
            found.add(outward * wedge.area(), wedge.angle(feature));
            ControlFlow::Continue(())
        });
        if self.facets.is_whole(triangle, feature) {
            return found;
        }
        let mut all = Found::default();
        self.visit_touching(triangle, place, usize::MAX, |other, corners, ends| {
            let outward = self.outward_of(other);
            // Walls within are no surface.
            if outward != 0.0 {
                let ends: ArrayVec<DVec3, 3> = ends.collect();
                ends.iter().copied().for_each(&mut visit);
                let angle = if let [u, v] = ends[..] { angle(u, v) } else { PI };
                let area = outward * area_vector(corners);
                // Triangles of a sheet have either winding.
                let is_turned = !self.is_solid() && area.dot(all.area) < 0.0;
                all.add(if is_turned { -area } else { area }, angle);
            }
            ControlFlow::Continue(())
        });
        let count = found.count + all.count;
        Found { count, ..if is_closed { found } else { all } }
    }

    /// Returns true if the surface at a point rises more than it bends there.
    fn is_exceeded(
        &self,
        triangle: u32,
        feature: Feature,
        Slopes { rise, bend, .. }: Slopes,
        most: f64,
        place: Option<DVec3>,
    ) -> bool {
        if let Some(bend) = bend {
            return bend.is_exceeded(rise, most);
        }
        let mut bend = Bend::from(self.normal(triangle));
        self.visit(triangle, feature, |Wedge { edges, .. }| {
            edges.into_iter().for_each(|edge| bend.add(edge));
            let is_exceeded = bend.is_exceeded(rise, most);
            if is_exceeded { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        if bend.is_exceeded(rise, most) && !self.facets.is_whole(triangle, feature) {
            let place = self.place(triangle, feature, place);
            self.visit_touching(triangle, place, usize::MAX, |other, _, ends| {
                ends.filter(|_| self.outward_of(other) != 0.0).for_each(|end| bend.add(end));
                ControlFlow::Continue(())
            });
        }
        bend.is_exceeded(rise, most)
    }

    /// Returns a vertex, or a point of an edge.
    pub(super) fn place(&self, triangle: u32, feature: Feature, place: Option<DVec3>) -> DVec3 {
        let first = half_edge(triangle, feature);
        match (feature, place) {
            (Feature::Vertex(_), _) => self.corner(first, 0),
            (_, Some(place)) => place,
            _ => self.corner(first, 0).midpoint(self.corner(first, 1)),
        }
    }

    /// Calls `visit` for each triangle that touches a place. `visit` also gets the three corners,
    /// seen from the place, and the corners that are not at the place. Ends after `most` triangles
    /// near the place, or if `visit` breaks.
    pub(super) fn visit_touching(
        &self,
        triangle: u32,
        place: DVec3,
        mut most: usize,
        mut visit: impl FnMut(u32, &[DVec3; 3], &mut dyn Iterator<Item = DVec3>) -> ControlFlow<()>,
    ) {
        let seam = seam(&each(|i| self.corner(3 * triangle, i)));
        // Facets may go on after a break.
        let mut ended = ControlFlow::Continue(());
        self.facets.near([place - seam, place + seam], &mut |other| {
            let corners = each(|i| self.corner(3 * other, i) - place);
            if ended.is_continue() && touches(&corners, [DVec3::ZERO; 2], seam) {
                let is_far = |corner: &DVec3| corner.length_squared() > seam * seam;
                ended = visit(other, &corners, &mut corners.into_iter().filter(is_far));
            }
            most = most.saturating_sub(1);
            if most == 0 { ControlFlow::Break(()) } else { ended }
        });
    }

    /// Height of a direction along the area vector of a triangle; true if the direction is nearly
    /// upright.
    fn over_face(&self, triangle: u32, direction: DVec3) -> (f64, bool) {
        let normal = self.normal(triangle);
        let height = normal.dot(direction);
        (height, height.abs() > (1.0 - RISE) * normal.length())
    }

    /// Normal of a triangle; its length is twice the area.
    fn normal(&self, triangle: u32) -> DVec3 {
        area_vector(&each(|i| self.corner(3 * triangle, i)))
    }

    /// The triangles of the one-ring of a vertex or an edge, by the half-edges that start there,
    /// and true if the ring closes.
    pub fn ring(&self, triangle: u32, feature: Feature) -> (Vec<u32>, bool) {
        let mut ring = Vec::new();
        let is_closed = self.visit(triangle, feature, |Wedge { half_edge, .. }| {
            ring.push(half_edge);
            ControlFlow::Continue(())
        });
        (ring, is_closed)
    }

    /// Visits the one-ring of an edge or a vertex, as [`visit_ring`] does.
    #[inline(always)]
    pub(super) fn visit(
        &self,
        triangle: u32,
        feature: Feature,
        visit: impl FnMut(Wedge) -> ControlFlow<()>,
    ) -> bool {
        visit_ring(&self.facets, triangle, feature, visit)
    }

    #[inline(always)]
    pub(super) fn corner(&self, half_edge: u32, i: usize) -> DVec3 {
        self.facets.corner(half_edge, i)
    }
}

#[cfg(test)]
mod tests {
    use std::f32::consts::TAU;

    use glamx::Vec3;

    use super::*;
    use crate::support::Soup;

    /// Would catch sums in the order of the triangle that asks first, which threads change.
    #[test]
    fn all_triangles_of_a_tip_have_slopes_of_the_same_bits() {
        const COUNT: u32 = 2 * LONG as u32;
        let rim = (0..COUNT).map(|i| {
            let (sin, cos) = (TAU * i as f32 / COUNT as f32).sin_cos();
            (1.0 + 0.01 * (i * i % 7) as f32) * Vec3::new(cos, sin, -0.3)
        });
        let vertices: Vec<Vec3> = [Vec3::ZERO].into_iter().chain(rim).collect();
        for sides in [COUNT, COUNT - 1] {
            let triangles = (0..sides).map(|i| [0, 1 + i, 1 + (i + 1) % COUNT]).collect();
            let mesh = Soup { vertices: vertices.clone(), triangles };
            let surface = mesh.surface();
            let ring = Around { facets: mesh.facets(&surface), side: Side::Sheet };
            let slopes = |triangle| {
                let vertex = Feature::Vertex(0);
                let direction = DVec3::new(0.1, 0.2, 0.9);
                let (first, vertex, _) = ring.first_of_ring(triangle, vertex);
                let Slopes { rise, height, bend } =
                    ring.crowd(first, vertex, DVec3::ZERO).slopes(direction);
                (rise, height, bend)
            };
            assert!((0..sides).all(|triangle| slopes(triangle) == slopes(0)), "{sides} sides");
        }
    }
}
