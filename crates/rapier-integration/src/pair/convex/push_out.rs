//! Push-outs: contacts that move convex shapes out of solids
//! ([`SbbkConfig::convex_leave_solids`](crate::SbbkConfig::convex_leave_solids)).
//!
//! A contact with a triangle separates by the least translation. The least translation points
//! inward if more than half of the shape is inside. A push-out then replaces all contacts of the
//! part. It leads out through the face that is nearest to the middle of the part.

use glamx::DVec3;
use sbbk_core::contact::Feature;
use sbbk_core::contact::convex::ConvexContact;
use sbbk_core::surface::{SurfaceKind, area_vector};

use super::contact::{Hit, NormalSource, PartContact};
use super::pair::ConvexPair;
use super::query::{ConvexQuery, ConvexScratch, PlacedParts};
use crate::mesh::{BEHIND, LazySurface, is_covered};
use crate::pair::query::ContactList;

/// Least depth of a contact, in radii of the part, from which half of the part may be inside. The
/// middle of a cone is outside then. Higher: cones stay in solids; lower: more searches for the
/// nearest face.
const DEEP: f64 = 0.1;

impl<'q> ConvexQuery<'q> {
    /// Returns the push-out of a part, if more than half of the part is in the solid.
    /// `deepest` is the least distance of the part's contacts, without its radius.
    pub(super) fn push_out(
        &self,
        part: u32,
        deepest: f64,
        at_hand: &mut PlacedParts,
    ) -> Option<Hit> {
        let surface = self.left_surface()?;
        let mesh = self.pair.mesh.mesh;
        self.pair.parts.with(part, |shape| {
            let middle = shape.shape.middle()?;
            let placed = self.placed(part, &shape, at_hand);
            let from = placed.in_mesh(middle);
            let (radius, border) = (placed.extent.ball().radius, shape.shape.radius());
            let is_deep = deepest - f64::from(border) < -DEEP * f64::from(radius);
            if !is_deep && !is_covered(mesh, from) {
                return None;
            }
            let (triangle, _, behind) = surface.nearest(from)?;
            if behind.abs() < BEHIND || surface.kind() != SurfaceKind::Solid {
                return None;
            }
            let corners @ [a, ..] = placed.in_part(self.pair.mesh.corners(triangle));
            let normal = area_vector(&corners).try_normalize()?;
            let reach = |direction: DVec3| placed.extent.height_along(shape.shape, direction);
            let [above, below] = [reach(normal) - normal.dot(a), reach(-normal) + normal.dot(a)];
            if above >= below {
                return None;
            }
            let distance = f64::from(border) - below;
            // In line with the middle, so that nothing rotates.
            let on_shape = middle + (normal.dot(a - middle) + distance) * normal;
            let on_triangle = on_shape - distance * normal;
            let contact = ConvexContact { distance, normal, on_triangle, on_shape };
            let (feature, source) = (Feature::Face, NormalSource::PushOut);
            let of = self.pair.mesh_place.swap([triangle, part]);
            Some((of, PartContact { contact, feature, source }))
        })?
    }

    /// Returns the surface of the mesh if parts are to leave solids.
    fn left_surface(&self) -> Option<&LazySurface<'q>> {
        self.surface.as_ref().filter(|_| self.pair.config.leave_solids())
    }

    /// Replaces the contacts of each part that has a push-out.
    pub(super) fn add_push_outs(
        &self,
        contacts: &mut ContactList<PartContact>,
        scratch: &mut ConvexScratch,
    ) {
        if self.left_surface().is_none() {
            return;
        }
        let ConvexPair { parts, mesh_place, .. } = self.pair;
        let part_of = |(of, _): &Hit| mesh_place.swap(*of)[1];
        let ConvexScratch { at_hand, push_outs: (depths, pushed), .. } = scratch;
        depths.extend(contacts.iter().map(|hit| (part_of(hit), hit.1.contact.distance)));
        depths.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let anywhere = |_| true;
        parts.intersecting(&self.pair.mesh_box(0.0), anywhere, |part| {
            let first = depths.get(depths.partition_point(|(of, _)| *of < part));
            let own = first.filter(|(of, _)| *of == part);
            let deepest = own.map_or(f64::INFINITY, |(_, distance)| *distance);
            pushed.extend(self.push_out(part, deepest, at_hand));
        });
        pushed.sort_unstable_by_key(part_of);
        contacts.retain(|hit| pushed.binary_search_by_key(&part_of(hit), part_of).is_err());
        contacts.append(pushed);
        depths.clear();
        contacts.sort_unstable_by_key(|(subshapes, _)| *subshapes);
    }
}
