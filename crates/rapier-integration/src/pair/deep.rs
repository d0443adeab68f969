//! Contacts of shapes that are deep in each other. A sheet counts as the border of a solid here.
//!
//! Faces that have passed each other by more than a row of triangles no longer cross. Contacts lead the shortest way
//! out of the overlap behind a [contour](super::contour).

use arrayvec::ArrayVec;
use glamx::DVec3;
use parry3d::query::Ray;

use super::contour::{Contour, MOST_POINTS, Points, Segment};
use super::islands::{IslandWay, OverlapIslands, Unsupported};
use super::pose::PairPose;
use super::query::ContactList;
use super::triangle_shapes::{TriangleShapes, TriangleSurfaceContact};

/// Least cosine between the area vector of a contour and a shorter way out. Higher: boxes leave boxes at a slant. Lower:
/// contacts of several contours push against each other.
const NEAR_AREA_VECTOR: f64 = 0.7;

/// Memory for contours: crossings by island, and the segments of an island.
#[derive(Default)]
pub(super) struct ContourMemory {
    crossings: Vec<Unsupported>,
    segments: Vec<Segment>,
}

/// A way by which shape 2 leaves an overlap.
struct Way {
    /// Direction, in frame 1.
    normal: DVec3,
    /// Greatest depth along the way.
    length: f64,
    /// Distances from each point to where shape 1 ends along the way, and shape 2 against it.
    exits: ArrayVec<Option<[f64; 2]>, MOST_POINTS>,
}

/// An island of two shapes that are deep in each other.
struct DeepIsland<'a> {
    shapes: &'a TriangleShapes<'a>,
    /// True for each shape that may be left through both sides of its triangles.
    is_sheet: [bool; 2],
}

/// Adds contacts along the ways out of contours to islands that have too few.
pub(super) fn add_contacts(
    shapes: &TriangleShapes<'_>,
    islands: &mut OverlapIslands,
    ContourMemory { crossings, segments }: &mut ContourMemory,
    contacts: &mut ContactList<TriangleSurfaceContact>,
) {
    islands.list_unsupported(crossings);
    for island in crossings.chunk_by(|a, b| a.island == b.island) {
        segments.clear();
        segments.extend(
            island
                .iter()
                .filter_map(|crossing| Segment::of(crossing, &shapes.local(crossing.pair)?)),
        );
        let Some(contour) = Contour::of(segments) else { continue };
        let points = contour.points();
        let is_sheet = [0, 1].map(|i| island.iter().any(|crossing| crossing.is_sheet[i]));
        let deep = DeepIsland { shapes, is_sheet };
        let Some(Way { normal, length, exits }) = deep.way_across(&contour, &points) else {
            continue;
        };
        if length > contour.most || !islands.leads_apart(normal) {
            continue;
        }
        contacts.extend(points.iter().zip(exits).filter_map(|((segment, point), exits)| {
            Some((segment.pair, deep.contact_across(segment.pair, *point, normal, exits?)?))
        }));
        let way = IslandWay { normal, is_exact: contour.is_flat };
        islands.set_way(segments[0].pair, way);
    }
}

impl DeepIsland<'_> {
    /// Returns the shortest way by which shape 2 leaves an overlap. For a flat contour that is the area vector. For others,
    /// tries the area vector and, from the middle, the normals where that leads out, and the nearest points of both
    /// surfaces.
    fn way_across(&self, contour: &Contour, points: &Points) -> Option<Way> {
        let Contour { middle, normal, is_flat, .. } = *contour;
        if is_flat {
            return self.way_along(normal, points);
        }
        let normals = self.exits(middle, normal).map(|[(_, one), (_, two)]| [one, -two]);
        let ways = normals.into_iter().flatten().chain(self.nearest_ways(middle));
        let ways = ways.filter(|way| way.dot(normal) > NEAR_AREA_VECTOR).chain([normal]);
        let ways = ways.filter_map(|way| self.way_along(way, points));
        ways.min_by(|a, b| a.length.total_cmp(&b.length))
    }

    /// Returns the way along a direction; `None` if it leads out from no point.
    fn way_along(&self, normal: DVec3, points: &Points) -> Option<Way> {
        let exits = points.iter().map(|(_, point)| {
            self.exits(*point, normal).map(|exits| exits.map(|(length, _)| length))
        });
        let exits: ArrayVec<_, MOST_POINTS> = exits.collect();
        let lengths = exits.iter().flatten().map(|[length1, length2]| length1 + length2);
        Some(Way { normal, length: lengths.reduce(f64::max)?, exits })
    }

    /// Returns directions in which the nearest points of both surfaces lead shape 2 out. `point` is in both solids.
    fn nearest_ways(&self, point: DVec3) -> impl Iterator<Item = DVec3> {
        let (point, pos12) = (point.as_vec3(), self.shapes.pose.pos12);
        let to_nearest = |i: usize, point| Some(self.shapes[i].nearest(point)?.0 - point);
        let to_nearest2 = to_nearest(1, pos12.inverse_transform_point(point));
        let ways = [to_nearest(0, point), to_nearest2.map(|way| pos12.rotation * -way)];
        ways.into_iter().flatten().map(|way| way.as_dvec3().normalize_or_zero())
    }

    /// Returns where shape 1 ends along a direction, and shape 2 against it, seen from a point in both solids: distances,
    /// and outward normals in frame 1.
    fn exits(&self, point: DVec3, direction: DVec3) -> Option<[(f64, DVec3); 2]> {
        let PairPose { pos12, .. } = self.shapes.pose;
        let (point, direction) = (point.as_vec3(), direction.as_vec3());
        let rotation = pos12.rotation;
        let at2 = pos12.inverse_transform_point(point);
        let against2 = rotation.inverse() * -direction;
        let [is_sheet1, is_sheet2] = self.is_sheet;
        let exit1 = self.shapes[0].exit(&Ray::new(point, direction), is_sheet1)?;
        let (length2, normal2) = self.shapes[1].exit(&Ray::new(at2, against2), is_sheet2)?;
        let exits = [exit1, (length2, rotation * normal2)];
        Some(exits.map(|(length, normal)| (f64::from(length), normal.as_dvec3())))
    }

    /// Returns the contact across an overlap at a point in both solids. `normal` is in frame 1, and `exits` are the
    /// distances from the point to where shape 1 ends along the normal, and shape 2 against it.
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
