//! The exact contact of a triangle and a convex shape, by [`sbbk_core::contact::convex`].

use glamx::DVec3;
use parry3d::shape::TypedShape;
use sbbk_core::contact::Feature;
use sbbk_core::contact::convex::{
    ConeSupport, ConvexContact, CuboidSupport, CylinderSupport, PointSupport, SegmentSupport,
    SupportMap, TriangleSupport, convex_contact, convex_touches, feature_at, half_space_contact,
};

use super::parts::PlacedPart;
use super::shape::{ConvexShape, KeptHull};

/// The contact of a triangle and a part without its rounding radius, in the frame of the part.
#[derive(Copy, Clone)]
pub(crate) struct PartContact {
    pub(super) contact: ConvexContact,
    /// The feature of the triangle.
    pub(super) feature: Feature,
    pub(super) source: NormalSource,
}

/// A contact and its subshapes.
pub(super) type Hit = ([u32; 2], PartContact);

/// Origin of the normal of a contact.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(crate) enum NormalSource {
    /// The triangle and the shape.
    Own,
    /// Another triangle, for a ghost contact. Distance and point on the shape belong to the support
    /// point of the shape.
    Neighbour,
    /// The face of the triangle, for a contact at a border.
    Border,
    /// The push-out from a solid: one point, in line with the middle of the shape.
    PushOut,
}

impl PartContact {
    #[inline(always)]
    pub(super) fn new(contact: ConvexContact, corners: &[DVec3; 3]) -> Self {
        let feature = feature_at(corners, contact.on_triangle, contact.normal);
        Self { contact, feature, source: NormalSource::Own }
    }

    /// Returns this contact with the normal of another one.
    pub(super) fn with_normal_of(&self, other: &ConvexContact) -> Self {
        let contact = ConvexContact { on_triangle: self.contact.on_triangle, ..*other };
        Self { contact, source: NormalSource::Neighbour, ..*self }
    }
}

/// Computes with the support map of a shape without its rounding radius; `None` for a half-space.
/// `hull` keeps the points of a convex polyhedron from call to call.
macro_rules! with_core {
    ($shape:expr, $hull:expr, |$core:ident| $compute:expr) => {{
        macro_rules! of {
            ($support:expr) => {{
                let $core = $support;
                Some($compute)
            }};
        }
        match $shape {
            ConvexShape::Ball(_) => of!(&PointSupport(DVec3::ZERO)),
            ConvexShape::HalfSpace(_) => None,
            ConvexShape::Cuboid(it)
            | ConvexShape::Features { core: TypedShape::Cuboid(it), .. } => {
                of!(&CuboidSupport(it.half_extents.as_dvec3()))
            }
            ConvexShape::Features { core, .. } => match core {
                TypedShape::Segment(it) => {
                    of!(&SegmentSupport([it.a, it.b].map(|end| end.as_dvec3())))
                }
                TypedShape::Triangle(it) => {
                    of!(&TriangleSupport([it.a, it.b, it.c].map(|corner| corner.as_dvec3())))
                }
                TypedShape::Cylinder(it) => {
                    let (half_height, radius) = (it.half_height.into(), it.radius.into());
                    of!(&CylinderSupport { half_height, radius })
                }
                TypedShape::Cone(it) => {
                    let (half_height, radius) = (it.half_height.into(), it.radius.into());
                    of!(&ConeSupport { half_height, radius })
                }
                TypedShape::ConvexPolyhedron(it) => of!($hull.of(it)),
                _ => None,
            },
        }
    }};
}

/// Contact of a triangle with a shape without its rounding radius, in the frame of the shape.
/// `hull` keeps the points of a convex polyhedron from call to call. Boxes are compared first.
pub(super) fn core_contact(
    placed: &PlacedPart,
    triangle: &[DVec3; 3],
    shape: ConvexShape<'_>,
    hull: &KeptHull,
    margin: f64,
) -> Option<ConvexContact> {
    if placed.is_beyond(triangle, margin) {
        return None;
    }
    if let ConvexShape::HalfSpace(half_space) = shape {
        return half_space_contact(triangle, half_space.normal.as_dvec3(), margin);
    }
    with_core!(shape, hull, |core| convex_contact(triangle, core, margin))?
}

/// Support point of a shape without its rounding radius, in f64; `None` for a half-space.
pub(super) fn core_support(
    shape: ConvexShape<'_>,
    hull: &KeptHull,
    direction: DVec3,
) -> Option<DVec3> {
    with_core!(shape, hull, |core| core.support(direction))
}

/// Returns true if a triangle crosses a shape without its radius or is within `reach` of it.
pub(super) fn core_touches(
    placed: &PlacedPart,
    triangle: &[DVec3; 3],
    shape: ConvexShape<'_>,
    hull: &KeptHull,
    reach: f64,
) -> bool {
    // Faster than a contact: needs neither depths nor faces.
    if let Some(shape) = shape.polyhedron() {
        return !placed.is_beyond(triangle, reach)
            && convex_touches(triangle, hull.of(shape), reach);
    }
    core_contact(placed, triangle, shape, hull, reach).is_some()
}
