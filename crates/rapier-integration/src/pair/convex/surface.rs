//! Which contacts of a mesh and convex shapes are those of the surface: none at edges within it.

use sbbk_core::contact::convex::ConvexContact;

use super::pair::ConvexPair;
use super::query::ConvexQuery;
use super::touch::{Along, Touch};
use crate::pair::driver::Scratch;
use crate::pair::seams::{Known, Seam, Touched};

impl ConvexQuery<'_> {
    /// Turns contacts that are none of the surface. `subshapes` has triangle and part of each.
    pub(super) fn turn(
        &self,
        contacts: &mut [(u32, Touch)],
        subshapes: impl Fn(u32) -> [u32; 2],
        scratch: &mut Scratch,
    ) {
        let ConvexPair { ref mesh, has_surfaces, .. } = *self.pair;
        // Soft bodies need each triangle, and cones turn normals in their own way.
        if !has_surfaces || self.has_cones() || !mesh.is_rigid() {
            return;
        }
        let mut seams = std::mem::take(&mut scratch.seams);
        let known = |(_, touch): &(u32, Touch)| Known::new(touch.feature, &touch.contact);
        let touched = |&(of, _): &(u32, Touch)| {
            let [triangle, part] = subshapes(of);
            Touched { part, corners: mesh.corners(triangle) }
        };
        let is_beyond = |&(of, _): &(u32, Touch), (_, other): &(u32, Touch)| {
            let [triangle, part] = subshapes(of);
            let mut is_beyond = false;
            self.ask(triangle, part, scratch, |question| {
                is_beyond = question.is_beyond(&other.contact);
            });
            is_beyond
        };
        for &seam in seams.find(contacts, known, touched, is_beyond) {
            let (contact, along) = match seam {
                Seam::Face(contact) => {
                    // What is deepest may be over a triangle beside it, or hang over the border.
                    let own = touched(&contacts[contact as usize]);
                    let beside = contacts.iter().filter(|other| touched(other).meets(&own));
                    let mut along = None;
                    for &(of, _) in [contacts[contact as usize]].iter().chain(beside) {
                        let [triangle, part] = subshapes(of);
                        self.ask(triangle, part, scratch, |question| {
                            let face = question.of_face();
                            along = face.filter(|face| question.is_crossing(face));
                        });
                        if along.is_some() {
                            break;
                        }
                    }
                    (contact, along)
                }
                Seam::Like(contact, end) => {
                    let [own, end] = [contact, end].map(|i| contacts[i as usize].1.contact);
                    // Along its own normal it stays what it is, and patches need not make its points to
                    // know how deep they are: of heads on a flat floor half of the contacts.
                    (contact, Some(end).filter(|end| own.normal != end.normal))
                }
            };
            let (_, touch) = &mut contacts[contact as usize];
            if let Some(along) = along {
                let on_triangle = touch.contact.on_triangle;
                touch.contact = ConvexContact { on_triangle, ..along };
                touch.along = Along::Other;
            }
        }
        scratch.seams = seams;
    }
}
