//! Triangles of a sheet that have passed another sheet.
//!
//! A solid tells for each contact if it leads outwards. A sheet has two sides, so the part of a sheet
//! beyond another one would be pushed farther. Triangles of that part hang together with triangles
//! that cross, and their contacts push against those of the crossing triangles.

use glamx::DVec3;
use rustc_hash::FxHashMap;
use sbbk_core::surface::HalfEdges;

use super::islands::SAME_SIDE;
use super::triangles::{ContactSource, TriangleSurfaceContact};
use super::update::ContactList;

/// Removes the contacts of triangles of shape `i` that have passed the other shape. `crossing` has
/// triangles of shape `i`, and the directions in which their contacts push.
pub(super) fn reject_passed(
    i: usize,
    surface: &impl HalfEdges,
    crossing: impl Iterator<Item = (u32, DVec3)>,
    contacts: &mut ContactList<TriangleSurfaceContact>,
) {
    let mut apart: FxHashMap<u32, Vec<DVec3>> = Default::default();
    let is_apart = |contact: &TriangleSurfaceContact| contact.source == ContactSource::Triangles;
    for (pair, contact) in contacts.iter().filter(|(_, contact)| is_apart(contact)) {
        apart.entry(pair[i]).or_default().push(contact.contact.normal);
    }
    let mut passed: FxHashMap<u32, DVec3> = Default::default();
    let mut open: Vec<(u32, DVec3)> = crossing.filter(|_| !apart.is_empty()).collect();
    let mut seeds = open.len();
    for at in 0.. {
        let Some(&(triangle, away)) = open.get(at) else { break };
        let is_seed = seeds > 0;
        seeds = seeds.saturating_sub(1);
        let has_passed =
            || apart.get(&triangle).is_some_and(|all| all.iter().any(|&n| opposes(n, away)));
        if passed.contains_key(&triangle) || !is_seed && !has_passed() {
            continue;
        }
        passed.insert(triangle, away);
        let twins = (0..3).filter_map(|edge| surface.twin(3 * triangle + edge));
        open.extend(twins.map(|half_edge| (half_edge / 3, away)));
    }
    contacts.retain(|(pair, contact)| {
        let away = passed.get(&pair[i]).filter(|_| is_apart(contact));
        away.is_none_or(|&away| !opposes(contact.contact.normal, away))
    });
}

fn opposes(normal: DVec3, away: DVec3) -> bool {
    normal.dot(away) < -SAME_SIDE
}
