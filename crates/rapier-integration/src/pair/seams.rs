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
//! one, of the nearest there, and so on: each is nearer than the one before, so there is an end. A tip
//! that crosses right at an edge can be parted from both triangles by less than from the surface. So if
//! at the end a triangle goes on beyond, the normal is that of the face, or of a face beside it, whichever
//! has points at which the bodies cross. Beside the border of a mesh none may have.
//!
//! Neighbours are told by their corners: nothing need be known of the mesh, and vertices need not be
//! shared. (`FIX_INTERNAL_EDGES` needs a normal for each vertex and edge.)

use glamx::Vec3;
use rustc_hash::FxHashMap;
use sbbk_core::contact::Feature;
use sbbk_core::contact::convex::ConvexContact;

/// Memory for the search.
#[derive(Default)]
pub(crate) struct Seams {
    known: Vec<Known>,
    /// The edges and corners where contacts are, by number.
    places: FxHashMap<Place, u32>,
    /// Contacts at an edge or a corner, and its number.
    asking: Vec<(u32, u32)>,
    /// Edges and corners, and the contacts of triangles that have them, in order.
    around: Vec<(u32, u32)>,
    /// For each contact the one whose normal it takes.
    ends: Vec<u32>,
    found: Vec<Seam>,
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
}

impl Known {
    pub(crate) fn new(feature: Feature, contact: &ConvexContact) -> Self {
        let ConvexContact { distance, on_triangle, .. } = *contact;
        let size = on_triangle.abs().max_element() + distance.abs();
        Self { feature, distance, slack: EQUAL * size }
    }

    /// Of a triangle that has no contact: it has no part in this.
    pub(crate) const NONE: Self =
        Self { feature: Feature::Face, distance: f64::INFINITY, slack: 0.0 };
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

/// The part of a shape, and the ends of an edge, in order, or a corner twice.
type Place = (u32, [[u32; 3]; 2]);

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

    fn place(&self, feature: Feature) -> Place {
        // Zero has two signs.
        let mut ends = self.ends(feature).map(|end| (end + 0.0).to_array().map(f32::to_bits));
        ends.sort_unstable();
        (self.part, ends)
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
        touched: impl Fn(&C) -> Touched,
        mut is_beyond: impl FnMut(&C, &C) -> bool,
    ) -> &[Seam] {
        let Self { known, places, asking, around, ends, found } = self;
        found.clear();
        if contacts.len() < 2 {
            return found;
        }
        asking.clear();
        around.clear();
        known.clear();
        known.extend(contacts.iter().map(known_of));
        let features = known.iter().map(|known| known.feature).zip(0..).zip(contacts);
        let asks = features.filter(|((feature, _), _)| *feature != Feature::Face);
        if contacts.len() <= FEW {
            for (number, ((feature, contact), of)) in (0..).zip(asks) {
                asking.push((contact, number));
                let own = touched(of);
                let others =
                    (0..).zip(contacts).filter(|(_, other)| touched(other).has(&own, feature));
                around.extend(others.map(|(other, _)| (number, other)));
            }
        } else {
            places.clear();
            for ((feature, contact), of) in asks {
                let number = places.len() as u32;
                let number = *places.entry(touched(of).place(feature)).or_insert(number);
                asking.push((contact, number));
            }
            if asking.is_empty() {
                return found;
            }
            for (contact, of) in (0..).zip(contacts) {
                let triangle = touched(of);
                let features = (0..3).flat_map(|i| [Feature::Edge(i), Feature::Vertex(i)]);
                let numbers = features.filter_map(|feature| places.get(&triangle.place(feature)));
                around.extend(numbers.map(|&number| (number, contact)));
            }
            around.sort_unstable();
        }
        if asking.is_empty() {
            return found;
        }
        let at = |number: u32| {
            let start = around.partition_point(|&(other, _)| other < number);
            let at = around[start..].iter().take_while(move |&&(other, _)| other == number);
            at.map(|&(_, contact)| contact)
        };
        let distance = |contact: u32| known[contact as usize].distance;
        ends.clear();
        ends.extend(0..contacts.len() as u32);
        for &(contact, number) in &*asking {
            let nearest = at(number).min_by(|&a, &b| distance(a).total_cmp(&distance(b)));
            let Known { distance: own, slack, .. } = known[contact as usize];
            if let Some(nearest) = nearest.filter(|&nearest| distance(nearest) < own - slack) {
                ends[contact as usize] = nearest;
            }
        }
        for &(contact, number) in &*asking {
            let is_end = ends[contact as usize] == contact && distance(contact) < 0.0;
            let own = &contacts[contact as usize];
            if is_end && at(number).any(|other| is_beyond(&contacts[other as usize], own)) {
                found.push(Seam::Face(contact));
            }
        }
        for &(contact, _) in &*asking {
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
        self.places.shrink_to(limit);
        self.asking.shrink_to(limit);
        self.around.shrink_to(limit);
        self.ends.shrink_to(limit);
        self.found.shrink_to(limit);
    }
}
