//! A triangle and a cylinder or a cone around the y axis, in closed form.
//!
//! Bodies that cross are parted by the least translation along the normal of some part of the
//! surface of their difference. There are few kinds of parts, each with its least depth in closed
//! form, or by Newton's method on a convex function:
//!
//! * a flat end and a corner of the triangle, and the triangle and a point of the shape;
//! * a line of the slope and an edge: the normal is across both;
//! * the slope and a corner: the normal of the slope in the direction of the corner;
//! * a rim and an edge, see [`rim_and_edge`].
//!
//! The edge between two parts is never nearest to a point inside. Support points of both bodies
//! measure the depth of each candidate, so each is a move that separates them. The least one is the
//! contact.

use super::rim::{LevelEdge, rim_and_edge};
use super::search::BOUNDARY;
use super::simplex::squared_distance;
use super::solid::{Gap, OffsetPoint, Solid, TriangleAndSolid};
use super::support::SupportMap;
use super::{ConvexContact, by_search};
use crate::contact::closest::within_edge;
use glamx::DVec3;

/// A cylinder or a cone around the y axis, its middle at the origin. The base of a cone is below,
/// and its tip above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurnedSupport<const IS_CONE: bool> {
    /// Half the length of the axis.
    pub half_height: f64,
    /// Radius of each disc.
    pub radius: f64,
}

/// A cylinder around the y axis, its middle at the origin.
pub type CylinderSupport = TurnedSupport<false>;

/// A cone around the y axis: its tip at `half_height`, its base at `-half_height`.
pub type ConeSupport = TurnedSupport<true>;

impl<const IS_CONE: bool> SupportMap for TurnedSupport<IS_CONE> {
    const IS_CURVED: bool = true;

    /// The centre of a disc where all of it is farthest.
    #[inline(always)]
    fn support(&self, direction: DVec3) -> DVec3 {
        let Self { half_height, radius } = *self;
        let across = radial(direction);
        if IS_CONE && 2.0 * half_height * direction.y > radius * across {
            return DVec3::new(0.0, half_height, 0.0);
        }
        let y = if IS_CONE { -half_height } else { half_height.copysign(direction.y) };
        let scale = if across > 0.0 { radius / across } else { 0.0 };
        DVec3::new(direction.x * scale, y, direction.z * scale)
    }

    fn contact(&self, triangle: &[DVec3; 3], margin: f64) -> Option<ConvexContact> {
        let pair = TriangleAndSolid::new(triangle, self, self.half_height + 2.0 * self.radius);
        if !pair.size.is_finite() {
            return None;
        }
        let beyond = margin.max(0.0) + BOUNDARY * pair.size;
        let of_triangle = pair.triangle_gap();
        if of_triangle.is_some_and(|gap| gap.width > beyond) {
            return None;
        }
        let (low, high) = pair.heights();
        let end = self.half_height;
        if low - end > beyond || -end - high > beyond {
            return None;
        }
        let is_through = |gap: Gap| gap.width < 0.0 && pair.is_pierced(&gap);
        let contact = if of_triangle.is_some_and(is_through) {
            pair.penetration(of_triangle)
        } else {
            let near = pair.nearest(of_triangle.as_ref(), beyond)?;
            if near.squared <= pair.doubtful() * pair.doubtful() {
                pair.penetration(of_triangle)
            } else {
                pair.contact(&near)
            }
        };
        contact.or_else(|| by_search(triangle, self, f64::INFINITY))
    }
}

/// Length of a vector across the y axis.
#[inline(always)]
fn radial(DVec3 { x, z, .. }: DVec3) -> f64 {
    (x * x + z * z).sqrt()
}

/// Least sine between an edge and the axis at which the edge and a rim make a surface.
const PARALLEL: f64 = 1.0e-9;

/// The part of the difference to which a direction belongs.
#[derive(Clone, Copy)]
enum Part {
    Corner,
    Face,
    /// The slope and an edge.
    Slope(usize),
    /// A rim and an edge.
    Rim(usize),
}

/// The widest gap so far.
struct Best(Gap, Part);

impl Best {
    #[inline(always)]
    fn take(&mut self, gap: Gap, feature: Part) {
        if gap.width > self.0.width {
            *self = Self(gap, feature);
        }
    }
}

impl<const IS_CONE: bool> Solid for TurnedSupport<IS_CONE> {
    /// In a half plane a cone is a triangle between base, axis and slope.
    #[inline(always)]
    fn outside(&self, point: DVec3) -> DVec3 {
        let (Self { half_height, radius }, DVec3 { x, y, z }) = (*self, point);
        let across = radial(point);
        if !IS_CONE {
            let scale = if across > radius { 1.0 - radius / across } else { 0.0 };
            return DVec3::new(x * scale, y - y.clamp(-half_height, half_height), z * scale);
        }
        let (out, up) = if y < -half_height {
            ((across - radius).max(0.0), y + half_height)
        } else {
            let (below_tip, height) = (half_height - y, 2.0 * half_height);
            // The first is no more than `0 <= 0` beside a disc or a needle.
            let is_inside =
                across * height <= below_tip * radius && across <= radius && below_tip >= 0.0;
            if is_inside {
                return DVec3::ZERO;
            }
            let squared = radius * radius + height * height;
            let along = (across * radius + below_tip * height) / squared;
            // A cone without a slope is its tip.
            let along = if squared > 0.0 { along.clamp(0.0, 1.0) } else { 0.0 };
            (across - radius * along, height * along - below_tip)
        };
        let scale = if across > 0.0 { out / across } else { 0.0 };
        DVec3::new(x * scale, up, z * scale)
    }

    #[inline(always)]
    fn breaks(&self, start: DVec3, edge: DVec3) -> [f64; 5] {
        let Self { half_height, radius } = *self;
        let lean = if IS_CONE { radius / (2.0 * half_height) } else { 0.0 };
        let level = LevelEdge::new(start, edge);
        let half_chord = level.half_chord(radius);
        let [to_base, to_top] = [-half_height, half_height].map(|end| (end - start.y) / edge.y);
        let [over_rim, from_rim] = [-half_chord, half_chord].map(|half| level.to_axis + half);
        [level.near_slope(edge.y, lean), over_rim, from_rim, to_base, to_top]
    }
}

/// The normal of a slope, by its length across the axis and its height.
#[derive(Clone, Copy)]
struct Slope {
    run: f64,
    rise: f64,
    /// The solid reaches this far along the normal, on all sides.
    reach: f64,
}

/// An edge, seen in the plane across it. One axis is level, and the other one leads up.
struct AcrossEdge {
    axes: [DVec3; 2],
    /// Coordinates of the edge.
    at: [f64; 2],
    /// Coordinates of the vector to the third corner.
    to_third: [f64; 2],
    /// Greatest distance that rounding makes.
    rounding: f64,
}

impl AcrossEdge {
    /// Returns true if the third corner is not below the edge. It is not below an edge that
    /// touches.
    #[inline(always)]
    fn is_lowest(&self, x: f64, y: f64) -> bool {
        x * self.to_third[0] + y * self.to_third[1] >= -self.rounding
    }
}

impl<const IS_CONE: bool> TurnedSupport<IS_CONE> {
    /// Flat ends: the first ones of the rims.
    const ENDS: usize = if IS_CONE { 1 } else { 2 };

    #[inline(always)]
    fn slope(&self) -> Slope {
        let Self { half_height, radius } = *self;
        let length = (radius * radius + 4.0 * half_height * half_height).sqrt();
        let rise = if IS_CONE && length > 0.0 { radius / length } else { 0.0 };
        let run = (1.0 - rise * rise).sqrt();
        let steepest = DVec3::new(run, rise, 0.0);
        Slope { run, rise, reach: self.support(steepest).dot(steepest) }
    }

    /// The rims: the height of each, and the upright sign of the normals of its surfaces with
    /// edges. The sign also leads out of a flat end. Beside the base of a cone, normals can point
    /// up as far as the normal of the slope.
    fn rims(&self) -> [(f64, f64); 2] {
        let height = self.half_height;
        if IS_CONE { [(-height, -1.0), (-height, 1.0)] } else { [(height, 1.0), (-height, -1.0)] }
    }
}

impl<const IS_CONE: bool> TriangleAndSolid<'_, TurnedSupport<IS_CONE>> {
    fn heights(&self) -> (f64, f64) {
        let [a, b, c] = self.triangle.map(|corner| corner.y);
        (a.min(b).min(c), a.max(b).max(c))
    }

    /// True if a chord of the solid, across the plane of the triangle, runs through the triangle.
    /// If no edge touches the section of the solid, the section is inside the triangle or outside,
    /// as a whole.
    #[inline(always)]
    fn is_pierced(&self, gap: &Gap) -> bool {
        let normal = gap.outward;
        let [above, below] = [normal, -normal].map(|u| self.solid.support(u));
        let [over, under] = [above, below].map(|x| (x - self.triangle[0]).dot(normal));
        let is_across = over > 0.0 && under < 0.0;
        is_across && self.is_over(above.lerp(below, over / (over - under)), normal)
    }

    #[inline(always)]
    fn gap(&self, outward: DVec3) -> Gap {
        let [a, b, c] = self.triangle.map(|corner| corner.dot(outward));
        let reach = self.solid.support(outward).dot(outward);
        Gap { width: a.min(b).min(c) - reach, outward }
    }

    /// The contact of bodies that cross. `None` if they hardly cross.
    #[inline(always)]
    fn penetration(&self, of_triangle: Option<Gap>) -> Option<ConvexContact> {
        let nothing = Gap { width: f64::NEG_INFINITY, outward: DVec3::Y };
        let mut best = Best(nothing, Part::Corner);
        if let Some(gap) = of_triangle {
            best.take(gap, Part::Face);
            best.take(self.gap(-gap.outward), Part::Face);
        }
        let (low, high) = self.heights();
        for &(height, side) in &self.solid.rims()[..TurnedSupport::<IS_CONE>::ENDS] {
            let width = if side > 0.0 { low - height } else { height - high };
            best.take(Gap { width, outward: DVec3::Y * side }, Part::Corner);
        }
        let slope = self.solid.slope();
        self.slope_and_corners(&slope, &mut best);
        for j in 0..3 {
            self.sides_and_edge(j, &slope, &mut best);
        }
        let Best(gap, feature) = best;
        if gap.width >= -self.doubtful() {
            return None;
        }
        let on_triangle = self.touching(&gap, feature).or_else(|| self.touching_after(&gap))?;
        Some(ConvexContact::new(on_triangle, -gap.outward, gap.width))
    }

    /// The gaps of the slope and each corner.
    #[inline(always)]
    fn slope_and_corners(&self, &Slope { run, rise, reach }: &Slope, best: &mut Best) {
        for corner in *self.triangle {
            let across = radial(corner);
            if across * run + corner.y * rise - reach <= best.0.width {
                continue;
            }
            // From the axis any direction is as good.
            let [x, z] =
                if across > 0.0 { [corner.x / across, corner.z / across] } else { [1.0, 0.0] };
            best.take(self.gap(DVec3::new(x * run, rise, z * run)), Part::Corner);
        }
    }

    /// The gaps of the slope and an edge, and of the rims and that edge.
    #[inline(always)]
    fn sides_and_edge(&self, j: usize, slope: &Slope, best: &mut Best) {
        let TurnedSupport { radius, half_height } = *self.solid;
        let [start, end, third] = [0, 1, 2].map(|i| self.triangle[(j + i) % 3]);
        let edge = self.edges[j];
        // An edge that touches after the move is no farther than that now.
        let depth = -best.0.width;
        let [most, least] = [half_height + depth, -half_height - depth];
        if (start.y > most && end.y > most) || (start.y < least && end.y < least) {
            return;
        }
        // Across the edge: level, and as far up as can be.
        let level = DVec3::new(-edge.z, 0.0, edge.x);
        let (level_squared, squared) = (level.length_squared(), edge.length_squared());
        if level_squared <= PARALLEL * PARALLEL * squared {
            // Along the axis: level, from the axis to the edge.
            let outward = DVec3::new(start.x, 0.0, start.z).normalize_or(DVec3::X);
            best.take(self.gap(outward), Part::Slope(j));
            return;
        }
        let beside = start.dot(level);
        if beside * beside > (radius + depth).powi(2) * level_squared {
            return;
        }
        let level = level / level_squared.sqrt();
        let up = level.cross(edge) / squared.sqrt();
        let up = if up.y < 0.0 { -up } else { up };
        let axes = [level, up];
        let [at, to_third] = [start, third - start].map(|way| axes.map(|axis| way.dot(axis)));
        let across = AcrossEdge { axes, at, to_third, rounding: self.doubtful() };
        self.slope_and_edge(j, &across, slope, best);
        self.rims_and_edge(j, &across, best);
    }

    /// The gaps of the slope and an edge.
    #[inline(always)]
    fn slope_and_edge(
        &self,
        j: usize,
        across: &AcrossEdge,
        &Slope { rise, reach, .. }: &Slope,
        best: &mut Best,
    ) {
        let AcrossEdge { axes: [level, up], at: [at_level, at_up], .. } = *across;
        let sine = rise / up.y;
        if sine <= 1.0 {
            let cosine = (1.0 - sine * sine).sqrt();
            for x in [cosine, -cosine] {
                let bound = at_level * x + at_up * sine - reach;
                if bound > best.0.width && across.is_lowest(x, sine) {
                    best.take(self.gap(level * x + up * sine), Part::Slope(j));
                }
            }
        }
    }

    /// The gaps of the rims and an edge.
    #[inline(always)]
    fn rims_and_edge(&self, j: usize, across: &AcrossEdge, best: &mut Best) {
        let AcrossEdge { axes: [level, up], at: [at_level, at_up], .. } = *across;
        for (height, side) in self.solid.rims() {
            let coordinates = [-at_level, (height * up.y - at_up) * side];
            // The directions between these two.
            let x = if coordinates[0] < 0.0 { 1.0 } else { -1.0 };
            if !(across.is_lowest(x, 0.0) || across.is_lowest(0.0, side)) {
                continue;
            }
            if let Some([x, y]) = rim_and_edge(coordinates, up.y, self.solid.radius)
                && across.is_lowest(x, y * side)
            {
                best.take(self.gap(level * x + up * (y * side)), Part::Rim(j));
            }
        }
    }

    /// The point of the triangle that touches the solid after a move along the gap of a part.
    /// `None` if they touch elsewhere, as other parts may be equally deep.
    #[inline(always)]
    fn touching(&self, gap: &Gap, feature: Part) -> Option<DVec3> {
        let touching = self.doubtful() * self.doubtful();
        let shift = gap.outward * gap.width;
        match feature {
            Part::Corner => {
                let deepest = |x: &DVec3, y: &DVec3| y.dot(gap.outward) < x.dot(gap.outward);
                let [a, b, c] = *self.triangle;
                let corner = if deepest(&a, &b) { b } else { a };
                let corner = if deepest(&corner, &c) { c } else { corner };
                (OffsetPoint::of(self.solid, corner - shift).squared <= touching).then_some(corner)
            }
            Part::Face => {
                let over = self.solid.support(gap.outward) + shift;
                (squared_distance(self.triangle, over) <= touching).then_some(over)
            }
            // The solid touches in the plane of the axis and the direction.
            Part::Slope(j) | Part::Rim(j) => {
                let (start, edge) = (self.triangle[j], self.edges[j]);
                let beside = |v: DVec3| v.x * gap.outward.z - v.z * gap.outward.x;
                let in_plane = || -beside(start) / beside(edge);
                let rim = || {
                    let rim = self.solid.support(gap.outward) + shift;
                    (rim - start).dot(edge) / edge.length_squared()
                };
                let at = |s: f64| {
                    let point = start + edge * within_edge(s);
                    (OffsetPoint::of(self.solid, point - shift).squared <= touching)
                        .then_some(point)
                };
                match feature {
                    Part::Slope(_) => at(in_plane()).or_else(|| at(rim())),
                    _ => at(rim()).or_else(|| at(in_plane())),
                }
            }
        }
    }
}
