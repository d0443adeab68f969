use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicU8, AtomicUsize, Ordering};

use arrayvec::ArrayVec;
use parry3d::shape::TriMesh;
use sbbk_core::surface::{Surface, SurfaceKind, kind};
use sbbk_core::tree::{BuildError, LayerPlan, Tree};

use super::flags::TriangleFlags;
use super::neighbours::Neighbours;
use super::rays::MeshRays;

/// Tree and surface of a mesh, for all colliders with equal geometry. A thread computes a part when
/// the thread needs that part. Two threads may compute one tree or surface at once, and neither
/// waits. Kind and tips are computed once, and other threads wait for these.
#[derive(Default)]
pub(crate) struct MeshData {
    /// Surface of an analysed mesh, and flags of its triangles.
    analysed: OnceLock<(Surface, Box<[TriangleFlags]>)>,
    /// Neighbours of triangles of a mesh that is not analysed as a whole.
    neighbours: OnceLock<Neighbours>,
    /// True if the mesh needs no analysis as a whole.
    is_local: OnceLock<bool>,
    /// Kind of a mesh that is not analysed as a whole.
    pub(super) kind: OnceLock<SurfaceKind>,
    tree: OnceLock<Tree>,
    has_build_begun: AtomicBool,
    declared_kind: AtomicU8,
    /// Tips of the mesh, once a query needed them.
    pub(super) tips: OnceLock<Tips>,
    /// Bytes that the store counts for this mesh, 0 if the mesh is not among the recent ones.
    pub(super) counted_bytes: AtomicUsize,
    /// True if the mesh was used again since it became a recent one.
    pub(super) was_used_again: AtomicBool,
}

/// [`MeshData::declared_kind`] by the number that stands for it.
const KINDS: [Option<SurfaceKind>; 4] =
    [None, Some(SurfaceKind::Solid), Some(SurfaceKind::Sheet), Some(SurfaceKind::InsideOut)];

/// Half-edges that begin at the vertices of a mesh that are farthest along 14 directions.
pub(crate) type Tips = ArrayVec<u32, 14>;

impl MeshData {
    pub(crate) fn tree(&self) -> Option<&Tree> {
        self.tree.get()
    }

    pub(super) fn has_build_begun(&self) -> bool {
        self.has_build_begun.load(Ordering::Relaxed)
    }

    /// Returns false if another call was the first to begin a build.
    pub(super) fn begin_build(&self) -> bool {
        !self.has_build_begun.swap(true, Ordering::Relaxed)
    }

    /// Builds the tree, unless it is there. Returns true if this call built it.
    pub(super) fn build(
        &self,
        mesh: &TriMesh,
        layers: Option<LayerPlan>,
    ) -> Result<bool, BuildError> {
        if self.tree.get().is_some() {
            return Ok(false);
        }
        self.has_build_begun.store(true, Ordering::Relaxed);
        let tree = Tree::build(mesh.vertices(), mesh.indices(), layers)?;
        Ok(self.tree.set(tree).is_ok())
    }

    /// Returns true if the mesh has not been analysed as a whole, and `find` finds that this is not
    /// needed.
    pub(super) fn is_local(&self, find: impl FnOnce() -> bool) -> bool {
        self.analysed.get().is_none() && *self.is_local.get_or_init(find)
    }

    /// Returns the neighbours of triangles of `mesh`, whose data this must be.
    pub(super) fn neighbours(&self, mesh: &TriMesh) -> &Neighbours {
        self.neighbours.get_or_init(|| Neighbours::new(mesh.indices().len()))
    }

    pub(super) fn surface(&self) -> Option<&Surface> {
        Some(&self.analysed.get()?.0)
    }

    /// The flags of the triangles of an analysed mesh.
    #[inline]
    pub(super) fn flags(&self) -> &[TriangleFlags] {
        self.analysed.get().map_or(&[], |(_, flags)| flags)
    }

    /// Computes the surface of `mesh`, whose data this must be.
    pub(super) fn analyse(&self, mesh: &TriMesh) -> &Surface {
        let surface = Surface::new(mesh.vertices(), mesh.indices(), &MeshRays(mesh));
        let flags = mesh.indices().iter().map(|_| TriangleFlags::default()).collect();
        // Another thread may have set the same surface meanwhile.
        let _ = self.analysed.set((surface, flags));
        self.surface().expect("set just now")
    }

    /// The kind that a user declared, else the computed one, if it has been computed.
    pub(crate) fn kind(&self) -> Option<SurfaceKind> {
        let computed = || self.surface().map(Surface::kind).or(self.kind.get().copied());
        self.declared_kind().or_else(computed)
    }

    /// Returns the kind of `mesh`, whose data this must be, from up to 4096 rays, and more at
    /// walls.
    pub(super) fn kind_by_rays(&self, mesh: &TriMesh) -> SurfaceKind {
        *self.kind.get_or_init(|| kind(&MeshRays(mesh)))
    }

    #[inline]
    pub(super) fn declared_kind(&self) -> Option<SurfaceKind> {
        KINDS[usize::from(self.declared_kind.load(Ordering::Relaxed))]
    }

    pub(crate) fn declare_kind(&self, kind: SurfaceKind) {
        let number = KINDS.iter().position(|&of_number| of_number == Some(kind));
        self.declared_kind.store(number.expect("all kinds are listed") as u8, Ordering::Relaxed);
    }

    /// Memory of the mesh in the store, with its entries in maps that may be half empty.
    pub(super) fn bytes(&self) -> usize {
        const ENTRIES: usize = 2 * (size_of::<u128>() + 2 * size_of::<usize>());
        const REFERENCE_COUNTS: usize = 2 * size_of::<usize>();
        let tree = self.tree().map_or(0, |tree| tree.stats().bytes);
        let surface = self.surface().map_or(0, |surface| surface.bytes() - size_of::<Surface>());
        let flags = size_of_val(self.flags());
        let neighbours = self.neighbours.get().map_or(0, Neighbours::bytes);
        size_of::<Self>() + tree + surface + flags + neighbours + ENTRIES + REFERENCE_COUNTS
    }
}
