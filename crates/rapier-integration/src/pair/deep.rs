//! Contacts of solids that are deep in each other.
//!
//! Faces that have passed each other by more than a row of triangles no longer cross. Contacts lead the shortest way
//! out of the overlap behind a [contour](super::contour).

use glamx::DVec3;
use sbbk_core::contact::{Feature, FeaturePair, TriangleContact};

use super::contour::{Contour, Points, Segment};
use super::islands::{OverlapIslands, Unsupported};
use super::pose::PairPose;
use super::query::ContactList;
use super::triangle_shapes::{ContactSource, TriangleShapes, TriangleSurfaceContact};

/// Least cosine between the area vector of a contour and a shorter way out. Higher: boxes leave boxes at a slant. Lower:
/// contacts of several contours push against each other.
const ONE_WAY: f64 = 0.7;

/// Memory for contours: crossings by island, and the segments of an island.
#[derive(Default)]
pub(super) struct ContourMemory {
    crossings: Vec<Unsupported>,
    segments: Vec<Segment>,
}

impl ContourMemory {
    /// Gives back memory beyond that for `limit` crossings.
    pub(super) fn shrink_to(&mut self, limit: usize) {
        if self.crossings.capacity() > limit {
            *self = Self::default();
        }
    }
}

/// Two shapes that may be deep in each other.
pub(super) struct DeepSearch<'a, S> {
    pub(super) shapes: &'a S,
    pub(super) pose: &'a PairPose,
}

impl<S: TriangleShapes> DeepSearch<'_, S> {
    /// Adds contacts along the area vectors of contours to islands of solids that have too few.
    pub(super) fn add_contacts(
        &self,
        islands: &mut OverlapIslands,
        ContourMemory { crossings, segments }: &mut ContourMemory,
        contacts: &mut ContactList<TriangleSurfaceContact>,
    ) {
        islands.list_unsupported(crossings);
        for island in crossings.chunk_by(|a, b| a.island == b.island) {
            segments.clear();
            segments.extend(island.iter().filter_map(|crossing| {
                Segment::of(crossing, &self.shapes.local(self.pose, crossing.pair)?)
            }));
            let Some(contour) = Contour::of(segments) else { continue };
            let points = contour.points();
            let Some((depth, normal)) = self.way_across(&contour, &points) else { continue };
            if depth > contour.most || !islands.leads_apart(normal) {
                continue;
            }
            let old_count = contacts.len();
            contacts.extend(points.iter().filter_map(|(segment, point)| {
                Some((segment.pair, self.contact_across(segment.pair, *point, normal)?))
            }));
            if contacts.len() > old_count {
                islands.set_way(segments[0].pair, normal);
            }
        }
    }

    /// Returns the shortest way by which shape 2 leaves an overlap: length and direction. Tries the area vector of the
    /// contour and, from its middle, the normals where that leads out, and the nearest points of both surfaces.
    fn way_across(&self, contour: &Contour, points: &Points) -> Option<(f64, DVec3)> {
        let Contour { middle, normal, .. } = *contour;
        let length = |way: DVec3| {
            let exits = points.iter().filter_map(|(_, point)| self.exits(*point, way));
            exits.map(|[(length1, _), (length2, _)]| length1 + length2).reduce(f64::max)
        };
        let normals = self.exits(middle, normal).map(|[(_, one), (_, two)]| [one, -two]);
        let ways = normals.into_iter().flatten().chain(self.nearest_ways(middle));
        let ways = ways.filter(|way| way.dot(normal) > ONE_WAY).chain([normal]);
        let lengths = ways.filter_map(|way| Some((length(way)?, way)));
        lengths.min_by(|(a, _), (b, _)| a.total_cmp(b))
    }

    /// Returns directions in which the nearest points of both surfaces lead shape 2 out. `point` is in both solids.
    fn nearest_ways(&self, point: DVec3) -> impl Iterator<Item = DVec3> {
        let (point, pos12) = (point.as_vec3(), self.pose.pos12);
        let to_nearest = |i: usize, point| Some(self.shapes.nearest(i, point)?.0 - point);
        let to_nearest2 = to_nearest(1, pos12.inverse_transform_point(point));
        let ways = [to_nearest(0, point), to_nearest2.map(|way| pos12.rotation * -way)];
        ways.into_iter().flatten().map(|way| way.as_dvec3().normalize_or_zero())
    }

    /// Returns where shape 1 ends along a direction, and shape 2 against it, seen from a point in both solids: distances,
    /// and outward normals in frame 1.
    fn exits(&self, point: DVec3, direction: DVec3) -> Option<[(f64, DVec3); 2]> {
        let PairPose { pos12, .. } = self.pose;
        let (point, direction) = (point.as_vec3(), direction.as_vec3());
        let rotation = pos12.rotation;
        let exit1 = self.shapes.exit(0, point, direction)?;
        let at2 = pos12.inverse_transform_point(point);
        let (length2, normal2) = self.shapes.exit(1, at2, rotation.inverse() * -direction)?;
        let exits = [exit1, (length2, rotation * normal2)];
        Some(exits.map(|(length, normal)| (f64::from(length), normal.as_dvec3())))
    }

    /// Returns the contact across an overlap at a point in both solids. `normal` is in frame 1.
    fn contact_across(
        &self,
        pair: [u32; 2],
        point: DVec3,
        normal: DVec3,
    ) -> Option<TriangleSurfaceContact> {
        let [(depth1, _), (depth2, _)] = self.exits(point, normal)?;
        let [[origin, ..], _] = self.shapes.corners(pair)?;
        let point = point - origin.as_dvec3();
        let contact = TriangleContact {
            normal,
            distance: -depth1 - depth2,
            point1: point + depth1 * normal,
            point2: point - depth2 * normal,
            features: FeaturePair::new(Feature::Face, Feature::Face),
        };
        Some(TriangleSurfaceContact { contact, source: ContactSource::PushOut })
    }
}
