use std::sync::{Arc, OnceLock};

use parry3d::shape::{CompositeShape, TriMesh};
use sbbk_core::surface::{HalfEdges, IndexedTriangles, OneRing, SurfaceKind};

use super::cache::{PreparedRef, TreeCache};
use super::hierarchy::Hierarchy;
use super::identity::MeshToken;
use super::neighbours::{NearTwins, Neighbours};
use super::prepared::PreparedMesh;

/// A mesh as a pair of colliders knows it from query to query: how to tell whether it still is that
/// mesh, and its tree, if there is one.
#[derive(Clone, Default)]
pub(crate) enum KnownMesh {
    /// No query has needed it yet.
    #[default]
    Unknown,
    /// Valid while the token is, for the same owner.
    Rigid {
        token: MeshToken,
        owner: u64,
        entry: OnceLock<PreparedRef>,
        /// Without a tree, for so many more queries; not known before the first one.
        wait: Option<u8>,
        /// Whether answers may depend on `entry`, as it could be had at the first query of the pair:
        /// settled there.
        is_whole: bool,
        neighbours: Neighbours,
    },
    /// May be another one at any time: has no tree.
    Deformable,
}

/// What became of a mesh since the last query of the pair.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Change {
    /// Nothing.
    Unchanged,
    /// It was not known, or another dispatcher knew it: nothing is known, but it need not be another
    /// mesh.
    Unknown,
    /// Its vertices may have moved.
    Deformed,
    /// It is another mesh: its triangles are not those of old manifolds.
    Replaced,
}

impl KnownMesh {
    pub(crate) fn is_unknown(&self) -> bool {
        matches!(self, Self::Unknown)
    }

    /// Takes note of the mesh as it is now.
    pub(crate) fn update(&mut self, seen: &Hierarchy<'_>) -> Change {
        if seen.mesh.is_deformable() {
            let is_other = matches!(self, Self::Rigid { .. });
            *self = Self::Deformable;
            return if is_other { Change::Replaced } else { Change::Deformed };
        }
        let Hierarchy { token: seen, owner: asking, .. } = *seen;
        let change = match self {
            Self::Rigid { token, owner, .. } if *token == seen && *owner == asking => {
                return Change::Unchanged;
            }
            Self::Rigid { token, .. } if *token == seen => Change::Unknown,
            Self::Unknown => Change::Unknown,
            Self::Rigid { .. } | Self::Deformable => Change::Replaced,
        };
        *self = Self::Rigid {
            token: seen,
            owner: asking,
            entry: OnceLock::new(),
            wait: None,
            is_whole: false,
            neighbours: Neighbours::default(),
        };
        change
    }

    /// What is known of a mesh that [`update`](Self::update) has seen and that meets one of so many
    /// triangles: what all pairs share of it, [if that may be looked for](TreeCache::is_whole) or it is
    /// registered, with its tree if that is there or can be had at once.
    ///
    /// The first query does not look for the tree of a mesh that is not registered: to tell which mesh
    /// it is takes a hash of all of it, 40 % of a query of two meshes of some 1000 triangles that finds
    /// nothing. Many pairs never touch, and hosts without workspaces ask each pair but once.
    pub(crate) fn look_up<'a>(
        &'a mut self,
        mesh: &'a TriMesh,
        other_count: usize,
        cache: &'a Arc<TreeCache>,
    ) -> Option<Known<'a>> {
        self.look(mesh, other_count, cache, true)
    }

    /// The same of a mesh that meets no other mesh, and has no use for a tree.
    pub(crate) fn look_around<'a>(
        &'a mut self,
        mesh: &'a TriMesh,
        cache: &'a Arc<TreeCache>,
    ) -> Option<MeshSurface<'a>> {
        Some(self.look(mesh, 0, cache, false)?.surface)
    }

    fn look<'a>(
        &'a mut self,
        mesh: &'a TriMesh,
        other_count: usize,
        cache: &'a Arc<TreeCache>,
        wants_tree: bool,
    ) -> Option<Known<'a>> {
        /// Queries from one try to the next. More: trees come later; fewer: each costs two locks.
        const PATIENCE: u8 = 7;
        let Self::Rigid { entry, wait, is_whole, neighbours, .. } = self else {
            return None;
        };
        let is_first = wait.is_none();
        let wait = wait.get_or_insert_default();
        if *wait == 0 && entry.get().is_none_or(|entry| entry.tree().is_none()) {
            if entry.get().is_none() {
                let found = match cache.registered_tree(mesh) {
                    Some(registered) => {
                        *is_whole |= is_first;
                        Some(registered)
                    }
                    None if is_first => {
                        *is_whole = cache.is_whole(mesh, other_count);
                        None
                    }
                    None if !wants_tree => None,
                    None if cache.is_small(mesh) => Some(cache.know(mesh)),
                    None => cache.recognise(mesh),
                };
                *entry = found.map(OnceLock::from).unwrap_or_default();
            }
            if let Some(entry) = entry.get().filter(|_| wants_tree) {
                cache.afford(mesh, entry);
            }
            *wait = if is_first { 0 } else { PATIENCE - 1 };
        } else {
            *wait = wait.saturating_sub(1);
        }
        let tree = entry.get().and_then(|entry| entry.tree());
        let surface = if *is_whole {
            MeshSurface::Whole { entry, cache }
        } else {
            MeshSurface::Near(NearTwins::new(mesh, neighbours))
        };
        Some(Known { tree, surface })
    }
}

/// What a query may know of a rigid mesh.
pub(crate) struct Known<'a> {
    pub(crate) tree: Option<&'a PreparedMesh>,
    pub(crate) surface: MeshSurface<'a>,
}

/// How the triangles of a mesh hang together.
pub(crate) enum MeshSurface<'a> {
    /// Of the mesh as a whole, found when it is needed.
    Whole { entry: &'a OnceLock<PreparedRef>, cache: &'a Arc<TreeCache> },
    /// Where it is met, of a mesh that is too large to be looked at unasked. It is no solid.
    Near(NearTwins<'a>),
}

impl MeshSurface<'_> {
    /// The surface of `mesh`, which must be this one.
    #[inline]
    pub(crate) fn around<'a>(&'a self, mesh: &'a TriMesh) -> OneRing<IndexedTriangles<'a>> {
        let (twins, is_solid): (&dyn HalfEdges, bool) = match self {
            Self::Whole { entry, cache } => {
                let (twins, kind) = entry.get_or_init(|| cache.know(mesh)).surface(mesh);
                (twins, kind == SurfaceKind::Solid)
            }
            Self::Near(twins) => (twins, false),
        };
        let facets =
            IndexedTriangles { twins, vertices: mesh.vertices(), triangles: mesh.indices() };
        OneRing { facets, is_solid }
    }
}

#[cfg(test)]
mod tests {
    use parry3d::shape::{Ball, SharedShape, TriMeshFlags};
    use sbbk_core::tree::BuildOptions;

    use super::*;
    use crate::mesh::credit::Credit;

    /// A ball of so many rows of triangles.
    fn mesh(rows: u32, flags: TriMeshFlags) -> TriMesh {
        let (vertices, triangles) = Ball::new(1.0).to_trimesh(2 * rows, rows);
        TriMesh::with_flags(vertices, triangles, flags).unwrap()
    }

    /// Would catch a mesh that is taken for the one before, or for another than that, or contacts that
    /// another dispatcher has made taken for its own.
    #[test]
    fn what_became_of_a_mesh() {
        let [one, other] = [3, 4].map(|rows| mesh(rows, TriMeshFlags::empty()));
        let soft = mesh(3, TriMeshFlags::DEFORMABLE);
        let seen = |mesh, owner| Hierarchy::new(mesh, MeshToken::of(mesh), owner, false);
        let mut known = KnownMesh::default();
        for (mesh, owner, change) in [
            (&one, 0, Change::Unknown),
            (&one, 0, Change::Unchanged),
            (&one, 1, Change::Unknown),
            (&one, 1, Change::Unchanged),
            (&other, 1, Change::Replaced),
            (&soft, 1, Change::Replaced),
            (&soft, 1, Change::Deformed),
            (&one, 1, Change::Replaced),
        ] {
            assert_eq!(known.update(&seen(mesh, owner)), change);
        }
    }

    /// Would catch a large mesh that is looked at as a whole unasked where small ones meet it, or is not
    /// though it is registered or meets one as large, and one that is taken for a solid where only its
    /// neighbourhood is known.
    #[test]
    fn large_meshes_are_whole_if_they_are_registered_or_meet_large_ones() {
        let cache = Arc::new(TreeCache::new(BuildOptions::default(), 0));
        let shapes = [100, 260].map(|rows| SharedShape::new(mesh(rows, TriMeshFlags::empty())));
        let meshes = shapes.each_ref().map(|shape| shape.as_trimesh().unwrap());
        let [large, larger] = meshes;
        let [count, larger_count] = meshes.map(|mesh| mesh.indices().len());
        assert!(count > Credit::MOST as usize && larger_count > TreeCache::LARGEST_WHOLE);
        let surface_is_solid = |mesh: &TriMesh, other_count| {
            let mut known = KnownMesh::default();
            known.update(&Hierarchy::new(mesh, MeshToken::of(mesh), 0, false));
            let known = known.look_up(mesh, other_count, &cache).unwrap();
            let is_whole = matches!(known.surface, MeshSurface::Whole { .. });
            (is_whole, known.surface.around(mesh).is_solid)
        };
        let small = Credit::MOST as usize;
        assert_eq!(surface_is_solid(large, small), (false, false));
        assert_eq!(surface_is_solid(large, small + 1), (true, true));
        assert_eq!(surface_is_solid(larger, larger_count), (false, false));
        for (shape, mesh) in shapes.iter().zip(meshes) {
            let _registered = cache.register(shape, mesh).unwrap();
            assert_eq!(surface_is_solid(mesh, 0), (true, true));
        }
    }
}
