//! Searches over Parry's own hierarchies, where a mesh has no tree.

use std::ops::ControlFlow;

use parry3d::math::Real;
use parry3d::partitioning::BvhNode;
use sbbk_core::query::FoundPair;
use sbbk_core::traverse::{BoxTest, Placement, TestedBox};

use crate::mesh::{Hierarchy, box_of};
use crate::pair::walk;

/// Distance up to which all pairs are looked at, as a share of the smaller mesh: a matter of time
/// alone.
const WIDE: f64 = 0.1;

/// Two meshes, by their hierarchies.
pub(super) struct Walk<'a>(pub(super) [&'a Hierarchy<'a>; 2]);

impl Walk<'_> {
    /// A pair of triangles that touch or cross; the first one that the walk comes across.
    pub(super) fn meeting(&self, placement: Placement) -> Option<FoundPair> {
        let mut meeting = None;
        walk(self.0, placement, 0.0, None, (), &mut Vec::new(), |pair| {
            meeting = self.pair(&placement, pair, 0.0).filter(|pair| pair.is_touching);
            if meeting.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        meeting
    }

    /// Of crossing triangles the deepest, else the nearest within `limit`.
    pub(super) fn deepest(&self, placement: Placement, limit: f64) -> Option<FoundPair> {
        // Far from the surface there is too much to look at: the nearest is found first, and if it
        // touches all that do.
        let [size1, size2] = self.0.map(|mesh| f64::from(mesh.ball().radius));
        if limit > WIDE * size1.min(size2) {
            let nearest = self.nearest(placement, limit)?;
            return if nearest.is_touching { self.deepest(placement, 0.0) } else { Some(nearest) };
        }
        let mut deepest = None::<FoundPair>;
        walk(
            self.0,
            placement,
            (limit.max(0.0) as Real).next_up(),
            None,
            (),
            &mut Vec::new(),
            |pair| {
                if let Some(pair) = self.pair(&placement, pair, limit)
                    && deepest
                        .is_none_or(|deepest| pair.contact.distance < deepest.contact.distance)
                {
                    deepest = Some(pair);
                }
                ControlFlow::Continue(())
            },
        );
        deepest
    }

    /// The nearest pair of triangles within `limit`: one that touches, if any does.
    pub(super) fn nearest(&self, placement: Placement, limit: f64) -> Option<FoundPair> {
        if !placement.is_finite() || limit.is_nan() {
            return None;
        }
        let [mesh1, mesh2] = self.0;
        if mesh1.size_squared() < mesh2.size_squared() {
            let found = Walk([mesh2, mesh1]).nearest_of_larger(placement.inverted(), limit)?;
            // The same pair in the other order.
            let triangles = [found.triangle2, found.triangle1];
            return self.pair(&placement, triangles, f64::INFINITY);
        }
        self.nearest_of_larger(placement, limit)
    }

    /// Mesh 1 is the larger one.
    fn nearest_of_larger(&self, placement: Placement, limit: f64) -> Option<FoundPair> {
        let [mesh1, mesh2] = self.0;
        let [m1, m2] = self.0.map(Hierarchy::magnitude);
        let in_frame1 = BoxTest::new([m1, m2], &placement, 0.0);
        let in_frame2 = BoxTest::new([m2, m1], &placement.inverted(), 0.0);
        let root = mesh2.root();
        let whole = in_frame1.of(TestedBox::new(root.mins, root.maxs));
        // Costs are compared with less-than: the least number above the limit is the first one out.
        let limit = (limit.min(f64::from(Real::MAX)) as Real).next_up();
        let found = mesh1.mesh.bvh().find_best(
            limit,
            |node1: &BvhNode, _| whole.gap(box_of(node1)),
            |triangle1, best| {
                let near = in_frame2.of(mesh1.tested(&[triangle1]));
                let (_, found) = mesh2.mesh.bvh().find_best(
                    best,
                    |node2: &BvhNode, _| near.gap(box_of(node2)) * inverse_scale(&placement),
                    |triangle2, best| {
                        let pair = self.pair(&placement, [triangle1, triangle2], best.into())?;
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
