//! The dispatcher: what a host makes and asks for trees. Contacts are answered in `contacts.rs`, queries
//! without manifolds in `queries.rs`.

mod contacts;
mod queries;

use std::fmt;
use std::sync::Arc;

use parry3d::shape::{CompositeShape, Shape, SharedShape, TriMesh};
use sbbk_core::surface::SurfaceKind;
use sbbk_core::tree::{BuildError, Tree};

use crate::mesh::{Hierarchy, PreparedRef, Registered, TreeCache};
use crate::stats::QueryCounters;
use crate::{SbbkConfig, SbbkStats};

/// A query dispatcher that answers pairs of triangle meshes, and the contacts of meshes with convex
/// shapes, compounds, polylines and height fields. All else goes to Parry's
/// [`DefaultQueryDispatcher`](parry3d::query::DefaultQueryDispatcher).
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
    /// all meshes with this content, as long as one of them is in use; of more than 8192 triangles it takes
    /// [`prepare_shape`](SbbkDispatcher::prepare_shape), as others are sheets to smaller meshes. Say it
    /// before the mesh meets another, and once: false if something else was said before.
    pub fn bounds(&self, kind: SurfaceKind) -> bool {
        self.tree.settle_kind(kind)
    }
}

impl fmt::Debug for PreparedTree {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("PreparedTree").field(self.tree().stats()).finish()
    }
}

/// A mesh that can have a tree, and that queries without manifolds are answered for. Meshes that
/// deform have none, and such queries about them are Parry's.
fn rigid_mesh(shape: &dyn Shape) -> Option<&TriMesh> {
    shape.as_trimesh().filter(|mesh| !mesh.is_deformable())
}
