//! Ways out of overlaps, by group: the islands of two meshes, or the parts of a convex shape.
//!
//! All overlaps of a group may have the same way out. If resting bodies are as deep, only contacts
//! along this way count. Otherwise a body that has sunk in by a millimetre would stop at the sides
//! of a gap.

use arrayvec::ArrayVec;
use glamx::DVec3;
use rustc_hash::FxHashMap;

use super::reduce::EQUAL_DEPTH;

/// Greatest depth of resting bodies, in filter distances: a fiftieth of the radius. Higher: bodies
/// deep in others leave along one way. Lower: heavy bodies stop at gaps.
pub(super) const RESTING_DEPTH: f64 = 0.2;

/// Ratio of lengths up to which triangles are parted as an overlap is. Higher: walls beside a floor
/// let go. Lower: edges that cross push each other aside.
pub(super) const ALIKE: f64 = 1.1;

/// Cosine above which two normals push to one side. Higher: bodies that pierce a solid are held in
/// it; lower: contacts that do not push against each other are rejected.
pub(super) const SAME_SIDE: f64 = 0.5;

/// Cosine above which two normals of a triangle's contacts are one direction. Higher: a triangle
/// that many others cross takes longer; lower: directions that push against each other are
/// confused.
pub(super) const SAME_DIRECTION: f64 = 0.99;

/// Directions of reliable contacts that are remembered for a group. Higher: slower where many
/// differ. Lower: ways out are missed.
const MOST_DIRECTIONS: usize = 16;

/// Directions with the greatest depths of their contacts.
pub(super) type Directions = ArrayVec<(DVec3, f64), MOST_DIRECTIONS>;

/// Directions of the contacts of each group.
#[derive(Default)]
pub(super) struct Ways(FxHashMap<usize, Directions>);

impl Ways {
    /// Finds the ways of `reliable` contacts that are no deeper than `small`, and part overlaps of
    /// their group. Contacts come with their group and depth, `overlaps` with their group and the
    /// normal of their contact.
    pub(super) fn find<T: Copy>(
        &mut self,
        small: f64,
        reliable: impl Iterator<Item = (usize, DVec3, f64)>,
        overlaps: impl Iterator<Item = (usize, DVec3, T)>,
        mut is_parted: impl FnMut(T, DVec3, f64) -> bool,
    ) {
        self.0.clear();
        for (group, normal, depth) in reliable {
            add_direction(self.0.entry(group).or_default(), normal, depth);
        }
        for (group, normal, overlap) in overlaps {
            self.0.entry(group).or_default().retain(|(way, depth)| {
                let is_own = way.dot(normal) >= SAME_DIRECTION;
                *depth <= small && (is_own || is_parted(overlap, *way, *depth))
            });
        }
    }

    /// Returns the least deep way of a group.
    pub(super) fn least(&self, group: usize) -> Option<(DVec3, f64)> {
        self.0.get(&group)?.iter().copied().min_by(|(_, a), (_, b)| a.total_cmp(b))
    }
}

/// Adds a direction and a depth. Like directions are one, with the greatest depth.
pub(super) fn add_direction(known: &mut Directions, normal: DVec3, depth: f64) {
    match known.iter_mut().find(|(way, _)| way.dot(normal) >= SAME_DIRECTION) {
        Some((_, greatest)) => *greatest = greatest.max(depth),
        None => _ = known.try_push((normal, depth)),
    }
}

/// Returns the difference up to which two heights are equal.
pub(super) fn equal_height(filter_unit: f64) -> f64 {
    f64::from(EQUAL_DEPTH) * filter_unit
}

/// Returns the greatest overlap that a way of a length parts.
pub(super) fn greatest_overlap(length: f64, filter_unit: f64) -> f64 {
    ALIKE * length + equal_height(filter_unit)
}
