//! Ways out of overlaps, by group: the islands of two meshes, or the parts of a convex shape.
//!
//! All overlaps of a group may have the same way out. If resting bodies are as deep, only contacts
//! along this way count. Otherwise a body that has sunk in by a millimetre would stop at the sides
//! of a gap.

use arrayvec::ArrayVec;
use glamx::DVec3;
use rustc_hash::FxHashMap;

use super::tuning::{ALIKE, EQUAL_DEPTH, RESTING_DEPTH, SAME_DIRECTION};

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

/// Returns the greatest depth of resting bodies.
pub(super) fn resting_depth(filter_distance: f64) -> f64 {
    RESTING_DEPTH * filter_distance
}

/// Returns the difference up to which two heights are equal.
pub(super) fn equal_height(filter_unit: f64) -> f64 {
    f64::from(EQUAL_DEPTH) * filter_unit
}

/// Returns the greatest overlap that a way of a length parts.
pub(super) fn greatest_overlap(length: f64, filter_unit: f64) -> f64 {
    ALIKE * length + equal_height(filter_unit)
}
