use glamx::DVec3;
use rustc_hash::FxHashMap;
use sbbk_core::collections::UnionFind;
use sbbk_core::surface::area_vector;

use super::shapes::TriangleHit;
use super::tuning::{OUTWARD, SAME_DIRECTION, SAME_SIDE};
use super::ways::{Directions, Ways, add_direction};

/// Overlap islands: pairs of crossing triangles, connected through common triangles, and the
/// contacts that push each island apart.
#[derive(Default)]
pub(crate) struct OverlapIslands {
    /// Pairs of the first pass that cross or have passed each other, in the order of pairs.
    pub(super) crossings: Vec<Crossing>,
    /// Pairs of the first pass that touch without a contact.
    pub(super) touching: Vec<[u32; 2]>,
    /// Ways of the reliable contacts, by island.
    ways: Ways,
    /// Crossings, and then the pairs that touch, by index.
    islands: UnionFind,
    /// A pair with each triangle.
    with_triangle: FxHashMap<Node, usize>,
    /// Ways that part all pairs of an island at a small depth, and the depths.
    pub(super) one_ways: Directions,
    /// Way out of each island whose contour has one, by island.
    pub(super) ways_out: Vec<Option<IslandWay>>,
    /// Contacts along these ways in the middles of contours and at points of them, with their
    /// islands.
    pub(super) of_contours: Vec<(usize, TriangleHit)>,
    /// Support of each island, by island. Others have no pairs.
    support: Vec<Support>,
}

/// Contacts that push the bodies of an island apart.
#[derive(Copy, Clone, Default)]
pub(super) struct Support {
    /// Pairs of triangles.
    pairs: u32,
    /// Reliable contacts among them.
    reliable: u32,
    /// Sum of the normals of reliable contacts.
    normals: DVec3,
    /// Direction off a sheet, to the side on which the middle of a solid is; zero without a sheet.
    sheet_side: DVec3,
}

/// Number of crossing pairs of an island for which one reliable contact is enough. Higher: bodies
/// deep in each other turn about their only contact and sink; lower: contacts that are no local
/// minima push aside.
const SUPPORTED: u32 = 4;

/// Direction by which shape 2 leaves an overlap.
#[derive(Copy, Clone)]
pub(super) struct IslandWay {
    pub(super) normal: DVec3,
    /// Depth of the overlap along the way.
    pub(super) length: f64,
    /// True if the contour is in a plane across the way, or if two faces are across from each
    /// other.
    pub(super) is_exact: bool,
    /// True if the middle of the contour is in the overlap. If not, contacts of the pairs come
    /// first.
    pub(super) has_middle: bool,
}

impl IslandWay {
    /// Returns the direction of the contact of two triangles: the way, turned a little to the
    /// direction out of both. Contacts of Rapier are soft. One direction has four of them at most,
    /// and several directions carry more.
    pub(super) fn towards(&self, [outward1, outward2]: [DVec3; 2]) -> DVec3 {
        let out = (outward1 - outward2).normalize_or_zero();
        if self.is_exact { self.normal } else { (self.normal + OUTWARD * out).normalize() }
    }
}

impl Support {
    fn is_enough(self) -> bool {
        self.pairs <= SUPPORTED * self.reliable
    }

    /// Returns true for the normals of contacts that push neither against the reliable ones, nor
    /// through a sheet.
    pub(super) fn agrees(self, normal: DVec3) -> bool {
        self.normals.dot(normal) >= 0.0 && self.sheet_side.dot(normal) >= 0.0
    }
}

/// A triangle, and its mesh: 0 or 1.
type Node = (usize, u32);

/// Two triangles that cross or have passed each other.
#[derive(Copy, Clone)]
pub(super) struct Crossing {
    pub(super) pair: [u32; 2],
    /// False if they have passed each other.
    pub(super) is_crossing: bool,
    /// True if they have passed each other by so little that rounding decides.
    pub(super) is_touching: bool,
    /// True if the contact of the pair leads out.
    pub(super) is_reliable: bool,
    /// Normal of this contact, from mesh 1 to mesh 2.
    pub(super) normal: DVec3,
    /// Depth of this contact.
    pub(super) depth: f64,
    /// Signs with which the normals of the triangles lead out of the shapes. `None` for a sheet,
    /// unless two sheets have passed each other.
    pub(super) outward: [Option<f64>; 2],
    /// Set unless both shapes are solids, or the solid is larger than the sheet.
    pub(super) sheet: Option<SheetSide>,
    /// True if this contact pushes the wrong way.
    pub(super) is_rejected: bool,
    /// False if the triangles do not cross after all.
    pub(super) counts: bool,
    /// Index of the first crossing of the island.
    pub(super) island: usize,
}

/// Position of a body relative to a triangle of a sheet.
#[derive(Copy, Clone)]
pub(super) struct SheetSide {
    /// The shape that counts as the sheet: of two sheets the larger one, `None` if both are equally
    /// large.
    pub(super) shape: Option<usize>,
    /// Normal of contacts that push the body off the front of the triangle.
    pub(super) away: DVec3,
    /// Height of the middle of the body over the front.
    pub(super) height: f64,
}

impl SheetSide {
    /// Returns true if a contact pushes the middle of the body through the sheet.
    pub(super) fn is_pushed_through(&self, normal: DVec3) -> bool {
        self.away.dot(normal) * self.height.signum() < -SAME_SIDE
    }
}

impl Crossing {
    /// Returns true if the contact of the pair is reliable and pushes the right way.
    pub(super) fn is_fine(&self) -> bool {
        self.is_reliable && !self.is_rejected
    }

    /// Returns true for triangles of two sheets that have passed each other.
    fn are_passed_sheets(&self) -> bool {
        self.sheet.is_some() && self.outward.iter().all(Option::is_some)
    }

    /// Returns the unit normals of the triangles that lead out of the shapes, if these are known.
    pub(super) fn outward_normals(&self, corners: &[[DVec3; 3]; 2]) -> Option<[DVec3; 2]> {
        let signs = self.outward_signs()?;
        Some([0, 1].map(|i| signs[i] * area_vector(&corners[i]).normalize_or_zero()))
    }

    /// Returns signs with which the normals of the triangles lead out of the shapes, if these are
    /// known. A sheet counts as solid on the side away from the middle of the other shape.
    pub(super) fn outward_signs(&self) -> Option<[f64; 2]> {
        let of_sheet = |i: usize| {
            let SheetSide { shape, height, .. } = self.sheet?;
            Some(if shape? == i { height.signum() } else { 1.0 })
        };
        let sign = |i: usize| self.outward[i].or_else(|| of_sheet(i));
        Some([sign(0)?, sign(1)?])
    }
}

impl OverlapIslands {
    /// Begins the first pass of a query.
    pub(super) fn clear(&mut self) {
        self.crossings.clear();
        self.touching.clear();
    }

    /// Finds the ways that part whole islands, and rejects contacts that push aside. Two crossing
    /// triangles know the ways across their own faces and edges. A contact of another pair may part
    /// them as well, if both surfaces end where the overlap along its way does. Returns true if a
    /// second pass is needed. `small`: depth of bodies at rest. `is_parted` tells if a way of
    /// a length parts two triangles, and both surfaces end there.
    pub(super) fn settle_one_ways(
        &mut self,
        small: f64,
        is_parted: impl Fn([u32; 2], DVec3, f64) -> bool,
    ) -> bool {
        self.one_ways.clear();
        if self.crossings.iter().all(Crossing::is_fine) && self.are_within(SAME_SIDE) {
            self.note_one_way(small);
            return false;
        }
        self.keep_one_way(small, is_parted);
        if self.crossings.iter().all(Crossing::is_fine) {
            return false;
        }
        self.sum_support();
        let needs_more = |support: &Support| !support.is_enough();
        let is_rejected = |crossing: &Crossing| crossing.is_rejected;
        self.crossings.iter().any(is_rejected) || self.support.iter().any(needs_more)
    }

    /// Returns true if the normals of all contacts are within an angle of the first one.
    fn are_within(&self, cosine: f64) -> bool {
        let Some(first) = self.crossings.first() else { return true };
        self.crossings.iter().all(|one| one.normal.dot(first.normal) >= cosine)
    }

    /// Notes the way of the contacts if there is only one, at a `small` depth.
    fn note_one_way(&mut self, small: f64) {
        let depth = self.crossings.iter().map(|crossing| crossing.depth).fold(0.0, f64::max);
        let way = self.crossings.first().map(|crossing| (crossing.normal, depth));
        if depth <= small && self.are_within(SAME_DIRECTION) {
            self.one_ways.extend(way);
        }
    }

    /// Rejects contacts that push aside where one way parts all pairs of the island at a `small`
    /// depth.
    fn keep_one_way(&mut self, small: f64, is_parted: impl Fn([u32; 2], DVec3, f64) -> bool) {
        let Self { crossings, ways, one_ways, .. } = self;
        let fine = crossings.iter().filter(|crossing| crossing.is_fine());
        let fine = fine.map(|&Crossing { island, normal, depth, .. }| (island, normal, depth));
        let pairs =
            crossings.iter().map(|&Crossing { island, normal, pair, .. }| (island, normal, pair));
        ways.find(small, fine, pairs, is_parted);
        for crossing in crossings {
            let Some((way, depth)) = ways.least(crossing.island) else { continue };
            add_direction(one_ways, way, depth);
            crossing.is_rejected |= way.dot(crossing.normal) < SAME_SIDE;
        }
    }

    /// Drops sheets that have passed each other unless triangles cross.
    pub(super) fn keep_passed_if_crossing(&mut self) {
        if !self.crossings.iter().any(|crossing| crossing.is_crossing) {
            self.crossings.retain(|crossing| !crossing.are_passed_sheets());
        }
    }

    /// Joins crossings with common triangles to islands. An island has the index of its first
    /// crossing.
    pub(super) fn join(&mut self) {
        let Self { crossings, touching, islands, with_triangle, .. } = self;
        islands.reset(crossings.len() + touching.len());
        with_triangle.clear();
        // Triangles on opposite sides of crossing edges only touch.
        let pairs = crossings.iter().map(|crossing| &crossing.pair).chain(&*touching);
        for (index, &[one, two]) in pairs.enumerate() {
            for node in [(0, one), (1, two)] {
                islands.join(*with_triangle.entry(node).or_insert(index), index);
            }
        }
        for (index, crossing) in crossings.iter_mut().enumerate() {
            crossing.island = islands.first(index);
        }
        self.ways_out.clear();
        self.ways_out.resize(self.crossings.len(), None);
        self.of_contours.clear();
    }

    /// Returns the crossing of a pair.
    fn crossing(&self, pair: [u32; 2]) -> Option<&Crossing> {
        let index = self.crossings.binary_search_by_key(&pair, |crossing| crossing.pair);
        index.ok().map(|index| &self.crossings[index])
    }

    /// Returns true if a second pass does not change the contact of a pair.
    pub(super) fn is_final(&self, pair: [u32; 2]) -> bool {
        self.crossing(pair).is_none_or(Crossing::is_fine)
    }

    /// Returns the support of an island, if that has too few reliable contacts.
    pub(super) fn open_support(&self, island: usize) -> Option<Support> {
        Some(self.support[island]).filter(|support| !support.is_enough())
    }

    /// Returns the way out of an island whose pairs all have contacts along it.
    pub(super) fn leading_way(&self, island: usize) -> Option<IslandWay> {
        self.ways_out[island].filter(|way| way.has_middle)
    }

    /// Returns the contacts along the ways out of some islands.
    pub(super) fn of_contours(
        &self,
        counts: impl Fn(usize) -> bool,
    ) -> impl Iterator<Item = TriangleHit> {
        self.of_contours.iter().filter(move |(island, _)| counts(*island)).map(|(_, hit)| *hit)
    }

    /// Sums the support of each island.
    fn sum_support(&mut self) {
        self.support.clear();
        self.support.resize(self.ways_out.len(), Support::default());
        for crossing in &self.crossings {
            let is_fine = crossing.is_fine();
            let support = &mut self.support[crossing.island];
            support.pairs += 1;
            support.reliable += u32::from(is_fine);
            support.normals += if is_fine { crossing.normal } else { DVec3::ZERO };
            support.sheet_side +=
                crossing.sheet.map_or(DVec3::ZERO, |sheet| sheet.height * sheet.away);
        }
    }
}

#[cfg(test)]
mod tests;
