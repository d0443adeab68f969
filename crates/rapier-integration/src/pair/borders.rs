//! Contacts at the borders of meshes.
//!
//! A body that slides from one floor onto the next has sunk in a little, and would run into the
//! border of the next floor. So a border is met along the normal of its face by a body that is all
//! on one side of the face. Before the body touches the border, that way leads past it, and the
//! border has no contact.
//!
//! The rim of an open box has borders, too. A lid just fits between its walls: it is on the inner
//! side of each. But the normals of walls lead against each other, so no way is left, and the rim
//! carries the lid.

use glamx::DVec3;
use sbbk_core::contact::TriangleContact;

use super::query::ContactList;
use super::shapes::TriangleSurfaceContact;
use super::tuning::NEAR_NORMAL;

/// Returns true if the way along the normal of a face leads past its border. `distance`: to the
/// border. `cosine`: between the way to the border and the normal.
pub(super) fn is_past_border(distance: f64, cosine: f64) -> bool {
    distance > 0.0 && cosine < NEAR_NORMAL
}

/// Returns true if all normals of faces at borders lead to one side.
pub(super) fn lead_one_way(mut normals: impl Iterator<Item = DVec3> + Clone) -> bool {
    let sum: DVec3 = normals.clone().sum();
    normals.all(|normal| normal.dot(sum) > 0.0)
}

/// Gives contacts at borders the normals of the faces, if these lead one way, and returns true
/// then. Removes those that lead [past a border](is_past_border). Both lists have one order.
pub(super) fn meet_borders(
    upright: &ContactList<DVec3>,
    contacts: &mut ContactList<TriangleSurfaceContact>,
) -> bool {
    if !lead_one_way(upright.iter().map(|(_, normal)| *normal)) {
        return false;
    }
    let mut next = upright.iter().peekable();
    contacts.retain_mut(|(pair, TriangleSurfaceContact { contact, .. })| {
        let Some((_, normal)) = next.next_if(|(of, _)| of == pair) else { return true };
        let cosine = normal.dot(contact.normal);
        let distance = contact.distance * cosine.max(0.0);
        let (middle, half) = (contact.point1.midpoint(contact.point2), 0.5 * distance * normal);
        let (point1, point2) = (middle - half, middle + half);
        let is_past = is_past_border(contact.distance, cosine);
        *contact = TriangleContact { normal: *normal, distance, point1, point2, ..*contact };
        !is_past
    });
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Would catch rims that carry nothing, and bodies that run into the next floor.
    #[test]
    fn walls_around_a_body_lead_no_way() {
        let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
        let groove = [(x + y).normalize(), (y - x).normalize() + 0.1 * y];
        for (normals, expected) in [
            (&[y, y][..], true),
            (&groove, true),
            (&[x, y], true),
            (&[x, -x], false),
            (&[x, z, -x, -z], false),
            (&[x, x, -x, z], false),
            (&[], true),
        ] {
            assert_eq!(lead_one_way(normals.iter().copied()), expected, "{normals:?}");
        }
    }
}
