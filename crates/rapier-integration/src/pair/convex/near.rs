//! The triangles of a mesh near a convex shape, from Parry's hierarchy of the mesh.

use glamx::DVec3;
use parry3d::math::Real;
use sbbk_core::traverse::{BoxTest, Counters, PairFrame, TestedBox};
use sbbk_core::volumes::rounding::gamma;

use super::placed::PlacedPart;
use super::shape::ConvexShape;
use crate::mesh::Hierarchy;

/// A convex shape as boxes of the mesh are compared with it.
pub(super) enum NearPart {
    /// Within a box of its own frame.
    Box { test: BoxTest, own: TestedBox },
    /// Below a plane of the mesh's frame: `normal·x <= height`.
    HalfSpace { normal: DVec3, height: f64 },
}

impl NearPart {
    /// A part, to find all triangles within `margin` of it. `magnitude` is the largest coordinate of
    /// the mesh.
    pub(super) fn new(
        placed: &PlacedPart,
        shape: ConvexShape<'_>,
        magnitude: Real,
        margin: Real,
    ) -> Self {
        let placement = placed.placement;
        if let ConvexShape::HalfSpace(half_space) = shape {
            let normal = half_space.normal.as_dvec3();
            let own = placement.rotation.transpose() * normal;
            // What boxes lose to rounding in f32 is a few parts of their size; all else is f64.
            let lost = f64::from(gamma(8) * magnitude) * own.abs().element_sum();
            let offset = normal.dot(placement.translation);
            let height = f64::from(margin) * normal.length() + lost - offset;
            return Self::HalfSpace { normal: own, height: height + 1e-14 * offset.abs() };
        }
        let (min, max, radius) = placed.bounds();
        let size = min.abs().max(max.abs()).max_element();
        let reach = ((f64::from(margin) + f64::from(radius)) as Real).next_up();
        let frame: PairFrame = PairFrame::within([magnitude, size], placement.inverted(), reach);
        Self::Box { test: BoxTest::new(&frame), own: TestedBox::new(min, max) }
    }

    /// Calls `found` with the triangles whose boxes may be within the margin, in stock order.
    pub(super) fn triangles(
        &self,
        mesh: &Hierarchy<'_>,
        counters: impl Counters,
        found: impl FnMut(u32),
    ) {
        match self {
            Self::Box { test, own } => {
                let near = test.of(*own);
                mesh.near(counters, |node| near.meets(node), found);
            }
            Self::HalfSpace { normal, height } => {
                let is_below = |node: TestedBox| {
                    let (centre, extent) = node.centre_extent();
                    let lowest =
                        normal.dot(centre.as_dvec3()) - normal.abs().dot(extent.as_dvec3());
                    lowest <= *height
                };
                mesh.near(counters, is_below, found);
            }
        }
    }
}
