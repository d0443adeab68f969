//! The dispatcher: construction and registration here, contacts in `contacts.rs`, queries without
//! manifolds in `queries.rs`.

mod contacts;
mod queries;

use std::error::Error;
use std::fmt;
use std::sync::Arc;

use parry3d::shape::{CompositeShape, Shape, SharedShape, TriMesh};
use sbbk_core::surface::SurfaceKind;
use sbbk_core::tree::{BuildError, Tree};

use crate::mesh::{KnownMesh, MeshStore, MeshView, Registered};
use crate::{SbbkConfig, SbbkStats};

/// A query dispatcher for Rapier, and for other hosts of Parry.
///
/// Handles pairs of two meshes, and of a mesh and a convex shape. Also handles contacts of a mesh
/// with compounds, polylines and height fields. All other queries go to Parry's
/// [`DefaultQueryDispatcher`](parry3d::query::DefaultQueryDispatcher), except two triangles in
/// `contact_manifold_convex_convex`. Clones share their trees.
#[derive(Clone)]
pub struct SbbkDispatcher {
    config: SbbkConfig,
    store: Arc<MeshStore>,
}

impl SbbkDispatcher {
    /// Returns a dispatcher without trees.
    pub fn new(config: SbbkConfig) -> Self {
        let store = MeshStore::new(config.layers, config.idle_tree_bytes);
        Self { config, store: Arc::new(store) }
    }

    /// The configuration of this dispatcher.
    pub fn config(&self) -> &SbbkConfig {
        &self.config
    }

    /// Registers a mesh by its address: builds the tree of a large mesh at load time, and detects
    /// whether the mesh is a solid.
    ///
    /// Takes about 0.85 µs and 92 bytes a triangle.
    ///
    /// Use the shape and its clones for colliders, and keep the result: when it and its clones are
    /// dropped, the registration ends. Meanwhile `SharedShape::make_mut` edits a copy, which is not
    /// registered. Returns `None` for a shape that is no rigid mesh.
    ///
    /// ```
    /// use parry3d::shape::{Ball, SharedShape};
    /// use rapier_integration::{SbbkDispatcher, SurfaceKind};
    ///
    /// let (vertices, triangles) = Ball::new(1.0).to_trimesh(100, 100);
    /// let shape = SharedShape::trimesh(vertices, triangles)?;
    /// let dispatcher = SbbkDispatcher::default();
    /// let prepared = dispatcher.prepare_shape(&shape)?.expect("a rigid mesh"); // keep it
    /// assert_eq!(prepared.surface_kind(), SurfaceKind::Solid);
    /// assert!(dispatcher.is_registered(shape.as_trimesh().expect("a mesh")));
    /// // In Rapier: `ColliderBuilder::new(shape.clone())`, once for each collider.
    /// assert!(dispatcher.prepare_shape(&SharedShape::ball(1.0))?.is_none());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Names the defect of the mesh, for example a vertex that is NaN.
    #[must_use = "the registration ends when the result is dropped"]
    pub fn prepare_shape(&self, shape: &SharedShape) -> Result<Option<PreparedTree>, PrepareError> {
        let Some(mesh) = rigid_mesh(&*shape.0) else {
            return Ok(None);
        };
        Ok(Some(PreparedTree(self.store.register(mesh, Some(shape))?)))
    }

    /// Registers a mesh and all its copies, and builds its tree now instead of in a step. Takes
    /// about 0.85 µs and 92 bytes a triangle.
    ///
    /// Each new pair finds the tree by a hash of the content, which takes about 4 ns a triangle:
    /// [`prepare_shape`](Self::prepare_shape) is better for large meshes that are one shape and its
    /// clones. Meshes that touch no other rigid mesh need no tree.
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
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Names the defect of the mesh, for example a vertex that is NaN, or the flag `DEFORMABLE`.
    #[must_use = "the registration ends when the result is dropped"]
    pub fn prepare(&self, mesh: &TriMesh) -> Result<PreparedTree, PrepareError> {
        if mesh.is_deformable() {
            return Err(PrepareError(Defect::Deformable));
        }
        Ok(PreparedTree(self.store.register(mesh, None)?))
    }

    /// True if the mesh is registered: by [`prepare_shape`](Self::prepare_shape), or as one of more
    /// than 8192 triangles by [`prepare`](Self::prepare).
    pub fn is_registered(&self, mesh: &TriMesh) -> bool {
        self.store.registered(mesh).is_some()
    }

    /// Returns what this mesh is taken for. A deformable mesh is a sheet, and so is one with a
    /// vertex that is NaN or infinite in its box. Analyses the mesh if no query has done so, in up
    /// to 50 ms.
    pub fn surface_kind(&self, mesh: &TriMesh) -> SurfaceKind {
        let Some(view) = self.store.view(mesh) else { return SurfaceKind::Sheet };
        let mut known = KnownMesh::default();
        known.update(&view);
        known.acquire(&view, false).map_or(SurfaceKind::Sheet, |surface| surface.kind())
    }

    /// Counts of meshes and queries so far. Takes time in proportion to the number of meshes.
    pub fn stats(&self) -> SbbkStats {
        self.store.stats()
    }

    /// Drops the trees that no pair of colliders uses, see [`SbbkConfig::idle_tree_bytes`].
    pub fn release_idle_trees(&self) {
        self.store.release_idle();
    }

    /// Returns a view of a mesh; `None`, and counts the query, if only Parry can answer.
    #[inline]
    fn view<'a>(&'a self, mesh: &'a TriMesh) -> Option<MeshView<'a>> {
        let view = self.store.view(mesh);
        if view.is_none() {
            self.store.counters.unsupported.raise();
        }
        view
    }
}

impl Default for SbbkDispatcher {
    fn default() -> Self {
        Self::new(SbbkConfig::default())
    }
}

impl From<SbbkConfig> for SbbkDispatcher {
    fn from(config: SbbkConfig) -> Self {
        Self::new(config)
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

/// Keeps a mesh prepared, see [`SbbkDispatcher::prepare_shape`] and [`SbbkDispatcher::prepare`].
#[must_use = "the registration ends when this is dropped"]
#[derive(Clone)]
pub struct PreparedTree(Arc<Registered>);

impl PreparedTree {
    /// The tree.
    pub fn tree(&self) -> &Tree {
        self.0.data.tree().expect("prepared")
    }

    /// Returns what SBBK takes the mesh for.
    pub fn surface_kind(&self) -> SurfaceKind {
        self.0.data.kind().expect("prepared")
    }

    /// Overrides the detected kind. A mesh that is declared [`Solid`](SurfaceKind::Solid) is no
    /// room: it also pushes out mesh bodies that are wholly inside. A detected solid is a room, so
    /// declaring what was detected is a change. A declared [`Sheet`](SurfaceKind::Sheet) has no
    /// inside.
    ///
    /// Holds for all meshes with this content while one of them is in use. One of more than 8192
    /// triangles must be registered. [`InsideOut`](SurfaceKind::InsideOut) is a solid with inward
    /// normals. Bodies in it are in a room.
    pub fn set_surface_kind(&self, kind: SurfaceKind) {
        self.0.data.declare_kind(kind);
    }

    /// Former name of [`set_surface_kind`](Self::set_surface_kind). Returns true.
    #[deprecated(since = "0.2.0", note = "use `set_surface_kind`")]
    pub fn bounds(&self, kind: SurfaceKind) -> bool {
        self.set_surface_kind(kind);
        true
    }
}

impl fmt::Debug for PreparedTree {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = self.surface_kind();
        f.debug_tuple("PreparedTree").field(&kind).field(self.tree().stats()).finish()
    }
}

/// Says why a mesh cannot be prepared.
#[derive(Clone, Debug, PartialEq)]
pub struct PrepareError(Defect);

#[derive(Clone, Debug, PartialEq)]
enum Defect {
    NoTree(BuildError),
    Deformable,
}

impl From<BuildError> for PrepareError {
    fn from(cause: BuildError) -> Self {
        Self(Defect::NoTree(cause))
    }
}

impl fmt::Display for PrepareError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let cause = match &self.0 {
            Defect::NoTree(cause) => cause,
            Defect::Deformable => {
                return f.write_str(
                    "cannot prepare this mesh: it has the flag `DEFORMABLE`. \
                     Use it unprepared, or remove the flag if it does not change",
                );
            }
        };
        write!(f, "cannot prepare this mesh: {cause}. ")?;
        f.write_str(match cause {
            BuildError::NotFinite { .. } => {
                "Remove or repair the triangles of that vertex. Until then their contacts are lost"
            }
            BuildError::NoTriangles => "Leave out its collider",
            BuildError::TooManyTriangles { .. } => "Split it into several colliders",
            BuildError::IndexOutOfRange { .. } => "Check how its index buffer was made",
            _ => "Use the default `SbbkConfig::layers`",
        })
    }
}

impl Error for PrepareError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match &self.0 {
            Defect::NoTree(cause) => Some(cause),
            Defect::Deformable => None,
        }
    }
}

/// Returns the mesh that a shape is, if it is one and cannot deform.
fn rigid_mesh(shape: &dyn Shape) -> Option<&TriMesh> {
    shape.as_trimesh().filter(|mesh| !mesh.is_deformable())
}
