//! Convex shapes that are deep in a solid, if a host wants them to be led out
//! ([`SbbkConfig::convex_leave_solids`](crate::SbbkConfig::convex_leave_solids)).
//!
//! A triangle parts from a convex shape by the least translation, whichever way that leads: while more
//! than half of the shape is out along the normal of the triangle it leads outward, and inward from there
//! on. Then one contact takes the place of all: out by the face that is nearest to the middle.

use glamx::DVec3;
use sbbk_core::contact::Feature;
use sbbk_core::contact::convex::ConvexContact;

use super::pair::ConvexPair;
use super::query::ConvexQuery;
use super::touch::{Along, Touch};
use crate::mesh::{BEHIND, is_covered, nearest};
use crate::pair::driver::{ContactList, Scratch};
use crate::pair::order::{Candidate, push_candidate};

/// The depth of a contact, as a share of the radius of the part, from which on half of the part may be
/// inside though its middle is not: that of a cone is a third of its height over the base.
const DEEP: f64 = 0.1;

impl ConvexQuery<'_> {
    /// If a part is in the solid by more than half: its way out, and the triangle that it leads to.
    /// `deepest` is the least distance of its contacts without its radius.
    pub(super) fn way_out(
        &self,
        part: u32,
        deepest: f64,
        scratch: &mut Scratch,
    ) -> Option<(u32, Touch)> {
        let surface = self.surface.as_ref()?;
        let mesh = self.pair.mesh.mesh;
        self.pair.parts.with(part, |shape| {
            let middle = shape.shape.middle()?;
            let placed = self.placed(part, &shape, scratch);
            let from = placed.at_mesh(middle);
            let (radius, border) = (placed.extent.ball().radius, shape.shape.radius());
            let is_deep = deepest - f64::from(border) < -DEEP * f64::from(radius);
            if !is_deep && !is_covered(mesh, from) {
                return None;
            }
            let (triangle, _, behind) = nearest(mesh, from)?;
            if behind.abs() < BEHIND || !surface.around(mesh).is_solid {
                return None;
            }
            let [a, b, c] = placed.corners(&mesh.triangle(triangle));
            let normal = (b - a).cross(c - a).try_normalize()?;
            let reach = |direction: DVec3| placed.extent.reach(shape.shape, direction);
            let [above, below] = [reach(normal) - normal.dot(a), reach(-normal) + normal.dot(a)];
            if above >= below {
                return None;
            }
            let distance = f64::from(border) - below;
            // In line with the middle: nothing turns.
            let on_shape = middle + (normal.dot(a - middle) + distance) * normal;
            let on_triangle = on_shape - distance * normal;
            let contact = ConvexContact { distance, normal, on_triangle, on_shape };
            Some((triangle, Touch { contact, feature: Feature::Face, along: Along::WayOut }))
        })?
    }

    /// Makes the ways out of parts that are in the solid their only contacts.
    pub(super) fn lead_out(
        &self,
        candidates: &mut Vec<Candidate<()>>,
        contacts: &mut ContactList<Touch>,
        scratch: &mut Scratch,
    ) {
        if self.surface.is_none() {
            return;
        }
        let ConvexPair { parts, mesh_place, .. } = self.pair;
        parts.meeting(&self.pair.mesh_box(0.0), |part| {
            let is_of_it = |of: u32| mesh_place.swap(candidates[of as usize].subshapes)[1] == part;
            let distances = contacts.iter().filter(|(of, _)| is_of_it(*of));
            let distances = distances.map(|(_, touch)| touch.contact.distance);
            let deepest = distances.fold(f64::INFINITY, f64::min);
            let Some((triangle, touch)) = self.way_out(part, deepest, scratch) else { return };
            contacts.retain(|(of, _)| !is_of_it(*of));
            let of = push_candidate(candidates, mesh_place.swap([triangle, part]));
            contacts.push((of, touch));
        });
    }
}
