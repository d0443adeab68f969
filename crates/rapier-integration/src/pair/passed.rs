//! Triangles of a sheet that have passed another sheet.
//!
//! A solid tells for each contact if it leads outwards. A sheet has two sides, so the part of a sheet
//! beyond another one would be pushed farther. Triangles of that part hang together with triangles
//! that cross, and their contacts push against those of the crossing triangles.

use std::collections::hash_map::Entry;

use glamx::DVec3;
use rustc_hash::FxHashMap;
use sbbk_core::surface::Facets;

use super::islands::SAME_SIDE;
use super::query::ContactList;
use super::triangle_shapes::{ContactSource, TriangleSurfaceContact};

/// Search for triangles that have passed another sheet. Keeps its memory.
#[derive(Default)]
pub(crate) struct PassedTriangles {
    /// Triangles with the normals of their contacts apart, sorted by triangle.
    apart: Vec<(u32, DVec3)>,
    /// Triangles that cross or have passed, in the order of discovery, and the directions in which
    /// the crossing ones push.
    found: Vec<(u32, DVec3)>,
    /// The directions by triangle.
    directions: FxHashMap<u32, DVec3>,
}

impl PassedTriangles {
    /// Removes the contacts of triangles of shape `i` that have passed the other shape. `crossing` has
    /// triangles of shape `i`, and the directions in which their contacts push.
    pub(super) fn reject(
        &mut self,
        i: usize,
        surface: &impl Facets,
        crossing: impl Iterator<Item = (u32, DVec3)>,
        contacts: &mut ContactList<TriangleSurfaceContact>,
    ) {
        self.apart.clear();
        let apart = contacts.iter().filter(|(_, contact)| is_apart(contact));
        self.apart.extend(apart.map(|(pair, contact)| (pair[i], contact.contact.normal)));
        if self.apart.is_empty() {
            return;
        }
        self.apart.sort_unstable_by_key(|&(triangle, _)| triangle);
        self.found.clear();
        self.directions.clear();
        crossing.for_each(|(triangle, away)| self.add(triangle, away));
        self.spread(surface);
        contacts.retain(|(pair, contact)| {
            let away = self.directions.get(&pair[i]).filter(|_| is_apart(contact));
            away.is_none_or(|&away| !opposes(contact.contact.normal, away))
        });
    }

    /// Adds a triangle, unless it was found before.
    fn add(&mut self, triangle: u32, away: DVec3) {
        if let Entry::Vacant(entry) = self.directions.entry(triangle) {
            entry.insert(away);
            self.found.push((triangle, away));
        }
    }

    /// Adds the neighbours of all triangles that were found, if these have passed.
    fn spread(&mut self, surface: &impl Facets) {
        let mut next = 0;
        while let Some(&(triangle, away)) = self.found.get(next) {
            next += 1;
            for half_edge in (0..3).filter_map(|edge| surface.twin(3 * triangle + edge)) {
                if self.has_passed(half_edge / 3, away) {
                    self.add(half_edge / 3, away);
                }
            }
        }
    }

    /// Returns true if a contact of a triangle pushes against a direction.
    fn has_passed(&self, triangle: u32, away: DVec3) -> bool {
        let first = self.apart.partition_point(|&(other, _)| other < triangle);
        let mut own = self.apart[first..].iter().take_while(|&&(other, _)| other == triangle);
        own.any(|&(_, normal)| opposes(normal, away))
    }
}

fn is_apart(contact: &TriangleSurfaceContact) -> bool {
    contact.source == ContactSource::Triangles
}

fn opposes(normal: DVec3, away: DVec3) -> bool {
    normal.dot(away) < -SAME_SIDE
}
