//! Ways that part all pairs of an island.
//!
//! Two crossing triangles know the ways across their own faces and edges. A contact of another pair
//! may part them as well, if both surfaces end where the overlap along its way does.

use glamx::DVec3;

use super::{Crossing, OverlapIslands};
use crate::pair::ways::{SAME_DIRECTION, SAME_SIDE, add_direction};

impl OverlapIslands {
    /// Returns true if the normals of all contacts are within an angle of the first one.
    pub(super) fn are_within(&self, cosine: f64) -> bool {
        let Some(first) = self.crossings.first() else { return true };
        self.crossings.iter().all(|one| one.normal.dot(first.normal) >= cosine)
    }

    /// Notes the way of the contacts if there is only one, at a `small` depth.
    pub(super) fn note_one_way(&mut self, small: f64) {
        let depth = self.crossings.iter().map(|crossing| crossing.depth).fold(0.0, f64::max);
        let way = self.crossings.first().map(|crossing| (crossing.normal, depth));
        if depth <= small && self.are_within(SAME_DIRECTION) {
            self.one_ways.extend(way);
        }
    }

    /// Rejects contacts that push aside where one way parts all pairs of the island at a `small`
    /// depth.
    pub(super) fn keep_one_way(
        &mut self,
        small: f64,
        is_parted: impl Fn([u32; 2], DVec3, f64) -> bool,
    ) {
        let Self { crossings, ways, one_ways, .. } = self;
        ways.clear();
        for crossing in crossings.iter().filter(|crossing| crossing.is_fine()) {
            ways.add(crossing.island, crossing.normal, crossing.depth);
        }
        for &Crossing { pair, normal, island, .. } in &*crossings {
            let is_parted = |way: DVec3, depth: f64| is_parted(pair, way, depth);
            ways.keep_parting(island, normal, small, is_parted);
        }
        for crossing in crossings {
            let Some((way, depth)) = ways.least(crossing.island) else { continue };
            add_direction(one_ways, way, depth);
            crossing.is_rejected |= way.dot(crossing.normal) < SAME_SIDE;
        }
    }
}
