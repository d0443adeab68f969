//! Contacts of a convex shape that are none of the surface: the triangle ends there, but the surface
//! does not.
//!
//! A body that slides over a floor meets the next triangle at its edge first, and would stumble; of a
//! ball that rolls, triangles beside the one below pull to the side. A triangle that has the same edge
//! or corner and is nearer, or deeper, tells:
//!
//! * Apart: the distance from a convex shape is a convex function on each triangle. So one that has the
//!   point and is nearer somewhere is nearer right beside the point, which is no local minimum.
//! * Crossing: the first triangle ends at the edge along the normal. If the second did so too, it could
//!   be parted by the same translation and would be no deeper. So it goes on beyond.
//!
//! The contact is then one along the normal of the nearest triangle there. If the same is true of that
//! one, of the nearest there, and so on: each is nearer than the one before, so there is an end. A tip of the
//! shape that crosses right at an edge can be nearer to the outside of both triangles than to that of the
//! surface. So where the last triangle, or another one at the same edge, goes on beyond the contact along its
//! normal, the normal is that of the face of this triangle or of one beside it, whichever has points at which
//! the bodies cross. Beside the border of a mesh none may have.
//!
//! Neighbours are told by their corners: nothing need be known of the mesh, and vertices need not be
//! shared. (`FIX_INTERNAL_EDGES` needs a normal for each vertex and edge.)

use glamx::{DVec3, Vec3};
use rustc_hash::FxHashMap;
use sbbk_core::contact::Feature;
use sbbk_core::contact::convex::ConvexContact;

/// Memory for the search.
#[derive(Default)]
pub(crate) struct Seams {
    known: Vec<Known>,
    touched: Vec<Touched>,
    /// Places in `asking`, by the name of the edge or corner.
    names: FxHashMap<u64, u32>,
    asking: Vec<Asking>,
    /// For each contact the one whose normal it takes.
    ends: Vec<u32>,
    found: Vec<Seam>,
}

/// A contact at an edge or a corner.
#[derive(Copy, Clone)]
struct Asking {
    contact: u32,
    /// The first that asks of the same edge or corner, by its place.
    first: u32,
    /// Of the first: the nearest contact there.
    nearest: (f64, u32),
    /// Of the first, once that is known: whether a triangle there goes on beyond it.
    is_passed: Option<bool>,
}

/// Distances that differ by less than this share of the size are equal: those of two triangles whose
/// common edge is nearest, after rounding. One of them would go, not always the same one.
const EQUAL: f64 = 1.0e-12;

/// A contact of a triangle and a convex shape.
pub(crate) struct Known {
    /// The part of the triangle that touches.
    pub(crate) feature: Feature,
    pub(crate) distance: f64,
    /// How far rounding may put it off.
    pub(crate) slack: f64,
    /// The point of the triangle, and the normal.
    pub(crate) place: [DVec3; 2],
}

impl Known {
    pub(crate) fn new(feature: Feature, contact: &ConvexContact) -> Self {
        let ConvexContact { distance, on_triangle, normal, .. } = *contact;
        let size = on_triangle.abs().max_element() + distance.abs();
        Self { feature, distance, slack: EQUAL * size, place: [on_triangle, normal] }
    }
}

/// What becomes of a contact, by its place in the list.
#[derive(Copy, Clone, Debug)]
pub(crate) enum Seam {
    /// It is along the normal of its triangle or of one beside it.
    Face(u32),
    /// It is as the second one, whose `Face` comes first if it has one.
    Like(u32, u32),
}

/// A contact, as far as its place goes: the part of the shape, and the triangle in the frame of the mesh.
pub(crate) struct Touched {
    pub(crate) part: u32,
    pub(crate) corners: [Vec3; 3],
}

impl Touched {
    /// The ends of an edge, or a corner twice.
    fn ends(&self, feature: Feature) -> [Vec3; 2] {
        let [a, b, c] = self.corners;
        match feature {
            Feature::Vertex(i) => [self.corners[usize::from(i)]; 2],
            Feature::Edge(1) => [b, c],
            Feature::Edge(2) => [c, a],
            Feature::Edge(_) | Feature::Face => [a, b],
        }
    }

    /// Names of its edges and corners: others may, but hardly do, have the same.
    fn names(&self) -> [(Feature, u64); 6] {
        const ODD: [u64; 3] = [0x9e37_79b9_7f4a_7c15, 0xc2b2_ae3d_27d4_eb4f, 0x1656_67b1_9e37_79f9];
        let corner = |corner: Vec3| {
            // Zero has two signs.
            let bits = (corner + 0.0).to_array().map(|x| u64::from(x.to_bits()));
            // Not zero at the origin: an edge from there would have the name of its other end.
            let name = (0..3).fold(!u64::from(self.part), |sum, i| {
                (sum ^ bits[i]).wrapping_mul(ODD[i]).rotate_left(29)
            });
            // Without, both diagonals of a cell of a lattice have the same sum.
            (0..2).fold(name, |name, i| (name ^ name >> 32).wrapping_mul(ODD[i]))
        };
        let [a, b, c] = self.corners;
        let [a, b, c] = [corner(a), corner(b), corner(c)];
        [
            (Feature::Vertex(0), a),
            (Feature::Vertex(1), b),
            (Feature::Vertex(2), c),
            (Feature::Edge(0), a.wrapping_add(b)),
            (Feature::Edge(1), b.wrapping_add(c)),
            (Feature::Edge(2), c.wrapping_add(a)),
        ]
    }

    /// Whether it has a corner with another triangle.
    pub(crate) fn meets(&self, other: &Self) -> bool {
        self.part == other.part && other.corners.iter().any(|corner| self.corners.contains(corner))
    }

    /// Whether it has an edge or a corner of another triangle.
    pub(crate) fn has(&self, other: &Self, feature: Feature) -> bool {
        self.part == other.part && other.ends(feature).iter().all(|end| self.corners.contains(end))
    }
}

/// So many contacts are looked through one by one. More: slower for round bodies on fine meshes.
const FEW: usize = 16;

impl Seams {
    /// The contacts of a list that are none of the surface. `known_of` tells what is [`Known`] of each,
    /// `is_beyond` whether the triangle of one goes on beyond another along the other's normal.
    pub(crate) fn find<C>(
        &mut self,
        contacts: &[C],
        known_of: impl Fn(&C) -> Known,
        touched_by: impl Fn(&C) -> Touched,
        mut is_beyond: impl FnMut(&C, &C) -> bool,
    ) -> &[Seam] {
        let Self { known, touched, names, asking, ends, found } = self;
        found.clear();
        if contacts.len() < 2 {
            return found;
        }
        known.clear();
        known.extend(contacts.iter().map(known_of));
        asking.clear();
        asking.extend((0..).zip(&*known).filter(|(_, known)| known.feature != Feature::Face).map(
            |(contact, known)| Asking {
                contact,
                first: 0,
                nearest: (known.distance, contact),
                is_passed: None,
            },
        ));
        if asking.is_empty() {
            return found;
        }
        touched.clear();
        touched.extend(contacts.iter().map(touched_by));
        let is_there = |asking: u32, other: u32| {
            touched[other as usize].has(&touched[asking as usize], known[asking as usize].feature)
        };
        let come_nearer = |asking: &mut Asking, other: u32| {
            let distance = known[other as usize].distance;
            if distance < asking.nearest.0 && is_there(asking.contact, other) {
                asking.nearest = (distance, other);
            }
        };
        let all = 0..contacts.len() as u32;
        if contacts.len() <= FEW {
            for (place, asking) in (0..).zip(&mut *asking) {
                asking.first = place;
                all.clone().for_each(|other| come_nearer(asking, other));
            }
        } else {
            names.clear();
            for place in 0..asking.len() {
                let contact = asking[place].contact;
                let feature = known[contact as usize].feature;
                let mut all = touched[contact as usize].names().into_iter();
                let name = all.find(|(part, _)| *part == feature).map_or(0, |(_, name)| name);
                let first = *names.entry(name).or_insert(place as u32);
                let is_same = is_there(asking[first as usize].contact, contact);
                asking[place].first = if is_same { first } else { place as u32 };
            }
            for (other, triangle) in (0..).zip(&*touched) {
                for (_, name) in triangle.names() {
                    if let Some(&first) = names.get(&name) {
                        come_nearer(&mut asking[first as usize], other);
                    }
                }
            }
        }
        ends.clear();
        ends.extend(all.clone());
        for i in 0..asking.len() {
            let Asking { contact, first, .. } = asking[i];
            let Asking { contact: of_first, nearest: (distance, nearest), is_passed, .. } =
                asking[first as usize];
            let Known { distance: own, slack, place, .. } = known[contact as usize];
            if distance < own - slack {
                ends[contact as usize] = nearest;
            } else if own < 0.0 {
                // All triangles at a corner that is deepest have it for their contact.
                let is_same = known[of_first as usize].place == place;
                let is_passed = is_passed.filter(|_| is_same).unwrap_or_else(|| {
                    let at = |contact: u32| &contacts[contact as usize];
                    let mut others = all.clone().filter(|&other| is_there(contact, other));
                    others.any(|other| is_beyond(at(other), at(contact)))
                });
                if is_same {
                    asking[first as usize].is_passed = Some(is_passed);
                }
                if is_passed {
                    found.push(Seam::Face(contact));
                }
            }
        }
        for &Asking { contact, .. } in &*asking {
            let mut end = ends[contact as usize];
            while ends[end as usize] != end {
                end = ends[end as usize];
            }
            // The way is shorter for those after it.
            ends[contact as usize] = end;
            if end != contact {
                found.push(Seam::Like(contact, end));
            }
        }
        found
    }

    pub(super) fn shrink_to(&mut self, limit: usize) {
        self.known.shrink_to(limit);
        self.touched.shrink_to(limit);
        self.names.shrink_to(limit);
        self.asking.shrink_to(limit);
        self.ends.shrink_to(limit);
        self.found.shrink_to(limit);
    }
}
