//! Contours, along which the surfaces of two shapes cross.
//!
//! An overlap shrinks fastest along the area vector of its contour. Contacts of [deep](super::deep) overlaps are at
//! points of the contour and in its middle.

use arrayvec::ArrayVec;
use glamx::DVec3;
use sbbk_core::query::TrianglePair;

use super::islands::Unsupported;

/// Greatest gap of a closed contour, as a share of its length. Higher: contours of surfaces with holes count.
/// Lower: rounding opens contours.
const GAP: f64 = 1.0e-6;

/// Least area vector of a contour, as a share of the area that its segments sweep around the middle. Higher:
/// bodies that hook into each other keep the contacts of their triangles. Lower: contours push nowhere.
const COHERENT: f64 = 0.5;

/// Distance from a contour to its points, as a share of its length. Higher: overlaps beside sharp
/// edges are left out. Lower: rays meet the surface where they start.
const INSET: f64 = 1.0e-3;

/// Greatest distance of a flat contour from its plane, as a share of its length. Higher: contours around edges count as
/// flat. Lower: rounding makes contours of flat faces uneven.
const FLAT: f64 = 1.0e-3;

/// Greatest depth behind a contour, as a share of its length. Higher: pins are pushed back all their way. Lower: bodies deep
/// in others turn and sink.
const DEPTH_PER_LENGTH: f64 = 0.5;

/// Greatest number of points of a contour. Higher: more time; lower: bodies turn about the chosen ones.
pub(super) const MOST_POINTS: usize = 6;

/// A part of a contour, where two triangles cross.
#[derive(Copy, Clone)]
pub(super) struct Segment {
    pub(super) pair: [u32; 2],
    /// True if the triangles have a contact.
    has_contact: bool,
    /// Ends, in frame 1, with the overlap on one side for all segments of a contour.
    ends: [DVec3; 2],
    /// Sum of both outward unit normals.
    outward: DVec3,
}

impl Segment {
    /// Returns `None` for triangles that do not cross.
    pub(super) fn of(crossing: &Unsupported, local: &TrianglePair) -> Option<Self> {
        let [t1, t2] = &local.corners;
        let outward =
            |[a, b, c]: &[DVec3; 3], sign: f64| sign * (*b - *a).cross(*c - *a).normalize_or_zero();
        let [sign1, sign2] = crossing.outward;
        let [normal1, normal2] = [outward(t1, sign1), outward(t2, sign2)];
        let along = normal1.cross(normal2);
        let [from1, to1] = cut(t1, normal2, t2[0], along)?;
        let [from2, to2] = cut(t2, normal1, t1[0], along)?;
        let from = if from1.dot(along) >= from2.dot(along) { from1 } else { from2 };
        let to = if to1.dot(along) <= to2.dot(along) { to1 } else { to2 };
        (from.dot(along) < to.dot(along)).then(|| Self {
            pair: crossing.pair,
            has_contact: crossing.has_contact,
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
pub(super) type Points<'s> = ArrayVec<(&'s Segment, DVec3), MOST_POINTS>;

/// A closed contour.
pub(super) struct Contour<'s> {
    segments: &'s [Segment],
    inset: f64,
    /// Depth up to which bodies leave an overlap along its contour.
    pub(super) most: f64,
    /// A point of the overlap in the middle of the contour.
    pub(super) middle: DVec3,
    /// Direction of the area vector: shape 2 leaves shape 1 along it.
    pub(super) normal: DVec3,
    /// True if the contour is in a plane.
    pub(super) is_flat: bool,
}

impl<'s> Contour<'s> {
    /// Returns `None` for segments that do not form a closed contour, or whose area vectors cancel.
    pub(super) fn of(segments: &'s [Segment]) -> Option<Self> {
        let length: f64 = segments.iter().map(Segment::length).sum();
        let moment: DVec3 = segments.iter().map(|one| one.length() * one.middle()).sum();
        let middle = moment / length;
        let outward: DVec3 = segments.iter().map(|one| one.length() * one.outward).sum();
        let inset = INSET * length;
        let gap: DVec3 = segments.iter().map(|Segment { ends: [from, to], .. }| to - from).sum();
        let areas = segments.iter().map(|one| {
            let [from, to] = one.ends.map(|end| end - middle);
            from.cross(to)
        });
        let (area, swept) =
            areas.fold((DVec3::ZERO, 0.0), |(area, swept), one| (area + one, swept + one.length()));
        let is_closed = gap.length() <= GAP * length;
        let normal = area.normalize_or_zero();
        let mut ends = segments.iter().flat_map(|one| one.ends);
        (is_closed && area.length() > COHERENT * swept).then(|| Self {
            segments,
            inset,
            most: DEPTH_PER_LENGTH * length,
            middle: middle - inset / length * outward,
            normal,
            is_flat: ends.all(|end| (end - middle).dot(normal).abs() <= FLAT * length),
        })
    }

    /// Returns points of the overlap, with segments that stand for them: the middle, and points far from each other at
    /// the contour. The choice does not depend on the order of the segments. Pairs with a contact stand for none.
    pub(super) fn points(&self) -> Points<'s> {
        let free = || self.segments.iter().filter(|one| !one.has_contact);
        let from_middle = |one: &Segment| one.middle().distance_squared(self.middle);
        let nearest = free().min_by(|a, b| from_middle(a).total_cmp(&from_middle(b)));
        let mut chosen = Points::new();
        chosen.extend(nearest.map(|nearest| (nearest, self.middle)));
        while !chosen.is_full() {
            let distance = |one: &Segment| {
                let to_chosen = chosen.iter().map(|(_, at)| one.middle().distance_squared(*at));
                to_chosen.fold(f64::INFINITY, f64::min)
            };
            let is_left = |one: &&Segment| chosen.iter().all(|(known, _)| known.pair != one.pair);
            let left = free().filter(is_left);
            let farthest = left.max_by(|a, b| distance(a).total_cmp(&distance(b)));
            let Some(one) = farthest else { break };
            chosen.push((one, one.middle() - self.inset * one.outward));
        }
        chosen
    }
}
