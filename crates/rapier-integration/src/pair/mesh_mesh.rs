use std::ops::ControlFlow;
use std::sync::{Arc, OnceLock};

use glamx::DVec3;
use parry3d::math::{Real, Vector};
use parry3d::query::details::NormalConstraints;
use parry3d::query::{PointQuery, Ray};
use sbbk_core::leaf::LeafTest;
use sbbk_core::surface::{Around, Side, Surface, SurfaceKind};
use sbbk_core::traverse::{
    DescentCounts, NodePair, PairFrame, Placement, begin_descent, descend_from,
};
use sbbk_core::tree::Tree;
use sbbk_core::volumes::Sphere;

use super::bvh_descent::{BvhDescent, Culling};
use super::chunks::{has_threads, in_chunks};
use super::far::are_few;
use super::pose::PairPose;
use super::query::{Moving, Pair};
use super::ranges::{bends_little, filter_distance, filter_unit, lateral_culling, reach};
use super::reduce::PatchPlan;
use super::state::Candidate;
use super::triangle_contacts::in_local;
use super::triangle_shapes::{
    Cones, DescentChunk, DescentMemory, Hint, TriangleHit, TriangleShape, TriangleShapes,
    TriangleSurfaceContact,
};
use super::triangles::TriangleQuery;
use crate::SbbkConfig;
use crate::mesh::{
    BEHIND, Change, LazySurface, MeshFacets, MeshStore, MeshView, PairMesh, exit, is_covered,
};

/// Two meshes.
#[derive(Copy, Clone)]
pub(crate) struct MeshPair<'a> {
    pub(crate) pose: &'a PairPose,
    pub(crate) meshes: [MeshView<'a>; 2],
    pub(crate) config: &'a SbbkConfig,
}

/// Part of a body that may stick out of a room that holds it, in half heights of the body. Higher:
/// bodies deep in a solid stay there. Lower: fast bodies fall through the floors of rooms.
const STICKS_OUT: Real = 0.5;

/// Least depth of the lowest point of a body in a room, in prediction distances or, if less, in tenths of its
/// radius. Higher: thin bodies fall out of rooms. Lower: thin bodies sink into solids.
const SUNK: f64 = 0.5;

/// Least height of a room, in the second longest side of its mesh. Higher: bodies fall out of low halls. Lower: small fast
/// bodies fall through floors and walls that are solids.
const SLAB: Real = 0.1;

/// Share of an f32 distance that is a lower bound of the exact one.
const SURE: f64 = 0.99;

impl MeshPair<'_> {
    /// Returns 1 if the box of mesh 2 is larger than that of mesh 1, else 0.
    pub(super) fn larger(&self) -> usize {
        usize::from(self.meshes[0].size_squared() < self.meshes[1].size_squared())
    }

    /// Returns true if the larger mesh is a room for the smaller one: the smaller one is in it, or
    /// hardly sticks out. A long tube is a room although its ends are open. Flat solids are no rooms, nor are
    /// solids that thin bodies have just sunk in.
    fn is_room(&self, surface: &LazySurface<'_>, test: &mut InsideTest) -> bool {
        let outer = self.larger();
        let [held, holder] = [1 - outer, outer].map(|i| &self.meshes[i]);
        if !held.sorted_extents().cmplt(holder.sorted_extents()).all() {
            return false;
        }
        let middle = self.pose.in_other(1 - outer, held.ball().centre);
        let Some(exit) = self.exit(middle, surface, test) else { return false };
        let depth = exit.distance(middle);
        let way = self.pose.in_other(outer, exit) - held.ball().centre;
        let height = held.height(way.normalize_or_zero(), depth / (1.0 - STICKS_OUT));
        let unit = filter_unit(self.pose, filter_distance(true, held.ball().radius));
        depth >= (1.0 - STICKS_OUT) * height
            && f64::from(depth + height) >= SUNK * unit
            && !self.is_slab(middle, exit)
    }

    /// Returns true if the larger mesh is too flat for a room where `point` is in it. `exit` is the nearest point of the surface.
    fn is_slab(&self, point: Vector, exit: Vector) -> bool {
        let holder = &self.meshes[self.larger()];
        let most = SLAB * 2.0 * holder.sorted_extents().y - exit.distance(point);
        let ray = Ray::new(point, (point - exit).normalize_or_zero());
        self::exit(holder.mesh, &ray, false).is_some_and(|(length, _)| length < most)
    }

    /// Returns the nearest point of the larger mesh, if a point of the smaller one is inside. `point` is
    /// in the frame of the larger mesh, whose surface is `surface`.
    fn exit(
        &self,
        point: Vector,
        surface: &LazySurface<'_>,
        test: &mut InsideTest,
    ) -> Option<Vector> {
        let outer = self.larger();
        let [held, holder] = [1 - outer, outer].map(|i| &self.meshes[i]);
        let PairPose { placement12, placement21, .. } = self.pose;
        let placement = [placement12, placement21][outer];
        if test.is_outside(held.ball(), placement) {
            return None;
        }
        let from_box = holder.root().distance_to_local_point(point, true);
        if from_box > 0.0 {
            *test = InsideTest::outside(placement, from_box);
            return None;
        }
        let is_covered = is_covered(holder.mesh, point);
        let (_, near, behind) = surface.nearest(point)?;
        let is_inside = behind >= BEHIND && (is_covered || surface.kind() == SurfaceKind::Solid);
        if behind < -BEHIND || !is_covered && !is_inside {
            *test = InsideTest::outside(placement, near.distance(point));
        }
        is_inside.then_some(near)
    }
}

/// Last result of the test whether the smaller mesh is inside the larger one. Spares most queries a test.
#[derive(Clone, Debug, Default)]
pub(crate) enum InsideTest {
    #[default]
    Unknown,
    /// The larger mesh is no solid.
    NoSolid,
    /// A point of the smaller mesh was at least this far outside at this placement of the smaller mesh.
    Outside(Placement, f64),
}

impl InsideTest {
    /// A point is `distance` outside at a placement of the smaller mesh.
    fn outside(placement: &Placement, distance: f32) -> Self {
        Self::Outside(*placement, SURE * f64::from(distance))
    }

    /// Returns true if a mesh with points in `ball` cannot have come inside.
    fn is_outside(&self, ball: Sphere, placement: &Placement) -> bool {
        match self {
            Self::Unknown => false,
            Self::NoSolid => true,
            Self::Outside(before, distance) => {
                placement.motion_bound(before, ball.centre, ball.radius) < *distance
            }
        }
    }
}

impl<'a> Pair for MeshPair<'a> {
    /// The meshes, whether one is a room for the other, and whether one is inside the other.
    type State = ([PairMesh; 2], [InsideTest; 2]);
    type Hint = Hint;
    type Query<'q>
        = TriangleQuery<'q, Meshes<'q>>
    where
        Self: 'q;

    fn open<'q>(
        &'q self,
        store: &'q Arc<MeshStore>,
        ([known1, known2], [in_room, inside]): &'q mut Self::State,
    ) -> (Change, Self::Query<'q>) {
        let [mesh1, mesh2] = &self.meshes;
        let change = known1.update(mesh1).max(known2.update(mesh2));
        if change != Change::Unchanged {
            (*in_room, *inside) = Default::default();
        }
        let are_rigid = mesh1.is_rigid() && mesh2.is_rigid();
        let known = if are_rigid {
            [known1.acquire(mesh1, true), known2.acquire(mesh2, true)]
        } else {
            [None, None]
        };
        let [tree1, tree2] = known.each_ref().map(|known| known.as_ref()?.tree());
        let trees = tree1.zip(tree2).map(<[_; 2]>::from);
        let surfaces = known.map(|known| known.filter(|_| self.config.has_surfaces()));
        let [radius1, radius2] = [mesh1, mesh2].map(|mesh| mesh.ball().radius);
        let radius = radius1.min(radius2);
        let has_surface = surfaces.iter().any(Option::is_some);
        let filter_distance = filter_distance(has_surface, radius);
        let outer = self.larger();
        let is_room = |surface: &LazySurface<'_>| {
            self.is_room(surface, in_room) && !surface.is_declared_solid()
        };
        let room = surfaces[outer].as_ref().is_some_and(is_room).then_some(outer);
        let query = TriangleQuery {
            shapes: Meshes {
                pair: self,
                trees,
                surfaces,
                room,
                filter_distance,
                reach: OnceLock::new(),
                inside,
                store,
            },
            pose: self.pose,
            patches: (self.config.has_patches() && are_rigid)
                .then(|| PatchPlan::new(self.pose.prediction, radius)),
        };
        (change, query)
    }
}

/// Two meshes and, if both have them, their trees.
pub(crate) struct Meshes<'q> {
    pub(super) pair: &'q MeshPair<'q>,
    trees: Option<[&'q Tree; 2]>,
    /// Surfaces of both meshes, for contacts of surfaces.
    surfaces: [Option<LazySurface<'q>>; 2],
    /// The mesh that is a room for the other one, and has no inside.
    room: Option<usize>,
    filter_distance: f64,
    reach: OnceLock<Real>,
    inside: &'q mut InsideTest,
    store: &'q MeshStore,
}

/// Pairs of nodes or a few more at which the chunks of a descent start. Higher: fewer descents are split; lower: one
/// chunk may have all that is near.
const STARTS: usize = 1024;

/// Least number of node pairs in a chunk. Higher: one chunk may have all that is near; lower: chunks of microseconds.
const LEAST_STARTS: usize = 32;

/// Least number of triangles of the larger mesh in a chunk of a BVH descent. Higher, lower: see [`LEAST_STARTS`].
const LEAST_NEAR: usize = 64;

impl Meshes<'_> {
    fn descend_trees(
        &self,
        trees: (&Tree, &Tree),
        margin: Real,
        start: &mut Vec<NodePair>,
        descent: &mut DescentChunk,
    ) {
        let MeshPair { pose, .. } = self.pair;
        let mut frame = PairFrame::new(trees, pose.placement12, margin);
        let culling = lateral_culling(self, pose, margin);
        let test = LeafTest::new(&frame);
        let doubles = self.doubles();
        let count = if has_threads() { STARTS } else { 1 };
        begin_descent(trees, &mut frame, count, start, &mut descent.counts);
        let least = if start.len() < STARTS { STARTS } else { LEAST_STARTS };
        in_chunks(start, least, descent, &|start: &mut [_], chunk: &mut DescentChunk| {
            let DescentChunk { found, counts, stack } = chunk;
            let frame = &mut frame.clone();
            descend_from(start, trees, frame, stack, counts, |batch1, batch2| {
                let triangles = [batch1.triangles(), batch2.triangles()];
                let bends_little = |i: usize, lane: usize| self.bends_little(i, triangles[i][lane]);
                let found = |lane1: usize, lane2: usize| {
                    let pair = [triangles[0][lane1], triangles[1][lane2]];
                    if !has_double(&doubles, pair) {
                        found.push(Candidate::new(pair));
                    }
                };
                let lateral = culling.as_ref();
                test.survivors_in_front(lateral, batch1, batch2, bends_little, found);
            });
        });
    }

    fn descend_bvhs(&self, margin: Real, near: &mut Vec<u32>, descent: &mut DescentChunk) {
        let MeshPair { pose, meshes, .. } = self.pair;
        let bends_little = |i: usize, triangle: u32| self.bends_little(i, triangle);
        let culling = lateral_culling(self, pose, margin);
        let culling = culling.map(|lateral| Culling { lateral, may_reject: &bends_little });
        let search = BvhDescent::new(meshes.each_ref(), pose.placement12, margin, culling);
        search.list_near(near, &mut descent.counts);
        let doubles = self.doubles();
        let larger = doubles[self.pair.larger()];
        near.retain(|&triangle| !larger.is_some_and(|surface| surface.is_double(triangle)));
        in_chunks(near, LEAST_NEAR, descent, &|near: &mut [u32], chunk: &mut DescentChunk| {
            let DescentChunk { found, counts, .. } = chunk;
            let _ = search.pairs(near, counts, |pair| {
                if !has_double(&doubles, pair) {
                    found.push(Candidate::new(pair));
                }
                ControlFlow::Continue(())
            });
        });
        self.store.count_walk();
    }

    fn bends_little(&self, i: usize, triangle: u32) -> bool {
        self.surfaces[i].as_ref().is_some_and(|surface| bends_little(&surface.facets(), triangle))
    }

    /// Returns the surfaces that are known by now and have doubles. A descent may leave these out, as they have no contacts.
    fn doubles(&self) -> [Option<&Surface>; 2] {
        self.surfaces.each_ref().map(|surface| surface.as_ref()?.with_doubles())
    }
}

/// Returns true if one of two triangles is a double.
#[inline]
fn has_double(of: &[Option<&Surface>; 2], pair: [u32; 2]) -> bool {
    (0..2).any(|i| of[i].is_some_and(|surface| surface.is_double(pair[i])))
}

impl TriangleShapes for Meshes<'_> {
    type Facets<'f>
        = MeshFacets<'f>
    where
        Self: 'f;

    fn moving(&self) -> Moving<'_> {
        let PairPose { placement12, placement21, .. } = self.pair.pose;
        let smaller = 1 - self.pair.larger();
        Moving {
            ball: self.pair.meshes[smaller].ball(),
            placement: [placement21, placement12][smaller],
        }
    }

    fn descend(
        &self,
        margin: Real,
        counts: &mut DescentCounts,
        DescentMemory { near, start, descent }: &mut DescentMemory,
        found: &mut Vec<Candidate<Hint>>,
    ) {
        std::mem::swap(found, &mut descent.found);
        match self.trees {
            Some(trees) => self.descend_trees(trees.into(), margin, start, descent),
            None => self.descend_bvhs(margin, near, descent),
        }
        *counts += std::mem::take(&mut descent.counts);
        std::mem::swap(found, &mut descent.found);
    }

    #[inline(always)]
    fn corners(&self, [triangle1, triangle2]: [u32; 2]) -> Option<[[Vector; 3]; 2]> {
        let [mesh1, mesh2] = &self.pair.meshes;
        Some([mesh1.corners(triangle1), mesh2.corners(triangle2)])
    }

    fn separation(&self) -> Option<DVec3> {
        // The way starts at the middle of the smaller mesh, which must be in both. Two equal meshes are both tried.
        let [one, two] = &self.pair.meshes;
        let [size1, size2] = [one, two].map(|mesh| mesh.size_squared());
        let inner = [(0, one, size1 <= size2), (1, two, size2 <= size1)];
        let ways = inner.into_iter().filter(|(.., is_inner)| *is_inner);
        let ways =
            ways.filter_map(|(i, mesh, _)| self.way_out(self.pair.pose, i, mesh.ball().centre));
        ways.min_by(|a, b| a.length().total_cmp(&b.length()))?.try_normalize()
    }

    /// Leads by the shortest way from the middle of the smaller mesh. Tests one vertex, unless the middle is known to be
    /// in both: a mesh that pierces the surface has contacts.
    fn push_out(&mut self, is_in_both: bool) -> Option<TriangleHit> {
        let outer = self.pair.larger();
        let held = &self.pair.meshes[1 - outer];
        let vertex = self.pair.pose.in_other(1 - outer, held.corners(0)[0]);
        let surface = self.surfaces[outer].as_ref()?;
        if !is_in_both {
            if self.room.is_some() {
                return None;
            }
            self.pair.exit(vertex, surface, self.inside)?;
            if !self.is_solid(outer) {
                *self.inside = InsideTest::NoSolid;
                return None;
            }
        }
        let middle = self.pair.pose.in_other(1 - outer, held.ball().centre);
        let (triangle, exit, from) = [middle, vertex].into_iter().find_map(|from| {
            let (triangle, exit, behind) = surface.nearest(from)?;
            (behind >= BEHIND).then_some((triangle, exit, from))
        })?;
        let mut subshapes = [0; 2];
        subshapes[outer] = triangle;
        let origin = self.pair.meshes[0].corners(subshapes[0])[0];
        let placement = &self.pair.pose.placement12;
        let mut points = [exit, from].map(|point| in_local(placement, outer, point, origin));
        if outer == 1 {
            points.reverse();
        }
        let [point1, point2] = points;
        let normal = (point1 - point2).try_normalize()?;
        let distance = (point2 - point1).dot(normal);
        self.store.counters.push_outs.raise();
        Some((subshapes, TriangleSurfaceContact::push_out(normal, distance, points)))
    }

    fn with_cones(&self, triangles: [u32; 2], then: impl FnOnce(Cones<'_>)) {
        let cones =
            [0, 1].map(|i| self.pair.meshes[i].mesh.triangle_normal_constraints(triangles[i]));
        then(cones.each_ref().map(|cone| cone.as_ref().map(|cone| cone as &dyn NormalConstraints)));
    }

    #[inline]
    fn surface(&self, i: usize, triangle: u32) -> Option<Around<MeshFacets<'_>>> {
        let surface = self.surfaces[i].as_ref()?.around(triangle);
        Some(if self.room == Some(i) { Around { side: Side::Sheet, ..surface } } else { surface })
    }

    fn shape(&self, i: usize) -> TriangleShape<'_> {
        TriangleShape::Mesh(&self.pair.meshes[i], self.surfaces[i].as_ref())
    }

    fn is_solid(&self, i: usize) -> bool {
        let is_solid = |surface: &LazySurface<'_>| surface.kind() == SurfaceKind::Solid;
        self.room != Some(i) && self.surfaces[i].as_ref().is_some_and(is_solid)
    }

    fn filter_distance(&self) -> f64 {
        self.filter_distance
    }

    fn reach(&self) -> Real {
        let MeshPair { pose, meshes, .. } = self.pair;
        let few = || are_few(meshes.each_ref(), pose);
        *self.reach.get_or_init(|| reach(pose.prediction, self.filter_distance, few))
    }
}
