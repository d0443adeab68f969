//! Searches over Parry's own hierarchies, where a mesh has no tree.

use std::ops::ControlFlow;

use glamx::Vec3;
use parry3d::math::Real;
use parry3d::partitioning::BvhNode;
use sbbk_core::query::FoundPair;
use sbbk_core::traverse::{BoxTest, PairFrame, Placement, TestedBox};

use crate::mesh::{Hierarchy, box_of};
use crate::pair::walk;

/// Two meshes, by their hierarchies.
pub(super) struct Walk<'a>(pub(super) [&'a Hierarchy<'a>; 2]);

impl Walk<'_> {
    /// A pair of triangles that touch or cross; the first one that the walk comes across.
    pub(super) fn meeting(&self, placement: Placement) -> Option<FoundPair> {
        let mut meeting = None;
        walk(self.0, placement, 0.0, (), |pair| {
            meeting = self.pair(&placement, pair, 0.0).filter(|pair| pair.is_touching);
            if meeting.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        meeting
    }

    /// Of crossing triangles the deepest, else the nearest within `limit`.
    pub(super) fn deepest(&self, placement: Placement, limit: f64) -> Option<FoundPair> {
        let mut deepest = None::<FoundPair>;
        let nearest = self.nearest(placement, limit)?;
        if !nearest.is_touching {
            return Some(nearest);
        }
        walk(self.0, placement, 0.0, (), |pair| {
            if let Some(pair) = self.pair(&placement, pair, 0.0)
                && deepest.is_none_or(|deepest| pair.contact.distance < deepest.contact.distance)
            {
                deepest = Some(pair);
            }
            ControlFlow::Continue(())
        });
        deepest.or(Some(nearest))
    }

    /// The nearest pair of triangles within `limit`: one that touches, if any does.
    pub(super) fn nearest(&self, placement: Placement, limit: f64) -> Option<FoundPair> {
        if !placement.is_finite() || limit.is_nan() {
            return None;
        }
        let [mesh1, mesh2] = self.0;
        let magnitudes = self.0.map(Hierarchy::magnitude);
        let within = |[one, two]: [Real; 2], placement| {
            BoxTest::new(&PairFrame::<9>::within([one, two], placement, 0.0))
        };
        let [m1, m2] = magnitudes;
        let (in_frame1, in_frame2) =
            (within([m1, m2], placement), within([m2, m1], placement.inverted()));
        let root = mesh2.root();
        let whole = in_frame1.of(TestedBox::new(root.mins, root.maxs));
        // Costs are compared with less-than: the least number above the limit is the first one out.
        let limit = (limit.min(f64::from(Real::MAX)) as Real).next_up();
        let found = mesh1.mesh.bvh().find_best(
            limit,
            |node1: &BvhNode, _| whole.gap(box_of(node1)),
            |triangle1, best| {
                let corners1 = mesh1.corners(triangle1);
                let low = corners1.into_iter().fold(Vec3::INFINITY, Vec3::min);
                let high = corners1.into_iter().fold(Vec3::NEG_INFINITY, Vec3::max);
                let near = in_frame2.of(TestedBox::new(low, high));
                let (_, found) = mesh2.mesh.bvh().find_best(
                    best,
                    |node2: &BvhNode, _| near.gap(box_of(node2)) * inverse_scale(&placement),
                    |triangle2, best| {
                        let two = (triangle2, mesh2.corners(triangle2));
                        let one = (triangle1, corners1);
                        let pair = FoundPair::of(&placement, one, two, f64::from(best))?;
                        Some((pair.contact.distance.max(0.0) as Real, pair))
                    },
                )?;
                Some(found)
            },
        );
        found.map(|(_, (_, pair))| pair)
    }

    fn pair(&self, placement: &Placement, pair: [u32; 2], margin: f64) -> Option<FoundPair> {
        let [one, two] = [0, 1].map(|i| (pair[i], self.0[i].corners(pair[i])));
        FoundPair::of(placement, one, two, margin)
    }
}

/// At most how long a unit of frame 2 is in frame 1.
fn inverse_scale(placement: &Placement) -> Real {
    let shortest = [0, 1, 2].map(|i| placement.rotation.col(i).length());
    shortest.into_iter().fold(f64::INFINITY, f64::min) as Real
}
