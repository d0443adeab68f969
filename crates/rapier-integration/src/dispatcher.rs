use std::fmt;
use std::sync::Arc;

use parry3d::math::{Pose, Real, Vector};
use parry3d::query::details::{NormalConstraints, ShapeCastOptions};
use parry3d::query::{
    ClosestPoints, Contact, ContactManifold, ContactManifoldsWorkspace, DefaultQueryDispatcher,
    NonlinearRigidMotion, PersistentQueryDispatcher, QueryDispatcher, ShapeCastHit, ShapeDistance,
    ShapeIntersection, Unsupported,
};
use parry3d::shape::{CompositeShape, Shape, SharedShape, TriMesh};
use sbbk_core::surface::SurfaceKind;
use sbbk_core::traverse::DescentCounts;
use sbbk_core::tree::{BuildError, Tree};

use crate::mesh::{
    Hierarchy, PreparedRef, Registered, TreeCache, are_near, is_near, may_be_inside,
};
use crate::pair::{
    Answer, ConvexPair, ConvexSearch, FewPair, FieldPair, MeshPair, MeshPlace, Pair, PairPose,
    Parts, answer, is_few,
};
use crate::query::{ConvexQuery, MeshQuery, NonlinearCast};
use crate::stats::QueryCounters;
use crate::{ContactDetail, ContactGenerator, ContactSet, SbbkConfig, SbbkStats, TriangleContacts};

/// A query dispatcher that answers pairs of triangle meshes, and the contacts of meshes with convex
/// shapes, compounds, polylines and height fields. All else goes to Parry's
/// [`DefaultQueryDispatcher`].
///
/// Pairs of rigid meshes have SBBK trees, shared by all colliders with equal geometry: those of
/// small meshes are built as queries need them, those of large ones by [`prepare`](Self::prepare)
/// and [`prepare_shape`](Self::prepare_shape). All other pairs do with Parry's own hierarchies.
/// Clones of a dispatcher share their trees.
///
/// A dispatcher of one's own goes before this one: the [guide](crate::guide) has an example.
#[derive(Clone)]
pub struct SbbkDispatcher {
    config: SbbkConfig,
    cache: Arc<TreeCache>,
    counters: Arc<QueryCounters>,
}

impl SbbkDispatcher {
    /// A dispatcher with no trees yet.
    pub fn new(config: SbbkConfig) -> Self {
        let cache = TreeCache::new(config.build_options(), config.idle_tree_bytes);
        Self { config, cache: Arc::new(cache), counters: Arc::default() }
    }

    /// The configuration this dispatcher was made with.
    pub fn config(&self) -> &SbbkConfig {
        &self.config
    }

    /// Builds the tree of a mesh now, or finds it built: at load time, and for a mesh of more than
    /// 8192 triangles, which gets none unasked. The tree stays for as long as the returned value
    /// lives.
    ///
    /// Each new pair of colliders finds the tree at its second query, by a hash of the mesh's content,
    /// so it serves copies of the mesh too. That takes about 4 µs for 1000 triangles; for meshes of
    /// more than about 500,000 it is not done, and queries without manifolds do not do it for more than
    /// 8192: see [`prepare_shape`](Self::prepare_shape). Of no use for a mesh that deforms
    /// (`TriMeshFlags::DEFORMABLE`) or that meets no other rigid mesh.
    ///
    /// A query cannot report trouble (Rapier ignores a dispatcher's errors), so a rigid mesh with a
    /// vertex that is not finite is answered by Parry, as without SBBK, and counted in
    /// [`SbbkStats::unsupported_queries`].
    ///
    /// ```
    /// use parry3d::shape::{Ball, TriMesh};
    /// use rapier_integration::SbbkDispatcher;
    ///
    /// let (vertices, triangles) = Ball::new(1.0).to_trimesh(24, 12);
    /// let mesh = TriMesh::new(vertices, triangles)?;
    /// let dispatcher = SbbkDispatcher::default();
    /// let prepared = dispatcher.prepare(&mesh)?; // keep it
    /// assert_eq!(prepared.tree().triangle_count(), 528);
    /// // A copy needs no build of its own.
    /// let _copy = dispatcher.prepare(&mesh.clone())?;
    /// assert_eq!((dispatcher.stats().tree_builds, dispatcher.stats().tree_hits), (1, 1));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// What is wrong with the mesh, for example a vertex that is NaN.
    pub fn prepare(&self, mesh: &TriMesh) -> Result<PreparedTree, BuildError> {
        let tree = self.cache.prepare(mesh)?;
        Ok(PreparedTree { tree, _registered: None })
    }

    /// As [`prepare`](Self::prepare), for a mesh that is used as this shape and its clones. While the
    /// returned value lives, every query knows its tree by its address, in constant time: the way
    /// for a large mesh, which so is known as a solid, too. Do it before the mesh meets others: pairs
    /// that have met go on as they are. `None` for shapes that are no rigid mesh.
    ///
    /// The returned value holds a clone of `shape`, so whoever edits the shape meanwhile
    /// (`SharedShape::make_mut`) edits a copy of the mesh, and the copy has no tree.
    ///
    /// ```
    /// use parry3d::shape::{Ball, SharedShape};
    /// use rapier_integration::SbbkDispatcher;
    ///
    /// let (vertices, triangles) = Ball::new(1.0).to_trimesh(100, 100);
    /// let shape = SharedShape::trimesh(vertices, triangles)?;
    /// let dispatcher = SbbkDispatcher::default();
    /// let prepared = dispatcher.prepare_shape(&shape)?; // keep it
    /// assert!(prepared.is_some());
    /// // In Rapier: `ColliderBuilder::new(shape.clone())`, once for each collider.
    /// assert!(dispatcher.prepare_shape(&SharedShape::ball(1.0))?.is_none());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// What is wrong with the mesh, for example a vertex that is NaN.
    pub fn prepare_shape(&self, shape: &SharedShape) -> Result<Option<PreparedTree>, BuildError> {
        let Some(mesh) = rigid_mesh(&*shape.0) else {
            return Ok(None);
        };
        let registered = self.cache.register(shape, mesh)?;
        Ok(Some(PreparedTree { tree: registered.tree.clone(), _registered: Some(registered) }))
    }

    /// Counts of trees and queries. Takes time in proportion to the number of trees.
    ///
    /// ```
    /// use parry3d::math::Pose;
    /// use parry3d::query::{ContactManifold, PersistentQueryDispatcher, Unsupported};
    /// use parry3d::shape::{Ball, TriMesh};
    /// use rapier_integration::{SbbkConfig, SbbkDispatcher};
    ///
    /// let mut config = SbbkConfig::default();
    /// config.count_queries = true;
    /// let dispatcher = SbbkDispatcher::new(config);
    /// let (vertices, triangles) = Ball::new(1.0).to_trimesh(24, 12);
    /// let mesh = TriMesh::new(vertices, triangles).unwrap();
    /// let (mut manifolds, mut workspace) = (Vec::<ContactManifold<(), ()>>::new(), None);
    /// let at = Pose::translation(1.99, 0.0, 0.0);
    /// dispatcher.contact_manifolds(&at, &mesh, &mesh, 0.02, &mut manifolds, &mut workspace)?;
    /// let stats = dispatcher.stats();
    /// assert_eq!((stats.pairs, stats.queries, stats.solids), (1, 1, 1));
    /// # Ok::<(), Unsupported>(())
    /// ```
    pub fn stats(&self) -> SbbkStats {
        self.counters.stats(self.cache.counts())
    }

    /// Drops the trees that no pair of colliders uses, see [`SbbkConfig::idle_tree_bytes`]; those
    /// of queries without manifolds too.
    pub fn release_idle_trees(&self) {
        self.cache.release_idle();
    }

    /// What `of_meshes` finds of two rigid meshes, or `of_convex` of one and a convex shape; `None` if
    /// Parry must answer. `apart` is the answer where Parry's hierarchies tell that they are farther
    /// apart than a distance. `balls` says who answers for these.
    fn search<T>(
        &self,
        pos12: &Pose,
        [g1, g2]: [&dyn Shape; 2],
        balls: Balls,
        apart: Option<(Real, T)>,
        of_meshes: impl FnOnce(MeshQuery<'_>) -> T,
        of_convex: impl FnOnce(ConvexQuery<'_>) -> T,
    ) -> Option<T> {
        let (mesh, other, mesh_place) = match [g1, g2].map(rigid_mesh) {
            [Some(mesh1), Some(mesh2)] => {
                let meshes = [mesh1, mesh2];
                let is_answered = self.config.kinds.meshes;
                // Before all else: most pairs that a host asks about are apart.
                return match apart.filter(|_| is_answered) {
                    Some((distance, apart)) if !are_near(meshes, pos12, distance) => Some(apart),
                    _ => self.mesh_query(meshes).map(of_meshes),
                };
            }
            [Some(mesh), None] => (mesh, g2, MeshPlace::First),
            [None, Some(mesh)] => (mesh, g1, MeshPlace::Second),
            [None, None] => return None,
        };
        let is_parrys = balls == Balls::Parrys && other.as_ball().is_some();
        if !self.config.kinds.convex_shapes || is_parrys || !other.is_convex() {
            return None;
        }
        if let Some((distance, apart)) = apart {
            let in_mesh = if mesh_place.is_second() { pos12.inverse() } else { *pos12 };
            if !is_near(mesh, other, &in_mesh, distance) {
                return Some(apart);
            }
        }
        let parts = Parts::of(other).filter(|parts| matches!(parts, Parts::One(_)))?;
        let [mesh] = self.look_at([mesh])?;
        let pose = &PairPose::new(pos12, 0.0);
        let contacts = ContactGenerator::Exact;
        let pair = ConvexPair {
            pose,
            mesh,
            parts,
            mesh_place,
            contacts,
            has_surfaces: false,
            leave_solids: false,
            has_patches: false,
        };
        Some(of_convex(ConvexQuery { search: ConvexSearch::new(&pair, other)?, mesh_place }))
    }

    /// Two rigid meshes, to be asked about; `None` if Parry must answer.
    fn mesh_query<'a>(&'a self, meshes: [&'a TriMesh; 2]) -> Option<MeshQuery<'a>> {
        let meshes = self.config.kinds.meshes.then(|| self.look_at(meshes))??;
        Some(MeshQuery { cache: &self.cache, meshes })
    }

    /// The contacts of a pair of shapes, if SBBK answers for them.
    fn answer<M, C>(
        &self,
        pos12: &Pose,
        [g1, g2]: [&dyn Shape; 2],
        prediction: Real,
        manifolds: &mut Vec<ContactManifold<M, C>>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Answer
    where
        M: Default + Clone + Send + Sync + 'static,
        C: Default + Copy + Send + Sync + 'static,
    {
        let SbbkConfig { contacts, contact_set, height_fields, detail, kinds, .. } = self.config;
        let is_exact = contacts == ContactGenerator::Exact;
        let has_surfaces = is_exact && contact_set == ContactSet::Surfaces;
        let leave_solids = has_surfaces && self.config.convex_leave_solids;
        let has_patches = is_exact && detail == ContactDetail::Patches;
        // Of such a pair nothing needs to be kept while it is apart. One that has manifolds must keep a
        // workspace: Rapier takes a missing one for a new pair, and keeps pointers to manifolds that are gone.
        let is_new = workspace.is_none() && manifolds.is_empty();
        let (mesh, other, mesh_place) = match (g1.as_trimesh(), g2.as_trimesh()) {
            (Some(mesh1), Some(mesh2)) => {
                if !kinds.meshes {
                    return Answer::Unsupported;
                }
                let meshes = [mesh1, mesh2];
                if is_new
                    && self.are_apart(are_near(meshes, pos12, prediction), meshes)
                    && !(has_surfaces && may_be_inside(meshes, pos12))
                {
                    return self.counted(Answer::Apart);
                }
                let Some(meshes) = self.look_at(meshes) else {
                    return Answer::Unsupported;
                };
                let pose = &PairPose::new(pos12, prediction);
                let pair = MeshPair { pose, meshes, contacts, has_surfaces, has_patches };
                return self.ask(&pair, manifolds, workspace);
            }
            (Some(mesh), None) => (mesh, g2, MeshPlace::First),
            (None, Some(mesh)) => (mesh, g1, MeshPlace::Second),
            (None, None) => return Answer::Unsupported,
        };
        if kinds.convex_shapes
            && let Some(ball) =
                other.as_ball().filter(|ball| !leave_solids && is_few(mesh, ball, prediction))
        {
            let is_broken = self.is_broken(mesh);
            let pair = FewPair { mesh, is_broken, ball, mesh_place, has_surfaces };
            return self.touch_few(pair, pos12, prediction, manifolds, workspace);
        }
        let is_answered = |parts: &Parts<'_>| match parts {
            Parts::One(_) => kinds.convex_shapes,
            Parts::Many(_) => kinds.composites,
        };
        let parts = Parts::of(other).filter(is_answered);
        let field = other.as_heightfield().filter(|_| kinds.height_fields);
        if parts.is_none() && field.is_none() {
            return Answer::Unsupported;
        }
        // Parry's routine sees a little farther than the prediction distance.
        if is_new && parts.is_some() && is_exact && !leave_solids {
            let in_mesh = if mesh_place.is_second() { pos12.inverse() } else { *pos12 };
            if self.are_apart(is_near(mesh, other, &in_mesh, prediction), [mesh]) {
                return self.counted(Answer::Apart);
            }
        }
        let Some([mesh]) = self.look_at([mesh]) else {
            return Answer::Unsupported;
        };
        let pose = &PairPose::new(pos12, prediction);
        if let Some(parts) = parts {
            let pair = ConvexPair {
                pose,
                mesh,
                parts,
                mesh_place,
                contacts,
                has_surfaces,
                leave_solids,
                has_patches,
            };
            self.ask(&pair, manifolds, workspace)
        } else if let Some(field) = field {
            let has_ground = height_fields == SurfaceKind::Solid;
            let pair = FieldPair {
                pose,
                mesh,
                field,
                mesh_place,
                contacts,
                has_surfaces,
                has_ground,
                has_patches,
            };
            self.ask(&pair, manifolds, workspace)
        } else {
            Answer::Unsupported
        }
    }

    /// Whether shapes are apart, if Parry's hierarchies say so: above a vertex that is NaN they mean
    /// nothing.
    fn are_apart<const COUNT: usize>(&self, are_near: bool, meshes: [&TriMesh; COUNT]) -> bool {
        !are_near && !meshes.iter().any(|mesh| self.is_broken(mesh))
    }

    /// Whether a mesh may deform and has vertices that are NaN or infinite.
    fn is_broken(&self, mesh: &TriMesh) -> bool {
        mesh.is_deformable() && self.cache.look_at(mesh).is_some_and(|mesh| mesh.is_broken())
    }

    /// The contacts of a mesh and a ball that touches few triangles, counted.
    fn touch_few<M, C>(
        &self,
        pair: FewPair<'_>,
        pos12: &Pose,
        prediction: Real,
        manifolds: &mut Vec<ContactManifold<M, C>>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Answer
    where
        M: Default + Clone + Send + Sync + 'static,
        C: Default + Copy + Send + Sync + 'static,
    {
        let is_first = workspace.is_none();
        pair.answer(pos12, prediction, manifolds, workspace);
        if is_first && workspace.is_some() {
            self.cache.met();
        }
        self.counted(if workspace.is_some() { Answer::Descended } else { Answer::Apart })
    }

    /// An answer that took no descent, counted.
    fn counted(&self, answer: Answer) -> Answer {
        if self.config.count_queries {
            self.counters.add(answer, &DescentCounts::default());
        }
        answer
    }

    /// Meshes as a query sees them; `None`, and counted, if only Parry can answer for one.
    fn look_at<'a, const COUNT: usize>(
        &self,
        meshes: [&'a TriMesh; COUNT],
    ) -> Option<[Hierarchy<'a>; COUNT]> {
        let seen = meshes.map(|mesh| self.cache.look_at(mesh));
        if seen.iter().any(Option::is_none) {
            self.counters.add_unsupported();
            return None;
        }
        Some(seen.map(|mesh| mesh.expect("all are there")))
    }

    /// The contacts of a pair, counted; `Unsupported` if Parry must answer.
    fn ask<M, C>(
        &self,
        pair: &impl Pair,
        manifolds: &mut Vec<ContactManifold<M, C>>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Answer
    where
        M: Default + Clone + Send + Sync + 'static,
        C: Default + Copy + Send + Sync + 'static,
    {
        if !self.config.count_queries {
            return answer(pair, &self.cache, (), manifolds, workspace);
        }
        let mut counts = DescentCounts::default();
        let answer = answer(pair, &self.cache, &mut counts, manifolds, workspace);
        self.counters.add(answer, &counts);
        answer
    }
}

impl Default for SbbkDispatcher {
    fn default() -> Self {
        Self::new(SbbkConfig::default())
    }
}

impl fmt::Debug for SbbkDispatcher {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SbbkDispatcher")
            .field("config", &self.config)
            .field("stats", &self.stats())
            .finish()
    }
}

/// Keeps the tree of a mesh, see [`SbbkDispatcher::prepare`] and
/// [`SbbkDispatcher::prepare_shape`].
#[derive(Clone)]
pub struct PreparedTree {
    tree: PreparedRef,
    _registered: Option<Arc<Registered<PreparedRef>>>,
}

impl PreparedTree {
    /// The tree itself.
    pub fn tree(&self) -> &Tree {
        &self.tree.prepared().tree
    }

    /// Says what the mesh bounds, where SBBK would take it for something else: a vase with a narrow
    /// neck for a solid, a mask for a sheet ([`InsideOut`](SurfaceKind::InsideOut) is met as a sheet). For
    /// all meshes with this content, as long as one of them is in use; of more than 8192 triangles for
    /// those that [`prepare_shape`](SbbkDispatcher::prepare_shape) has registered, as all others are
    /// sheets. Say it before the mesh meets another, and once: false if something else was said before.
    pub fn bounds(&self, kind: SurfaceKind) -> bool {
        self.tree.settle_kind(kind)
    }
}

impl fmt::Debug for PreparedTree {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("PreparedTree").field(self.tree().stats()).finish()
    }
}

/// Who answers queries without manifolds about a ball.
#[derive(PartialEq)]
enum Balls {
    /// SBBK, as for other convex shapes.
    Ours,
    /// Parry: exactly, in less time, and inside a mesh with pseudo-normals a ball meets it.
    Parrys,
}

/// A mesh that can have a tree, and that queries without manifolds are answered for. Meshes that
/// deform have none, and such queries about them are Parry's.
fn rigid_mesh(shape: &dyn Shape) -> Option<&TriMesh> {
    shape.as_trimesh().filter(|mesh| !mesh.is_deformable())
}

impl<M, C> PersistentQueryDispatcher<M, C> for SbbkDispatcher
where
    M: Default + Clone + Send + Sync + 'static,
    C: Default + Copy + Send + Sync + 'static,
{
    fn contact_manifolds(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
        manifolds: &mut Vec<ContactManifold<M, C>>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Result<(), Unsupported> {
        let answer = self.answer(pos12, [g1, g2], prediction, manifolds, workspace);
        if answer != Answer::Unsupported {
            return Ok(());
        }
        DefaultQueryDispatcher.contact_manifolds(pos12, g1, g2, prediction, manifolds, workspace)
    }

    fn contact_manifold_convex_convex(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        normal_constraints1: Option<&dyn NormalConstraints>,
        normal_constraints2: Option<&dyn NormalConstraints>,
        prediction: Real,
        manifold: &mut ContactManifold<M, C>,
    ) -> Result<(), Unsupported> {
        if let (ContactGenerator::Exact, Some(triangle1), Some(triangle2)) =
            (self.config.contacts, g1.as_triangle(), g2.as_triangle())
        {
            let constraints = [normal_constraints1, normal_constraints2];
            let triangles = [triangle1, triangle2];
            TriangleContacts::default().update(pos12, triangles, constraints, prediction, manifold);
            return Ok(());
        }
        DefaultQueryDispatcher.contact_manifold_convex_convex(
            pos12,
            g1,
            g2,
            normal_constraints1,
            normal_constraints2,
            prediction,
            manifold,
        )
    }
}

/// Queries without manifolds: of two rigid meshes from their trees or Parry's hierarchies, of one and
/// a convex shape from Parry's hierarchy; all others, and casts of meshes without trees, are Parry's.
impl QueryDispatcher for SbbkDispatcher {
    fn intersection_test(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeIntersection, Unsupported> {
        let found = self.search(
            pos12,
            [g1, g2],
            Balls::Parrys,
            Some((0.0, ShapeIntersection::new(false))),
            |meshes| meshes.intersection(pos12),
            |pair| pair.intersection(),
        );
        match found {
            Some(found) => Ok(found),
            None => DefaultQueryDispatcher.intersection_test(pos12, g1, g2),
        }
    }

    fn distance(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeDistance, Unsupported> {
        let found = self.search(
            pos12,
            [g1, g2],
            Balls::Parrys,
            None,
            |meshes| meshes.distance(pos12),
            |pair| pair.distance(),
        );
        match found {
            Some(found) => Ok(found),
            None => DefaultQueryDispatcher.distance(pos12, g1, g2),
        }
    }

    fn contact(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: Real,
    ) -> Result<Option<Contact>, Unsupported> {
        let found = self.search(
            pos12,
            [g1, g2],
            Balls::Parrys,
            Some((prediction, None)),
            |meshes| meshes.contact(pos12, prediction),
            |pair| pair.contact(prediction),
        );
        match found {
            Some(found) => Ok(found),
            None => DefaultQueryDispatcher.contact(pos12, g1, g2, prediction),
        }
    }

    fn closest_points(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        max_dist: Real,
    ) -> Result<ClosestPoints, Unsupported> {
        let found = self.search(
            pos12,
            [g1, g2],
            Balls::Parrys,
            Some((max_dist, ClosestPoints::Disjoint)),
            |meshes| meshes.closest_points(pos12, max_dist),
            |pair| pair.closest_points(max_dist),
        );
        match found {
            Some(found) => Ok(found),
            None => DefaultQueryDispatcher.closest_points(pos12, g1, g2, max_dist),
        }
    }

    fn cast_shapes(
        &self,
        pos12: &Pose,
        local_vel12: Vector,
        g1: &dyn Shape,
        g2: &dyn Shape,
        options: ShapeCastOptions,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        let found = self.search(
            pos12,
            [g1, g2],
            Balls::Ours,
            None,
            |meshes| meshes.cast(pos12, local_vel12, options),
            |pair| Some(pair.cast(local_vel12, options)),
        );
        match found.flatten() {
            Some(hit) => Ok(hit),
            None => DefaultQueryDispatcher.cast_shapes(pos12, local_vel12, g1, g2, options),
        }
    }

    fn cast_shapes_nonlinear(
        &self,
        motion1: &NonlinearRigidMotion,
        g1: &dyn Shape,
        motion2: &NonlinearRigidMotion,
        g2: &dyn Shape,
        start_time: Real,
        end_time: Real,
        stop_at_penetration: bool,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        let motions = [motion1, motion2];
        let cast =
            &NonlinearCast { motions, start: start_time, end: end_time, stop_at_penetration };
        let [pos1, pos2] = motions.map(|motion| motion.position_at_time(start_time));
        let found = self.search(
            &pos1.inv_mul(&pos2),
            [g1, g2],
            Balls::Ours,
            None,
            |meshes| meshes.cast_nonlinear(cast),
            |pair| Some(pair.cast_nonlinear(cast)),
        );
        match found.flatten() {
            Some(hit) => Ok(hit),
            None => DefaultQueryDispatcher.cast_shapes_nonlinear(
                motion1,
                g1,
                motion2,
                g2,
                start_time,
                end_time,
                stop_at_penetration,
            ),
        }
    }
}
