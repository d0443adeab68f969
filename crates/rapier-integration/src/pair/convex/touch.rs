use glamx::DVec3;
use sbbk_core::contact::Feature;
use sbbk_core::contact::convex::{ConvexContact, feature_at};

/// The contact of a triangle with the core of a shape.
#[derive(Copy, Clone)]
pub(crate) struct Touch {
    pub(super) contact: ConvexContact,
    /// The part of the triangle that touches.
    pub(super) feature: Feature,
    pub(super) along: Along,
}

/// Which normal a contact is along.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(crate) enum Along {
    /// Its own.
    Own,
    /// That of another triangle: distance and point of the shape are of the farthest point of the shape
    /// along that. See [`Seams`](crate::pair::seams::Seams).
    Other,
    /// The way out of the mesh, in line with the middle of the shape, of one point.
    WayOut,
}

impl Touch {
    #[inline(always)]
    pub(super) fn new(contact: ConvexContact, corners: &[DVec3; 3]) -> Self {
        let feature = feature_at(corners, contact.on_triangle, contact.normal);
        Self { contact, feature, along: Along::Own }
    }
}
