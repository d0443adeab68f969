//! Ghost contacts: contacts of a convex shape at internal edges and vertices of a mesh.
//!
//! A body that slides over a floor touches the next triangle at its edge first, and would stumble.
//! Triangles beside the one below pull a rolling ball to the side. Another triangle with the same
//! edge or vertex that is nearer, or deeper, shows a ghost:
//!
//! * Apart: the distance to a convex shape is a convex function on each triangle. A triangle that
//!   is nearer somewhere is nearer right beside the common point, which is then no local minimum.
//! * Crossing: the triangle of the ghost ends at the edge along the normal. The deeper triangle
//!   extends beyond: else the same translation would separate it, too.
//!
//! A ghost takes the normal of the nearest triangle at its edge or vertex. The nearest contact may
//! be a ghost as well. Distances fall along this chain, so the chain ends.
//!
//! The tip of a crossing shape may be less deep behind both triangles at an edge than in the solid.
//! This is so if a triangle at the edge extends beyond the contact along its normal. The contact
//! then takes the normal of a face nearby that the shape crosses, if there is one.
//!
//! A thin shape that cuts a sharp edge has its end far from the planes of both faces. If the mesh
//! is a solid, the way out of the wedge behind both planes counts where it is less deep. A sheet
//! has no body behind its triangles.
//!
//! A shape that stands at the foot of a wall has sunk into the floor, and is nearest to the edge
//! between both. The wall then keeps a contact with its own normal, if the shape touches the wall
//! once the floor has lifted it.
//!
//! [Borders](crate::pair::borders) of the mesh are met as their faces are.
//!
//! Triangles are neighbours if their corners are equal; meshes need no shared vertices. A contact
//! that no such neighbour explains is compared with all triangles at its point
//! ([`strays`](sbbk_core::surface::strays)).

use std::collections::HashMap;
use std::f64::consts::FRAC_1_SQRT_2;

use glamx::{DVec3, Vec3};
use sbbk_core::contact::Feature;
use sbbk_core::contact::convex::ConvexContact;

use super::contact::{Hit, PartContact};

/// Share of the size by which two distances must differ to count as different. Higher: ghosts stay,
/// and corners of rounded features replace exact points. Lower: rounding picks one of two equal
/// contacts at a common edge as the ghost.
pub(super) const ROUNDED: f64 = 1.0e-12;

/// Number of contacts at a corner up to which all are looked at for each other. Edges with more at
/// both ends have a [`Place`]. Higher: slow at the hub of a fan. Lower: walls are ghosts where many
/// triangles meet.
const MANY: usize = 64;

/// Memory for the search: the contacts by the corners of their triangles.
#[derive(Default)]
pub(crate) struct GhostContacts {
    /// Key of a corner, contact, and number of the corner in the contact's triangle; sorted.
    entries: Vec<u128>,
    corners: Vec<Corner>,
    /// Edges with many triangles at both ends, by their corners.
    edges: HashMap<[u32; 2], Place>,
    /// Indices of the corners of each contact's triangle.
    triangles: Vec<[u32; 3]>,
    /// For each contact the one whose normal it takes.
    pub(super) sources: Vec<u32>,
    /// Contacts that a triangle extends beyond. They may take the normal of a face.
    pub(super) exceeded: Vec<u32>,
    /// Contacts at borders of the mesh. Some take the normals of their faces.
    pub(super) borders: Vec<u32>,
    /// Contacts at borders that take the normals of the faces, in their order.
    pub(super) upright: Vec<UprightContact>,
    /// Contacts that share a corner with the one at hand.
    pub(super) nearby: Vec<u32>,
    /// Contacts in the [strays](Strays) of corners, then of the last contact at an edge.
    strays: Vec<u32>,
    /// Number of strays of corners.
    kept_strays: u32,
    /// Contacts with walls beside a shape that stands on the floor at their foot, along the normals
    /// of the walls.
    pub(super) walls: Vec<(u32, ConvexContact)>,
}

/// A contact at a border, along the normal of the face.
pub(super) struct UprightContact {
    /// Index among the contacts.
    pub(super) index: u32,
    pub(super) contact: ConvexContact,
    /// The normal in axes that all parts share.
    pub(super) shared_normal: DVec3,
    /// True if the contact leads [past the border](crate::pair::borders::is_past_border), and does
    /// not count.
    pub(super) is_past: bool,
}

struct Corner {
    /// First of [`GhostContacts::entries`]. The next corner's first one is the end.
    start: u32,
    place: Place,
}

/// Knowledge about the contacts at a vertex, or at an edge of many triangles.
#[derive(Default)]
struct Place {
    /// The contact with the least distance.
    nearest: u32,
    /// A contact here, and the result of `is_exceeded` for it.
    exceeded: Option<(u32, bool)>,
    /// Strays of the first contact here that had to know.
    strays: Option<Strays>,
    /// True if a triangle has an edge here that no other contact has.
    is_border: Option<bool>,
}

/// Contacts of other triangles at the point of a contact.
#[derive(Copy, Clone)]
struct Strays {
    /// Start and end in [`GhostContacts::strays`].
    range: [u32; 2],
    /// The stray with the least distance, or the contact itself.
    nearest: u32,
    /// True if a stray shares no corner with the contact.
    are_apart: bool,
}

/// Returns a hash of a part and a corner. Corners that differ in x or y alone never collide.
pub(super) fn corner_key(part: u32, corner: Vec3) -> u64 {
    // Plus zero: zero has two signs.
    let [x, y, z] = (corner + 0.0).to_array().map(|x| u64::from(x.to_bits()));
    let mix = |x: u64| x ^ x >> 32;
    let xy = mix((x << 32 | y).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    mix((xy ^ (u64::from(part) << 32 | z)).wrapping_mul(0xc2b2_ae3d_27d4_eb4f))
}

/// Returns the contact of an entry.
fn contact_of(entry: u128) -> u32 {
    (entry >> 8) as u32
}

/// Returns the distance of a contact.
fn distance(contacts: &[Hit], index: u32) -> f64 {
    contacts[index as usize].1.contact.distance
}

/// Returns the contact with the least distance: `first`, or one of some others.
fn nearest_of(contacts: &[Hit], first: u32, others: impl IntoIterator<Item = u32>) -> u32 {
    let is_nearer = |a: u32, b: u32| distance(contacts, b) < distance(contacts, a);
    others.into_iter().fold(first, |a, b| if is_nearer(a, b) { b } else { a })
}

/// Returns true if two contacts have the same place and normal, up to rounding.
fn are_same(a: &ConvexContact, b: &ConvexContact) -> bool {
    let size = a.on_triangle.abs().max_element();
    a.on_triangle.distance(b.on_triangle) <= ROUNDED * size
        && a.normal.distance(b.normal) <= ROUNDED
}

/// Returns false if no two contacts have normals more than a right angle apart.
fn push_apart(contacts: &[Hit]) -> bool {
    let mut normals = contacts.iter().map(|(_, hit)| hit.contact.normal);
    let Some(first) = normals.next() else { return false };
    normals.any(|normal| first.dot(normal) < FRAC_1_SQRT_2 + ROUNDED)
}

/// Returns the corners of an edge, or a vertex twice.
fn ends(feature: Feature) -> [usize; 2] {
    match feature {
        Feature::Vertex(i) => [i.into(); 2],
        Feature::Edge(i) => [i.into(), (usize::from(i) + 1) % 3],
        Feature::Face => [0, 1],
    }
}

impl GhostContacts {
    /// Finds the contacts that may take another normal: [`exceeded`](Self::exceeded),
    /// [`sources`](Self::sources), [`borders`](Self::borders) and [`walls`](Self::walls).
    ///
    /// `keys` returns the corners of a contact's triangle. `extends_beyond(a, b)` is true if the
    /// triangle of contact `a` extends beyond contact `b` along the normal of `b`. `find_strays`
    /// adds the contacts of triangles at the point of a contact. `find_wall` returns the contact of
    /// a wall whose foot a nearer contact is.
    pub(super) fn find(
        &mut self,
        contacts: &[Hit],
        keys: impl Fn([u32; 2]) -> [u64; 3],
        mut extends_beyond: impl FnMut([u32; 2], &ConvexContact) -> bool,
        mut find_strays: impl FnMut(&Hit, &mut Vec<u32>),
        mut find_wall: impl FnMut([u32; 2], &Hit) -> Option<ConvexContact>,
    ) {
        self.begin(contacts, keys);
        let may_have_walls = push_apart(contacts);
        for (contact, (_, PartContact { contact: own, feature, .. })) in (0..).zip(contacts) {
            if *feature == Feature::Face {
                continue;
            }
            let size = own.on_triangle.abs().max_element() + own.distance.abs();
            let is_nearer = |other: u32| distance(contacts, other) < own.distance - ROUNDED * size;
            let mut nearest = self.nearest(contacts, contact, *feature);
            let mut range = [0; 2];
            if !is_nearer(nearest) {
                let strays = self.strays_of(contacts, contact, &mut find_strays);
                nearest = nearest_of(contacts, nearest, [strays.nearest]);
                if !strays.are_apart && self.is_border(contacts, contact, *feature) {
                    self.borders.push(contact);
                }
                range = strays.range;
            }
            let find_wall = || self.wall(contacts, contact, range, &mut find_wall);
            if let Some(wall) = may_have_walls.then(find_wall).flatten() {
                self.walls.push((contact, wall));
            } else if is_nearer(nearest) {
                self.sources[contact as usize] = nearest;
            } else if own.distance < 0.0
                && self.is_exceeded(contacts, contact, range, &mut extends_beyond)
            {
                self.exceeded.push(contact);
            }
        }
        self.follow_sources();
    }

    /// Returns the contact of a wall if a contact at the same feature, or a stray, is of its floor.
    /// A contact at the foot of a wall leads into the floor.
    fn wall(
        &self,
        contacts: &[Hit],
        contact: u32,
        strays: [u32; 2],
        find_wall: &mut impl FnMut([u32; 2], &Hit) -> Option<ConvexContact>,
    ) -> Option<ConvexContact> {
        let (of, PartContact { contact: own, feature, .. }) = &contacts[contact as usize];
        let others = self.at_feature(contact, *feature).chain(self.strays_in(strays));
        let others = others.take(MANY).map(|other| &contacts[other as usize]);
        let mut floors = others.filter(|(_, it)| it.contact.normal.dot(own.normal) < 0.0);
        floors.find_map(|floor| find_wall(*of, floor))
    }

    /// Replaces each source by the last one of its chain.
    fn follow_sources(&mut self) {
        for contact in 0..self.sources.len() {
            let mut source = self.sources[contact];
            while self.sources[source as usize] != source {
                source = self.sources[source as usize];
            }
            // Shortens the chains of later contacts.
            self.sources[contact] = source;
        }
    }

    /// Forgets the last contacts, and lists the new ones of each corner.
    fn begin(&mut self, contacts: &[Hit], keys: impl Fn([u32; 2]) -> [u64; 3]) {
        self.kept_strays = 0;
        self.walls.clear();
        self.exceeded.clear();
        self.borders.clear();
        self.sources.clear();
        self.sources.extend(0..contacts.len() as u32);
        let Self { entries, corners, edges, triangles, .. } = self;
        entries.clear();
        for (contact, (of, _)) in (0..).zip(contacts) {
            let corners = (0..).zip(keys(*of));
            entries.extend(corners.map(|(i, key)| u128::from(key) << 64 | contact << 8 | i));
        }
        entries.sort_unstable();
        corners.clear();
        edges.clear();
        triangles.clear();
        triangles.resize(contacts.len(), [0; 3]);
        let mut last_key = None;
        for (start, &entry) in (0..).zip(&*entries) {
            let nearest = contact_of(entry);
            if last_key.replace(entry >> 64) != Some(entry >> 64) {
                corners.push(Corner { start, place: Place { nearest, ..Place::default() } });
            }
            let corner = corners.len() - 1;
            triangles[nearest as usize][usize::from(entry as u8)] = corner as u32;
            let known = &mut corners[corner].place.nearest;
            *known = nearest_of(contacts, *known, [nearest]);
        }
    }

    /// Returns the contacts whose triangles have a corner.
    fn at_corner(&self, corner: u32) -> impl ExactSizeIterator<Item = u32> {
        let corners = &self.corners[corner as usize..];
        let end = corners.get(1).map_or(self.entries.len(), |next| next.start as usize);
        self.entries[corners[0].start as usize..end].iter().map(|&entry| contact_of(entry))
    }

    /// Returns the contacts whose triangles have the feature of a contact, itself included.
    fn at_feature(&self, contact: u32, feature: Feature) -> impl Iterator<Item = u32> {
        let [a, b] = ends(feature).map(|end| self.triangles[contact as usize][end]);
        let [of_a, of_b] = [a, b].map(|corner| self.at_corner(corner));
        let (shorter, other) = if of_a.len() <= of_b.len() { (of_a, b) } else { (of_b, a) };
        let has_other = move |contact: &u32| self.triangles[*contact as usize].contains(&other);
        shorter.filter(has_other)
    }

    /// Returns true if many contacts are at each end of an edge.
    fn are_many(&self, ends: [u32; 2]) -> bool {
        ends.iter().all(|&end| self.at_corner(end).len() > MANY)
    }

    /// Returns the place of a contact, unless it is at an edge of few triangles.
    fn place(&mut self, contacts: &[Hit], contact: u32, feature: Feature) -> Option<&mut Place> {
        let ends = ends(feature).map(|end| self.triangles[contact as usize][end]);
        if let Feature::Vertex(_) = feature {
            return Some(&mut self.corners[ends[0] as usize].place);
        }
        if !self.are_many(ends) {
            return None;
        }
        let key = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        if !self.edges.contains_key(&key) {
            let nearest = nearest_of(contacts, contact, self.at_feature(contact, feature));
            self.edges.insert(key, Place { nearest, ..Place::default() });
        }
        self.edges.get_mut(&key)
    }

    /// Returns the contact with the least distance at the feature of a contact.
    fn nearest(&mut self, contacts: &[Hit], contact: u32, feature: Feature) -> u32 {
        match self.place(contacts, contact, feature) {
            Some(place) => place.nearest,
            None => nearest_of(contacts, contact, self.at_feature(contact, feature)),
        }
    }

    /// Finds the strays of a contact. All contacts at a [`Place`] have the same strays.
    fn strays_of(
        &mut self,
        contacts: &[Hit],
        contact: u32,
        find_strays: &mut impl FnMut(&Hit, &mut Vec<u32>),
    ) -> Strays {
        let hit = &contacts[contact as usize];
        let place = self.place(contacts, contact, hit.1.feature);
        if let Some(strays) = place.and_then(|place| place.strays) {
            return strays;
        }
        let start = self.kept_strays;
        self.strays.truncate(start as usize);
        find_strays(hit, &mut self.strays);
        let range = [start, self.strays.len() as u32];
        let ends = ends(hit.1.feature).map(|end| self.triangles[contact as usize][end]);
        let is_apart =
            |other: u32| !ends.iter().any(|end| self.triangles[other as usize].contains(end));
        let nearest = nearest_of(contacts, contact, self.strays_in(range));
        let strays = Strays { range, nearest, are_apart: self.strays_in(range).any(is_apart) };
        if let Some(place) = self.place(contacts, contact, hit.1.feature) {
            place.strays = Some(strays);
            self.kept_strays = range[1];
        }
        strays
    }

    /// Returns the contacts in the range of [`Strays`].
    fn strays_in(&self, [start, end]: [u32; 2]) -> impl Iterator<Item = u32> {
        self.strays[start as usize..end as usize].iter().copied()
    }

    /// Returns true if an edge is of one triangle only, or a vertex at the end of such an edge.
    fn is_border(&mut self, contacts: &[Hit], contact: u32, feature: Feature) -> bool {
        let place = self.place(contacts, contact, feature);
        if let Some(is_border) = place.and_then(|place| place.is_border) {
            return is_border;
        }
        let is_single = |of: u32, edge: Feature| self.at_feature(of, edge).nth(1).is_none();
        let is_border = if let Feature::Vertex(i) = feature {
            let corner = self.triangles[contact as usize][usize::from(i)];
            let has_border = |of: u32| {
                let corners = self.triangles[of as usize];
                let edges = (0..3_u8).filter(|&i| {
                    [i, (i + 1) % 3].iter().any(|&end| corners[usize::from(end)] == corner)
                });
                edges.into_iter().any(|i| is_single(of, Feature::Edge(i)))
            };
            self.at_corner(corner).any(has_border)
        } else {
            is_single(contact, feature)
        };
        if let Some(place) = self.place(contacts, contact, feature) {
            place.is_border = Some(is_border);
        }
        is_border
    }

    /// Returns true if a triangle at the feature of a contact extends beyond it along its normal.
    fn is_exceeded(
        &mut self,
        contacts: &[Hit],
        contact: u32,
        strays: [u32; 2],
        extends_beyond: &mut impl FnMut([u32; 2], &ConvexContact) -> bool,
    ) -> bool {
        let PartContact { contact: ref own, feature, .. } = contacts[contact as usize].1;
        // All triangles at a place that is deepest have the same contact.
        let place = self.place(contacts, contact, feature);
        if let Some((other, is_exceeded)) = place.and_then(|place| place.exceeded)
            && are_same(own, &contacts[other as usize].1.contact)
        {
            return is_exceeded;
        }
        let is_exceeded = self
            .at_feature(contact, feature)
            .chain(self.strays_in(strays))
            .any(|other| extends_beyond(contacts[other as usize].0, own));
        if let Some(place) = self.place(contacts, contact, feature) {
            place.exceeded = Some((contact, is_exceeded));
        }
        is_exceeded
    }

    /// Lists a contact and then others whose triangles share a corner with its triangle: up to
    /// [`MANY`] at each corner and edge.
    pub(super) fn list_nearby(&mut self, contact: u32) {
        let mut nearby = std::mem::take(&mut self.nearby);
        nearby.clear();
        let corners = self.triangles[contact as usize];
        for i in 0..3 {
            nearby.extend(self.at_corner(corners[i]).take(MANY));
            // The list of an end without many contacts has all at the edge.
            if self.are_many([corners[i], corners[(i + 1) % 3]]) {
                nearby.extend(self.at_feature(contact, Feature::Edge(i as u8)).take(MANY));
            }
        }
        nearby.sort_unstable_by_key(|&other| (other != contact, other));
        nearby.dedup();
        self.nearby = nearby;
    }
}

#[cfg(test)]
mod tests;
