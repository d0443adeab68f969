//! Ways out of overlaps. A sheet counts as the surface of a solid here.
//!
//! Two solids that overlap cross along a closed contour, and leave each other the shortest way. An
//! overlap shrinks fastest along the area vector of its contour. Contacts are at points of the
//! contour and in its middle, as the deepest triangles may have passed each other and cross no
//! more.

use arrayvec::ArrayVec;
use glamx::DVec3;
use parry3d::query::Ray;
use sbbk_core::query::TrianglePair;

use super::islands::{Crossing, IslandWay, OverlapIslands};
use super::pose::PairPose;
use super::shapes::{TriangleShapes, TriangleSurfaceContact};
use super::surface::ALONG_NORMAL;
use super::tuning::{COHERENT, DEPTH_PER_LENGTH, OPEN, SAME_SIDE, UNEVEN};

/// Distance from a contour to its points, as a share of its length. Higher: overlaps beside sharp
/// edges are left out. Lower: rays meet the surface where they start.
const INSET: f64 = 1.0e-3;

/// Greatest number of points of a contour. Higher: more time; lower: bodies turn about the chosen
/// ones.
const CONTOUR_POINTS: usize = 6;

/// A part of a contour, where two triangles cross.
#[derive(Copy, Clone)]
struct Segment {
    pair: [u32; 2],
    /// Ends in frame 1, in the direction in which the contour runs around the overlap.
    ends: [DVec3; 2],
    /// Sum of both outward unit normals.
    outward: DVec3,
}

impl Segment {
    /// Returns `None` for triangles that do not cross.
    fn of(crossing: &Crossing, local: &TrianglePair) -> Option<Self> {
        let [t1, t2] = &local.corners;
        let [normal1, normal2] = crossing.outward_normals(&local.corners)?;
        let along = normal1.cross(normal2);
        let [from1, to1] = cut(t1, normal2, t2[0], along)?;
        let [from2, to2] = cut(t2, normal1, t1[0], along)?;
        let from = if from1.dot(along) >= from2.dot(along) { from1 } else { from2 };
        let to = if to1.dot(along) <= to2.dot(along) { to1 } else { to2 };
        (from.dot(along) < to.dot(along)).then(|| Self {
            pair: crossing.pair,
            ends: [from, to].map(|end| local.origin.as_dvec3() + end),
            outward: normal1 + normal2,
        })
    }

    fn middle(&self) -> DVec3 {
        0.5 * (self.ends[0] + self.ends[1])
    }

    fn length(&self) -> f64 {
        self.ends[0].distance(self.ends[1])
    }
}

/// Returns where a plane cuts the sides of a triangle, in their order along a direction.
fn cut(corners: &[DVec3; 3], normal: DVec3, on: DVec3, along: DVec3) -> Option<[DVec3; 2]> {
    let heights = corners.map(|corner| (corner - on).dot(normal));
    let mut ends = (0..3).filter_map(|i| {
        // Both triangles of an edge start at the same end: their segments meet in all digits.
        let [mut from, mut to] = [i, (i + 1) % 3];
        if corners[to].to_array() < corners[from].to_array() {
            (from, to) = (to, from);
        }
        let [start, end] = [heights[from], heights[to]];
        let is_cut = (start >= 0.0) != (end >= 0.0);
        is_cut.then(|| corners[from].lerp(corners[to], start / (start - end)))
    });
    let (one, other) = (ends.next()?, ends.next()?);
    Some(if one.dot(along) <= other.dot(along) { [one, other] } else { [other, one] })
}

/// Points of an overlap, and the segments that stand for them.
type Points<'s> = ArrayVec<(&'s Segment, DVec3), CONTOUR_POINTS>;

/// Distances from each point to where shape 1 ends along a way, and shape 2 against the way.
type Exits = ArrayVec<Option<[f64; 2]>, CONTOUR_POINTS>;

/// A closed contour of two shapes that overlap.
struct Contour<'a> {
    shapes: &'a TriangleShapes<'a>,
    /// True for each shape that may be left through both sides of its triangles: sheets, and shapes
    /// with triangles that are wound unlike the others.
    is_two_way: [bool; 2],
    segments: &'a [Segment],
    length: f64,
    /// A point of the overlap in the middle of the contour.
    middle: DVec3,
    /// Direction of the area vector: shape 2 leaves shape 1 along it.
    normal: DVec3,
    /// True if the contour is in a plane.
    is_flat: bool,
}

impl<'a> Contour<'a> {
    /// Returns `None` for segments that do not form a closed contour, or whose area vectors cancel.
    fn of(
        shapes: &'a TriangleShapes<'a>,
        island: &[Crossing],
        segments: &'a [Segment],
    ) -> Option<Self> {
        let is_uniform =
            |i: usize, crossing: &Crossing| crossing.outward[i] == Some(shapes[i].outward());
        let length: f64 = segments.iter().map(Segment::length).sum();
        let moment: DVec3 = segments.iter().map(|one| one.length() * one.middle()).sum();
        let middle = moment / length;
        let outward: DVec3 = segments.iter().map(|one| one.length() * one.outward).sum();
        let gap: DVec3 = segments.iter().map(|Segment { ends: [from, to], .. }| to - from).sum();
        let areas = segments.iter().map(|one| {
            let [from, to] = one.ends.map(|end| end - middle);
            from.cross(to)
        });
        let (area, swept) =
            areas.fold((DVec3::ZERO, 0.0), |(area, swept), one| (area + one, swept + one.length()));
        let is_closed = gap.length() <= OPEN * length;
        let normal = area.normalize_or_zero();
        let mut ends = segments.iter().flat_map(|one| one.ends);
        (is_closed && area.length() > COHERENT * swept).then(|| Self {
            shapes,
            is_two_way: [0, 1].map(|i| !island.iter().all(|crossing| is_uniform(i, crossing))),
            segments,
            length,
            middle: middle - INSET * outward,
            normal,
            is_flat: ends.all(|end| (end - middle).dot(normal).abs() <= UNEVEN * length),
        })
    }

    /// Returns points of the overlap, with segments that stand for them: the middle, and points far
    /// from each other at the contour. Only ties depend on the order of the segments.
    fn points(&self) -> Points<'a> {
        let from_middle = |one: &Segment| one.middle().distance_squared(self.middle);
        let nearest = self.segments.iter().min_by(|a, b| from_middle(a).total_cmp(&from_middle(b)));
        let mut chosen = Points::new();
        chosen.extend(nearest.map(|nearest| (nearest, self.middle)));
        while !chosen.is_full() {
            let distance = |one: &Segment| {
                let to_chosen = chosen.iter().map(|(_, at)| one.middle().distance_squared(*at));
                to_chosen.fold(f64::INFINITY, f64::min)
            };
            let is_left = |one: &&Segment| chosen.iter().all(|(known, _)| known.pair != one.pair);
            let left = self.segments.iter().filter(is_left);
            let farthest = left.max_by(|a, b| distance(a).total_cmp(&distance(b)));
            let Some(one) = farthest else { break };
            chosen.push((one, one.middle() - INSET * self.length * one.outward));
        }
        chosen
    }

    /// Returns the shortest way by which shape 2 leaves the overlap. Exact ways are the normal of
    /// two faces across from each other, and the area vector of a flat contour. Other ways are the
    /// area vector, and the normals where it leads out from the middle. Directions from the middle
    /// to the nearest points of both surfaces are tried as well.
    fn way_across(&self, points: &Points) -> Option<(IslandWay, Exits)> {
        let Self { length, middle, normal, is_flat, .. } = *self;
        let most = DEPTH_PER_LENGTH * length;
        let is_near = |way: &DVec3| way.dot(normal) > SAME_SIDE;
        let normals = self.exits(middle, normal).map(|[(_, one), (_, two)]| [one, -two]);
        let face = normals.filter(|[one, two]| one.dot(*two) > ALONG_NORMAL).map(|[one, _]| one);
        if let Some(way) = face.filter(is_near).or(is_flat.then_some(normal)) {
            return self.way_along(way, true, points, most);
        }
        let ways = normals.into_iter().flatten().chain(self.nearest_ways(middle)).filter(is_near);
        ways.chain([normal]).fold(None, |shortest: Option<(IslandWay, _)>, way| {
            let limit = shortest.as_ref().map_or(most, |(known, _)| known.length);
            self.way_along(way, false, points, limit).or(shortest)
        })
    }

    /// Returns the way along a direction. `None` if the direction leads out from no point, or if
    /// the way is not shorter than a limit.
    fn way_along(
        &self,
        normal: DVec3,
        is_exact: bool,
        points: &Points,
        limit: f64,
    ) -> Option<(IslandWay, Exits)> {
        let (mut length, mut exits) = (f64::NEG_INFINITY, Exits::new());
        for (_, point) in points {
            let lengths = self.exits(*point, normal).map(|exits| exits.map(|(length, _)| length));
            exits.push(lengths);
            length = lengths.map_or(length, |[length1, length2]| length.max(length1 + length2));
            if length >= limit {
                return None;
            }
        }
        (length >= 0.0).then(|| {
            let has_middle = exits[0].is_some();
            (IslandWay { normal, length, is_exact, has_middle }, exits)
        })
    }

    /// Returns directions in which the nearest points of both surfaces lead shape 2 out. `point` is
    /// in both solids.
    fn nearest_ways(&self, point: DVec3) -> impl Iterator<Item = DVec3> {
        let (point, pos12) = (point.as_vec3(), self.shapes.pose.pos12);
        let to_nearest = |i: usize, point| Some(self.shapes[i].nearest(point)?.0 - point);
        let to_nearest2 = to_nearest(1, pos12.inverse_transform_point(point));
        let ways = [to_nearest(0, point), to_nearest2.map(|way| pos12.rotation * -way)];
        ways.into_iter().flatten().map(|way| way.as_dvec3().normalize_or_zero())
    }

    /// Returns where shape 1 ends along a direction, and shape 2 against it, seen from a point in
    /// both solids: distances, and outward normals in frame 1.
    fn exits(&self, point: DVec3, direction: DVec3) -> Option<[(f64, DVec3); 2]> {
        let PairPose { pos12, .. } = self.shapes.pose;
        let (point, direction) = (point.as_vec3(), direction.as_vec3());
        let rotation = pos12.rotation;
        let at2 = pos12.inverse_transform_point(point);
        let against2 = rotation.inverse() * -direction;
        let [is_two_way1, is_two_way2] = self.is_two_way;
        let exit1 = self.shapes[0].exit(&Ray::new(point, direction), is_two_way1)?;
        let (length2, normal2) = self.shapes[1].exit(&Ray::new(at2, against2), is_two_way2)?;
        let exits = [exit1, (length2, rotation * normal2)];
        Some(exits.map(|(length, normal)| (f64::from(length), normal.as_dvec3())))
    }

    /// Returns the contact across an overlap at a point in both solids. `normal` is in frame 1, and
    /// `exits` are the distances from the point to where shape 1 ends along the normal, and shape 2
    /// against it.
    fn contact_across(
        &self,
        pair: [u32; 2],
        point: DVec3,
        normal: DVec3,
        [exit1, exit2]: [f64; 2],
    ) -> Option<TriangleSurfaceContact> {
        let [origin, ..] = self.shapes[0].corners(pair[0])?;
        let point = point - origin.as_dvec3();
        let points = [point + exit1 * normal, point - exit2 * normal];
        Some(TriangleSurfaceContact::push_out(normal, -exit1 - exit2, points))
    }
}

/// Memory for contours.
#[derive(Default)]
pub(super) struct ContourMemory {
    /// Crossings that may be part of a contour, one island after another. Crossings with an unknown
    /// outer side are left out.
    crossings: Vec<Crossing>,
    /// Segments of the island at hand.
    segments: Vec<Segment>,
}

/// Finds the ways out of islands that have a closed contour, and the contacts along them.
pub(super) fn find_ways(
    shapes: &TriangleShapes<'_>,
    islands: &mut OverlapIslands,
    ContourMemory { crossings, segments }: &mut ContourMemory,
) {
    let has_sides = |one: &&Crossing| one.is_crossing && one.outward_signs().is_some();
    crossings.clear();
    crossings.extend(islands.crossings.iter().filter(has_sides));
    crossings.sort_unstable_by_key(|crossing| (crossing.island, crossing.pair));
    for island in crossings.chunk_by(|a, b| a.island == b.island) {
        let segment = |crossing: &Crossing| Segment::of(crossing, &shapes.local(crossing.pair)?);
        segments.clear();
        segments.extend(island.iter().filter_map(segment));
        let Some(contour) = Contour::of(shapes, island, segments) else { continue };
        let points = contour.points();
        let Some((way, exits)) = contour.way_across(&points) else { continue };
        let contacts = points.iter().zip(exits).filter_map(|((segment, point), exits)| {
            Some((segment.pair, contour.contact_across(segment.pair, *point, way.normal, exits?)?))
        });
        let island = island[0].island;
        islands.ways_out[island] = Some(way);
        islands.of_contours.extend(contacts.map(|contact| (island, contact)));
    }
}
