//! Queries of two meshes over Parry's BVHs: best-first search for a pair of triangles, down both at
//! once.

use std::ops::ControlFlow;

use arrayvec::ArrayVec;
use glamx::{DMat3, DVec3, Vec3};
use parry3d::math::{Real, Vector};
use parry3d::partitioning::{BvhNodeIndex, TraversalAction};
use sbbk_core::query::{Bodies, Cast, CastOptions, FoundPair, best_first};
use sbbk_core::traverse::{DescentCounts, Placement};

use crate::mesh::MeshView;
use crate::pair::{BvhDescent, ROUNDING, STRETCH, WIDE};

/// Two meshes, mesh 2 at a placement in the frame of mesh 1.
#[derive(Copy, Clone)]
pub(super) struct BvhSearch<'a> {
    pub(super) meshes: [&'a MeshView<'a>; 2],
    pub(super) placement: Placement,
}

/// The middle and the half-lengths of a box, in the frames of both meshes.
#[derive(Copy, Clone)]
struct PlacedBox {
    centres: [DVec3; 2],
    extents: [DVec3; 2],
}

/// A node of a BVH. The virtual node above the root has no index and no triangle.
#[derive(Copy, Clone)]
struct Node {
    bounds: PlacedBox,
    index: Option<BvhNodeIndex>,
    triangle: Option<u32>,
}

/// The normal of the nearest pair or the first impact so far, in both frames. Other pairs are no
/// nearer, and meet no sooner, than along the normal.
#[derive(Copy, Clone)]
struct FirstNormal {
    normals: [DVec3; 2],
    /// Speed against the normal of an impact, else 1.
    approach: f64,
}

/// Difference of distances that counts as none, in [roundings](BvhSearch::rounding). Higher: less
/// exact distances. Lower: searches visit all pairs of parallel faces.
const TIES: f64 = 4.0;

impl BvhSearch<'_> {
    /// Returns the first pair of touching triangles that the descent finds.
    pub(super) fn meeting(&self) -> Option<FoundPair> {
        let mut meeting = None;
        self.all(0.0, |pair| {
            meeting = Some(pair).filter(|pair| pair.is_touching);
            if meeting.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        meeting
    }

    /// Returns the nearest pair of triangles within `limit`: one that touches, if any does.
    pub(super) fn nearest(&self, limit: f64) -> Option<FoundPair> {
        let meeting = self.meeting().filter(|_| limit >= 0.0);
        meeting.or_else(|| self.nearest_where(limit, |_| true))
    }

    /// Returns the deepest pair of crossing triangles, else the nearest within `limit`.
    pub(super) fn deepest(&self, limit: f64) -> Option<FoundPair> {
        let [radius1, radius2] = self.meshes.map(|mesh| mesh.ball().radius);
        // Within a wide limit there are too many pairs.
        if limit <= WIDE * f64::from(radius1.min(radius2)) {
            return self.deepest_near(limit);
        }
        match self.meeting() {
            Some(_) => self.deepest_near(0.0),
            None => self.nearest_where(limit, |_| true),
        }
    }

    /// Returns the first impact that `counts` of mesh 2, which moves by `velocity` in the frame of
    /// mesh 1.
    pub(super) fn cast(
        &self,
        velocity: Vector,
        options: CastOptions,
        counts: impl Fn(&Cast) -> bool,
    ) -> Option<Cast> {
        let Self { meshes, placement } = self;
        if !options.is_possible() || !velocity.is_finite() || !placement.is_finite() {
            return None;
        }
        let velocity = velocity.as_dvec3();
        let cast = |triangles: [u32; 2], latest: f64| {
            let [one, two] = [0, 1].map(|i| (triangles[i], meshes[i].corners(triangles[i])));
            Cast::of_triangles(placement, one, two, velocity, &options, latest, &counts)
        };
        // Bounds of meshes in each other are zero for many pairs, so a search visits many before
        // one that touches.
        if options.stop_at_penetration
            && let Some(meeting) = self.meeting()
            && let Some(found) = cast([meeting.triangle1, meeting.triangle2], 0.0)
        {
            return Some(found);
        }
        let target = f64::from(options.target_distance) + self.rounding();
        let mut first = None::<Cast>;
        self.search(
            f64::from(options.max_time),
            target,
            |one, two| one.time(two, velocity, target),
            |triangles, latest| {
                let found = cast(triangles, latest)?;
                if first.is_some_and(|first| found.time >= first.time) {
                    return None;
                }
                first = Some(found);
                let normal = self.first_normal(&found.pair, velocity);
                // Parallel faces have many impacts at the same time.
                let tie = normal.map_or(0.0, |of| TIES * self.rounding() / of.approach);
                Some((if found.time > 0.0 { found.time - tie } else { f64::NEG_INFINITY }, normal))
            },
        );
        first
    }

    /// Returns the normal of an impact as a bound of other times; `None` for a grazing impact.
    fn first_normal(&self, pair: &FoundPair, velocity: DVec3) -> Option<FirstNormal> {
        let approach = -pair.contact.normal.dot(velocity);
        let is_bound = approach > 0.0 && approach.recip().is_finite();
        is_bound.then(|| FirstNormal { normals: self.normals(pair), approach })
    }

    /// Visits pairs of triangles, the least bound first, while bounds are at most the limit.
    /// `visit` gets the limit. It may return a lower one, and a normal along which gaps beyond
    /// `target` are bounds, too.
    fn search(
        &self,
        mut limit: f64,
        target: f64,
        bound: impl Fn(&PlacedBox, &PlacedBox) -> f64,
        mut visit: impl FnMut([u32; 2], f64) -> Option<(f64, Option<FirstNormal>)>,
    ) {
        let mut first = None::<FirstNormal>;
        let roots = (f64::NEG_INFINITY, [0, 1].map(|i| self.root(i)));
        best_first(&mut Vec::with_capacity(64), roots, |key, [node1, node2], stack| {
            // A bound that is NaN bounds nothing.
            if key > limit {
                return ControlFlow::Continue(());
            }
            if let (Some(triangle1), Some(triangle2)) = (node1.triangle, node2.triangle) {
                let triangles = [triangle1, triangle2];
                let is_beyond = |of: FirstNormal| {
                    (self.gap_along(of.normals, triangles) - target) / of.approach > limit
                };
                if !first.is_some_and(is_beyond)
                    && let Some((least, normal)) = visit(triangles, limit)
                {
                    (limit, first) = (least.min(limit), normal);
                }
                return ControlFlow::Continue(());
            }
            let is_first = node1.triangle.is_none()
                && (node2.triangle.is_some() || node1.bounds.size() >= node2.bounds.size());
            let parent = if is_first { &node1 } else { &node2 };
            for child in self.children(usize::from(!is_first), parent) {
                let pair = if is_first { [child, node2] } else { [node1, child] };
                let [one, two] = pair.each_ref().map(|node| &node.bounds);
                let along =
                    |of: FirstNormal| (one.gap_along(two, of.normals) - target) / of.approach;
                let key = bound(one, two).max(first.map_or(f64::NEG_INFINITY, along));
                if key > limit {
                    continue;
                }
                stack.push((key, pair));
            }
            ControlFlow::Continue(())
        });
    }

    /// Returns the pair of triangles with the least signed distance within `limit`, or one that
    /// touches if any does. Skips pairs that do not count.
    fn nearest_where(&self, limit: f64, counts: impl Fn([u32; 2]) -> bool) -> Option<FoundPair> {
        let is_possible = self.placement.is_finite() && limit >= 0.0;
        if !is_possible {
            return None;
        }
        let lost = self.rounding();
        let mut nearest = None::<FoundPair>;
        let bound = |one: &PlacedBox, two: &PlacedBox| one.gap(two) - lost;
        self.search(limit, lost, bound, |triangles, limit| {
            if nearest.is_some_and(|nearest| nearest.is_touching) || !counts(triangles) {
                return None;
            }
            let pair = self.pair(triangles, limit)?;
            let distance = pair.contact.distance;
            if nearest.is_some_and(|nearest| distance >= nearest.contact.distance) {
                return None;
            }
            nearest = Some(pair);
            if pair.is_touching {
                return Some((f64::NEG_INFINITY, None));
            }
            // Parallel faces have many pairs at the same distance.
            let normal = FirstNormal { normals: self.normals(&pair), approach: 1.0 };
            Some((distance - TIES * lost, Some(normal)))
        });
        nearest
    }

    /// Returns the deepest pair of triangles or, where none cross, the nearest within `limit`.
    fn deepest_near(&self, limit: f64) -> Option<FoundPair> {
        // The deepest pair so far, and its normal in both frames.
        let mut deepest = None::<(FoundPair, [DVec3; 2])>;
        self.visit_near(limit, |triangles| {
            let least = deepest.map_or(f64::INFINITY, |(pair, _)| pair.contact.distance);
            let is_shallow =
                |(_, normals)| self.gap_along(normals, triangles) - self.rounding() >= least;
            if !deepest.is_some_and(is_shallow)
                && let Some(pair) = self.pair(triangles, limit)
                && pair.contact.distance < least
            {
                deepest = Some((pair, self.normals(&pair)));
            }
            ControlFlow::Continue(())
        });
        Some(deepest?.0)
    }

    /// Calls `found` with all pairs of triangles within `limit`, until it breaks.
    fn all(&self, limit: f64, mut found: impl FnMut(FoundPair) -> ControlFlow<()>) {
        self.visit_near(limit, |triangles| {
            self.pair(triangles, limit).map_or(ControlFlow::Continue(()), &mut found)
        });
    }

    /// Calls `visit` with all pairs of triangles within `limit`, and with others, until it breaks.
    fn visit_near(&self, limit: f64, visit: impl FnMut([u32; 2]) -> ControlFlow<()>) {
        let (margin, near) = ((limit.max(0.0) as Real).next_up(), &mut Vec::new());
        let descent = BvhDescent::new(self.meshes, self.placement, margin, None);
        let counts = &mut DescentCounts::default();
        descent.list_near(near, counts);
        let _ = descent.pairs(near, counts, |_, _| false, visit);
    }

    /// Returns the normal of a contact in the frames of both meshes.
    fn normals(&self, pair: &FoundPair) -> [DVec3; 2] {
        let normal = pair.contact.normal;
        [normal, self.placement.rotation.transpose() * normal]
    }

    /// Gap between two triangles along a direction, given in both frames: at most their distance,
    /// up to rounding.
    fn gap_along(&self, [normal1, normal2]: [DVec3; 2], triangles: [u32; 2]) -> f64 {
        let [one, two] = [0, 1].map(|i| self.meshes[i].corners(triangles[i]).map(Vec3::as_dvec3));
        let [a, b, c] = one.map(|corner| normal1.dot(corner));
        let [d, e, f] = two.map(|corner| normal2.dot(corner));
        let offset = normal1.dot(self.placement.translation);
        d.min(e).min(f) + offset - a.max(b).max(c)
    }

    /// Contact of two triangles that touch or are at most `margin` apart.
    fn pair(&self, triangles: [u32; 2], margin: f64) -> Option<FoundPair> {
        let [one, two] = [0, 1].map(|i| (triangles[i], self.meshes[i].corners(triangles[i])));
        FoundPair::of(&self.placement, one, two, margin)
    }

    /// Returns a bound on the rounding of a gap of boxes.
    fn rounding(&self) -> f64 {
        let [size1, size2] = self.meshes.map(|mesh| f64::from(mesh.magnitude()));
        ROUNDING * (size1 + size2 + self.placement.translation.length())
    }

    fn root(&self, mesh: usize) -> Node {
        let root = self.meshes[mesh].root();
        let bounds = self.placed(mesh, root.mins.as_dvec3(), root.maxs.as_dvec3());
        Node { bounds, index: None, triangle: None }
    }

    fn children(&self, mesh: usize, node: &Node) -> ArrayVec<Node, 2> {
        let (mut children, parent) = (ArrayVec::new(), node.index);
        self.meshes[mesh].mesh.bvh().traverse_indexed(parent, |child, index| {
            if parent.is_some_and(|parent| parent.0 == index.0) {
                return TraversalAction::Continue;
            }
            let bounds = self.placed(mesh, child.mins().as_dvec3(), child.maxs().as_dvec3());
            children.push(Node { bounds, index: Some(index), triangle: child.leaf_data() });
            TraversalAction::Prune
        });
        children
    }

    fn placed(&self, mesh: usize, min: DVec3, max: DVec3) -> PlacedBox {
        let (centre, extent) = (0.5 * (min + max), 0.5 * (max - min));
        let Placement { rotation, translation, inverse } = self.placement;
        let turned = |matrix: DMat3| {
            let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(DVec3::abs);
            x * extent.x + y * extent.y + z * extent.z
        };
        if mesh == 0 {
            let centres = [centre, inverse * (centre - translation)];
            PlacedBox { centres, extents: [extent, turned(inverse)] }
        } else {
            let centres = [rotation * centre + translation, centre];
            PlacedBox { centres, extents: [turned(rotation), extent] }
        }
    }
}

impl Bodies for BvhSearch<'_> {
    type Pair = FoundPair;

    fn nearest(
        &mut self,
        placement: &Placement,
        reach: f64,
        excluded: &[[u32; 2]],
    ) -> Option<FoundPair> {
        self.placement = *placement;
        self.nearest_where(reach, |pair| excluded.binary_search(&pair).is_err())
    }

    fn within(&mut self, placement: &Placement, reach: f64, mut found: impl FnMut(FoundPair)) {
        self.placement = *placement;
        self.all(reach, |pair| {
            found(pair);
            ControlFlow::Continue(())
        });
    }
}

impl PlacedBox {
    fn size(&self) -> f64 {
        self.extents[0].length_squared()
    }

    /// Distance along the axes of one of the meshes.
    fn gap(&self, other: &Self) -> f64 {
        let [in_frame1, in_frame2] = [0, 1].map(|i| {
            let offset = (self.centres[i] - other.centres[i]).abs();
            (offset - (self.extents[i] + other.extents[i])).max(DVec3::ZERO).length()
        });
        in_frame1.max(in_frame2 * (1.0 - STRETCH))
    }

    /// Gap along a direction, given in the frames of both meshes.
    fn gap_along(&self, other: &Self, [normal1, normal2]: [DVec3; 2]) -> f64 {
        let reach = normal1.abs().dot(self.extents[0]) + normal2.abs().dot(other.extents[1]);
        normal1.dot(other.centres[0] - self.centres[0]) - reach
    }

    /// Earliest time at which the boxes are within `target` of each other, where the other one
    /// moves; infinite if they pass each other.
    fn time(&self, other: &Self, velocity: DVec3, target: f64) -> f64 {
        let offset = other.centres[0] - self.centres[0];
        let reach = self.extents[0] + other.extents[0] + target;
        let mut start = ((self.gap(other) - target) / velocity.length()).max(0.0);
        let mut end = f64::INFINITY;
        for axis in 0..3 {
            // Infinite without speed: of both signs, unless the boxes pass each other.
            let speed = velocity[axis];
            let [one, two] = [-reach[axis] - offset[axis], reach[axis] - offset[axis]];
            start = start.max((one / speed).min(two / speed));
            end = end.min((one / speed).max(two / speed));
        }
        if start <= end * (1.0 + ROUNDING) { start * (1.0 - ROUNDING) } else { f64::INFINITY }
    }
}
