//! Queries of two meshes over Parry's BVHs.

use std::ops::ControlFlow;

use parry3d::math::Vector;
use sbbk_core::query::{Bodies, Cast, CastOptions, FoundPair};
use sbbk_core::traverse::Placement;

use super::bvh_search::BvhSearch;
use crate::mesh::MeshView;

/// Limit, as a share of the smaller mesh's radius, above which [`Walk::deepest`] first searches for a pair that touches.
/// Changes time alone. Higher: slower far from the mesh; lower: slower near it.
const WIDE: f64 = 0.1;

/// Two meshes, searched by their BVHs.
pub(super) struct Walk<'a>(pub(super) [&'a MeshView<'a>; 2]);

impl<'a> Walk<'a> {
    /// Returns the first pair of touching triangles that the descent finds.
    pub(super) fn meeting(&self, placement: Placement) -> Option<FoundPair> {
        let mut meeting = None;
        self.at(placement).all(0.0, |pair| {
            meeting = Some(pair).filter(|pair| pair.is_touching);
            if meeting.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        meeting
    }

    /// Returns the deepest pair of crossing triangles, else the nearest within `limit`.
    pub(super) fn deepest(&self, placement: Placement, limit: f64) -> Option<FoundPair> {
        let size = self.0[0].ball().radius.min(self.0[1].ball().radius);
        // Within a wide limit there are too many pairs.
        if limit <= WIDE * f64::from(size) {
            return self.at(placement).deepest(limit);
        }
        match self.meeting(placement) {
            Some(_) => self.at(placement).deepest(0.0),
            None => self.at(placement).nearest(limit, |_| true),
        }
    }

    /// Returns the nearest pair of triangles within `limit`: one that touches, if any does.
    pub(super) fn nearest(&self, placement: Placement, limit: f64) -> Option<FoundPair> {
        let meeting = self.meeting(placement).filter(|_| limit >= 0.0);
        meeting.or_else(|| self.at(placement).nearest(limit, |_| true))
    }

    /// Returns the first impact that `counts` of mesh 2, which moves by `velocity` in the frame of mesh 1.
    pub(super) fn cast(
        &self,
        placement: Placement,
        velocity: Vector,
        options: CastOptions,
        counts: impl Fn(&Cast) -> bool,
    ) -> Option<Cast> {
        if !options.is_possible() || !velocity.is_finite() || !placement.is_finite() {
            return None;
        }
        let pair = self.at(placement);
        let velocity = velocity.as_dvec3();
        let cast = |triangles: [u32; 2], latest: f64| {
            let [one, two] = [0, 1].map(|i| (triangles[i], self.0[i].corners(triangles[i])));
            Cast::of_triangles(&placement, one, two, velocity, &options, latest)
        };
        // Bounds of meshes in each other are zero for many pairs, so a search visits many before one that touches.
        if options.stop_at_penetration
            && let Some(meeting) = self.meeting(placement)
            && let Some(found) = cast([meeting.triangle1, meeting.triangle2], 0.0)
        {
            return Some(found);
        }
        let target = f64::from(options.target_distance) + pair.rounding();
        let mut first = None::<Cast>;
        let latest = f64::from(options.max_time);
        pair.search(
            latest,
            |one, two| one.time(two, velocity, target),
            |triangles, latest| {
                let found = cast(triangles, latest)?;
                if first.is_some_and(|first| found.time >= first.time) || !counts(&found) {
                    return None;
                }
                first = Some(found);
                Some(if found.time > 0.0 { found.time } else { f64::NEG_INFINITY })
            },
        );
        first
    }

    fn at(&self, placement: Placement) -> BvhSearch<'a> {
        BvhSearch { meshes: self.0, placement }
    }
}

impl Bodies for Walk<'_> {
    type Pair = FoundPair;

    fn nearest(
        &mut self,
        placement: &Placement,
        reach: f64,
        excluded: &[[u32; 2]],
    ) -> Option<FoundPair> {
        self.at(*placement).nearest(reach, |pair| excluded.binary_search(&pair).is_err())
    }

    fn within(&mut self, placement: &Placement, reach: f64, mut found: impl FnMut(FoundPair)) {
        self.at(*placement).all(reach, |pair| {
            found(pair);
            ControlFlow::Continue(())
        });
    }
}
