//! Corrects the contacts of a query at internal edges and at borders. [Ghosts](super::ghosts) take
//! the normals of other contacts. Contacts at borders take the normals of their faces.

use std::cell::RefCell;

use glamx::Vec3;
use sbbk_core::contact::Feature;
use sbbk_core::contact::convex::ConvexContact;
use sbbk_core::surface::strays::{self, touches};
use sbbk_core::surface::{Around, Side, SurfaceKind};

use super::contact::{Hit, NormalSource, PartContact};
use super::ghosts::{GhostContacts, UprightContact, corner_key};
use super::query::{ConvexQuery, PlacedParts};
use crate::mesh::box_between;
use crate::pair::borders::lead_one_way;

/// Lists of contacts up to this length are searched linearly.
const LINEAR_SEARCH: usize = 64;

impl ConvexQuery<'_> {
    /// Calls `found` with the contacts of other triangles within `seam` of a place on the mesh.
    pub(super) fn strays_at(
        &self,
        contacts: &[Hit],
        of: [u32; 2],
        place: Vec3,
        seam: f64,
        mut found: impl FnMut(u32),
    ) {
        let [triangle, part] = self.pair.mesh_place.swap(of);
        let touches = |other: u32| {
            let corners = self.pair.mesh.corners(other).map(|corner| corner.as_dvec3());
            // A triangle that is a point has no seam of its own.
            let seam = if seam > 0.0 { seam } else { strays::seam(&corners) };
            other != triangle && touches(&corners, [place.as_dvec3(); 2], seam)
        };
        if contacts.len() <= LINEAR_SEARCH {
            for (index, (other, _)) in (0..).zip(contacts) {
                let [other, of_part] = self.pair.mesh_place.swap(*other);
                if of_part == part && touches(other) {
                    found(index);
                }
            }
            return;
        }
        let near = box_between([place.as_dvec3() - seam, place.as_dvec3() + seam]);
        let bvh = self.pair.mesh.mesh.bvh();
        for other in bvh.intersect_aabb(&near).filter(|&other| touches(other)) {
            let other = self.pair.mesh_place.swap([other, part]);
            if let Ok(index) = contacts.binary_search_by_key(&other, |(of, _)| *of) {
                found(index as u32);
            }
        }
    }

    /// Replaces the normals of ghost contacts and of contacts at borders.
    pub(super) fn correct_ghosts(
        &self,
        contacts: &mut [Hit],
        at_hand: &mut PlacedParts,
        ghosts: &mut GhostContacts,
    ) {
        let is_at_border = |(_, contact): &Hit| contact.feature != Feature::Face;
        ghosts.upright.clear();
        if !self.pair.has_surface() || !contacts.iter().any(is_at_border) {
            return;
        }
        self.find_ghosts(ghosts, contacts, at_hand);
        for &(index, wall) in &ghosts.walls {
            contacts[index as usize].1.contact = wall;
        }
        self.turn_to_faces(ghosts, contacts, at_hand);
        self.turn_at_borders(ghosts, contacts, at_hand);
        for (contact, &source) in ghosts.sources.iter().enumerate() {
            let source = contacts[source as usize].1.contact;
            // Along its own normal a contact keeps its own points.
            if contacts[contact].1.contact.normal != source.normal {
                contacts[contact].1 = contacts[contact].1.with_normal_of(&source);
            }
        }
    }

    fn find_ghosts(&self, ghosts: &mut GhostContacts, contacts: &[Hit], at_hand: &mut PlacedParts) {
        let keys = |of: [u32; 2]| {
            let [triangle, part] = self.pair.mesh_place.swap(of);
            self.pair.mesh.corners(triangle).map(|corner| corner_key(part, corner))
        };
        let at_hand_of = RefCell::new(at_hand);
        let extends_beyond = |of: [u32; 2], contact: &ConvexContact| {
            let at_hand = &mut at_hand_of.borrow_mut();
            self.with_pair(of, at_hand, |pair| pair.extends_beyond(contact)).unwrap_or(false)
        };
        let find_strays = |(of, hit): &Hit, strays: &mut Vec<u32>| {
            let at_hand = &mut at_hand_of.borrow_mut();
            let place = self.with_pair(*of, at_hand, |pair| pair.touched_place(&hit.contact));
            if let Some((place, seam)) = place.flatten() {
                self.strays_at(contacts, *of, place, seam, |stray| strays.push(stray));
            }
        };
        let find_wall = |of: [u32; 2], (of_floor, floor): &Hit| {
            let [floor_triangle, _] = self.pair.mesh_place.swap(*of_floor);
            let of_floor = self.pair.mesh.corners(floor_triangle);
            let at_hand = &mut at_hand_of.borrow_mut();
            self.with_pair(of, at_hand, |pair| pair.wall_contact(&floor.contact, of_floor))?
        };
        ghosts.find(contacts, keys, extends_beyond, find_strays, find_wall);
    }

    /// Gives contacts at [borders](crate::pair::borders) the normals of their faces. Contacts that
    /// lead past a border do not count.
    fn turn_at_borders(
        &self,
        ghosts: &mut GhostContacts,
        contacts: &mut [Hit],
        at_hand: &mut PlacedParts,
    ) {
        let GhostContacts { borders, sources, upright, .. } = ghosts;
        for &index in borders.iter().filter(|&&i| sources[i as usize] == i) {
            let (of, hit) = &contacts[index as usize];
            let of_face = self.with_pair(*of, at_hand, |pair| pair.upright_at_border(&hit.contact));
            if let Some((contact, is_past)) = of_face.flatten()
                && self.is_border(*of, hit, at_hand)
            {
                let shared_normal = self.shared_normal(*of, &contact, at_hand);
                upright.push(UprightContact { index, contact, shared_normal, is_past });
            }
        }
        if !lead_one_way(upright.iter().map(|upright| upright.shared_normal)) {
            upright.clear();
        }
        for &UprightContact { index, contact, .. } in &*upright {
            let hit = &mut contacts[index as usize].1;
            *hit = PartContact { contact, source: NormalSource::Border, ..*hit };
        }
    }

    /// Returns true if the mesh ends at the feature of a contact, at which no other triangle has
    /// its edge. The other part of a T-junction may go on there.
    fn is_border(&self, of: [u32; 2], hit: &PartContact, at_hand: &mut PlacedParts) -> bool {
        let Some(surface) = &self.surface else { return true };
        let [triangle, _] = self.pair.mesh_place.swap(of);
        let place = self.with_pair(of, at_hand, |pair| pair.touched_place(&hit.contact)).flatten();
        let around = Around { facets: surface.facets(), side: Side::Sheet };
        place.is_none_or(|(place, _)| around.is_border(triangle, hit.feature, place.as_dvec3()))
    }

    /// Replaces contacts that a triangle [extends beyond](GhostContacts::exceeded) by the least
    /// deep way out of the triangle.
    fn turn_to_faces(
        &self,
        ghosts: &mut GhostContacts,
        contacts: &mut [Hit],
        at_hand: &mut PlacedParts,
    ) {
        for i in 0..ghosts.exceeded.len() {
            let exceeded = ghosts.exceeded[i];
            ghosts.list_nearby(exceeded);
            let (of, own) = contacts[exceeded as usize];
            let [_, part] = self.pair.mesh_place.swap(of);
            let is_crossing = |&other: &u32| contacts[other as usize].1.contact.distance < 0.0;
            let face = ghosts.nearby.iter().copied().filter(is_crossing).find_map(|other| {
                let of = contacts[other as usize].0;
                self.with_pair(of, at_hand, |pair| pair.face_contact_for(&own.contact))?
            });
            let Some(face) = face.map(|face| own.with_normal_of(&face)) else { continue };
            if contacts.len() <= LINEAR_SEARCH {
                // Thin shapes cross few triangles, which may be far from each other.
                let is_of_part =
                    |&other: &u32| self.pair.mesh_place.swap(contacts[other as usize].0)[1] == part;
                let all = 0..contacts.len() as u32;
                ghosts.nearby.extend(all.filter(is_of_part).filter(is_crossing));
            }
            contacts[exceeded as usize].1 =
                self.least_deep(ghosts, contacts, exceeded, face, at_hand);
        }
    }

    /// Returns the least deep way out of a triangle. Candidates are `face` and ways out of wedges
    /// of a solid.
    fn least_deep(
        &self,
        ghosts: &GhostContacts,
        contacts: &[Hit],
        exceeded: u32,
        face: PartContact,
        at_hand: &mut PlacedParts,
    ) -> PartContact {
        let (of, own) = contacts[exceeded as usize];
        let [_, part] = self.pair.mesh_place.swap(of);
        let hull = self.part_data.hull(part);
        let is_solid =
            || self.surface.as_ref().is_some_and(|known| known.kind() == SurfaceKind::Solid);
        let least = self.with_pair(of, at_hand, |pair| {
            let wedge = |&other: &u32| {
                let [triangle, _] = self.pair.mesh_place.swap(contacts[other as usize].0);
                let contact = pair.contact_of_wedge(self.pair.mesh.corners(triangle), hull)?;
                is_solid().then_some(PartContact { contact, ..own })
            };
            let is_deep = |way: &PartContact| way.contact.distance < 0.0;
            let less = |least: PartContact, way: PartContact| {
                if least.contact.distance < way.contact.distance { way } else { least }
            };
            ghosts.nearby.iter().filter_map(wedge).filter(is_deep).fold(face, less)
        });
        least.unwrap_or(face)
    }
}
