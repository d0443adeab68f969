use std::sync::{Arc, OnceLock, Weak};

use glamx::Vec3;
use parry3d::math::Real;
use sbbk_core::surface::{Around, PAIRED, PlaceMemo, Side, Surface, SurfaceKind, is_surely_open};
use sbbk_core::tree::Tree;

use super::data::{MeshData, Tips};
use super::facets::{MeshFacets, Twins};
use super::identity::MeshToken;
use super::rays::MeshRays;
use super::store::{Registered, is_small};
use super::view::{MeshView, nearest};

/// A pair's knowledge of one of its meshes, kept from query to query. Valid for meshes with the
/// same token, and for the same store.
#[derive(Clone, Default)]
pub(crate) struct KnownMesh {
    /// `None` before the first query, and for a deformable mesh, which may change before any query.
    token: Option<MeshToken>,
    is_deformable: bool,
    store_id: u64,
    /// Registrations of the store when the registered meshes were last searched for this one.
    searched_at: Option<u64>,
    /// Registration of the mesh, if the last search found one.
    registration: Option<Weak<Registered>>,
    declared_kind: Option<SurfaceKind>,
    data: OnceLock<Arc<MeshData>>,
}

/// Change of a mesh since the last query of the pair.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Change {
    Unchanged,
    /// First query, another store, a registration that changes what the mesh is taken for, or
    /// vertices that may have moved. The triangles are the same.
    Unknown,
    /// The mesh is another one. Old manifolds refer to triangles that it does not have.
    Replaced,
}

impl KnownMesh {
    /// Compares with the mesh of the last query, and stores the one of this query.
    pub(crate) fn update(&mut self, view: &MeshView<'_>) -> Change {
        let (is_deformable, store_id) = (!view.is_rigid(), view.store.id);
        let token = (!is_deformable).then(|| MeshToken::of(view.mesh));
        let is_same = self.token == token;
        if is_same && !is_deformable && self.store_id == store_id {
            return self.refresh(view);
        }
        let is_first = self.token.is_none() && !self.is_deformable;
        *self = Self { token, is_deformable, store_id, ..Self::default() };
        if is_same || is_first { Change::Unknown } else { Change::Replaced }
    }

    /// Returns the surface of a rigid mesh, with its [tree](LazySurface::tree) if there is one.
    /// Call [`update`](Self::update) first.
    ///
    /// The first query does not look for an unregistered mesh: that takes a hash of all content,
    /// and many pairs never touch. Later ones build the tree of a small mesh, if they need it.
    pub(crate) fn acquire<'a>(
        &'a mut self,
        view: &'a MeshView<'a>,
        needs_tree: bool,
    ) -> Option<LazySurface<'a>> {
        self.token.as_ref()?;
        let (MeshView { mesh, store, .. }, is_first) = (view, self.searched_at.is_none());
        if is_first {
            self.searched_at = Some(store.registrations());
            self.search(view);
        }
        if needs_tree && !is_first && is_small(mesh.indices().len()) {
            store.build_within_budget(mesh, self.data.get_or_init(|| store.entry(mesh)));
        }
        let (declared, memo) = Default::default();
        Some(LazySurface { data: &self.data, view, declared, memo })
    }

    /// Takes note of registrations and declared kinds since the last query.
    fn refresh(&mut self, view: &MeshView<'_>) -> Change {
        let registrations = view.store.registrations();
        if self.searched_at.is_some_and(|at| at != registrations) {
            self.searched_at = Some(registrations);
            let is_held = self.registration.as_ref().is_some_and(|it| it.strong_count() > 0);
            // A search may hash a large mesh.
            if !is_held && self.search(view) {
                return Change::Unknown;
            }
        }
        let declared_kind = self.data.get().and_then(|data| data.declared_kind());
        let is_same = std::mem::replace(&mut self.declared_kind, declared_kind) == declared_kind;
        if is_same { Change::Unchanged } else { Change::Unknown }
    }

    /// Searches the registration of the mesh. Returns true if its data are others now.
    fn search(&mut self, view: &MeshView<'_>) -> bool {
        let found = view.store.registered(view.mesh);
        let known = self.data.get().filter(|_| self.registration.is_some());
        let is_other = found.as_ref().map(|it| Arc::as_ptr(&it.data)) != known.map(Arc::as_ptr);
        self.registration = found.as_ref().map(Arc::downgrade);
        if is_other {
            self.declared_kind = found.as_ref().and_then(|it| it.data.declared_kind());
            self.data = found.map(|it| Arc::clone(&it.data).into()).unwrap_or_default();
        }
        is_other
    }
}

/// The surface of a mesh, whose adjacency and kind are computed at the first contact.
pub(crate) struct LazySurface<'a> {
    data: &'a OnceLock<Arc<MeshData>>,
    view: &'a MeshView<'a>,
    declared: OnceLock<(SurfaceKind, Option<Side>)>,
    memo: PlaceMemo,
}

impl<'a> LazySurface<'a> {
    /// Returns the tree of the mesh, if there is one.
    pub(crate) fn tree(&self) -> Option<&'a Tree> {
        self.data.get()?.tree()
    }

    #[inline]
    fn data(&self) -> &Arc<MeshData> {
        self.data.get_or_init(|| self.view.store.entry(self.view.mesh))
    }

    /// Returns true if triangles are analysed where something touches. This holds for large meshes,
    /// and for surely open ones.
    fn is_local(&self) -> bool {
        /// Meshes up to this size are analysed as a whole. Higher: bodies come onto new terrains
        /// later. Lower: the search for a border takes longer.
        const LEAST: usize = 512;
        let (data, mesh) = (self.data(), self.view.mesh);
        data.is_local(|| {
            let count = mesh.indices().len();
            // The analysis of a mesh of this size takes 50 ms.
            if count > PAIRED {
                return true;
            }
            let has_border = || count > LEAST && self.view.has_bare_edge();
            let is_open = has_border() && is_surely_open(&MeshRays(mesh));
            if is_open {
                let _ = data.kind.set(SurfaceKind::Sheet);
            }
            is_open
        })
    }

    /// Returns the triangles of the mesh with their adjacency.
    #[inline]
    pub(crate) fn facets(&self) -> MeshFacets<'_> {
        let (data, MeshView { mesh, store, .. }) = (self.data(), self.view);
        let twins = if self.is_local() {
            Twins::Near(data.neighbours(mesh))
        } else {
            // Computes the flags as well.
            Twins::All(store.surface(mesh, data), data.flags())
        };
        MeshFacets { mesh, twins, memo: &self.memo, declared: self.kind_and_side().1 }
    }

    /// Returns the kind of the mesh, and the [declared](MeshFacets::declared) side of its
    /// triangles. Analyses the mesh if it is analysed as a whole.
    #[inline]
    fn kind_and_side(&self) -> (SurfaceKind, Option<Side>) {
        *self.declared.get_or_init(|| {
            let (data, MeshView { mesh, store, .. }) = (self.data(), self.view);
            let found = || match self.is_local() {
                true => data.kind_by_rays(mesh),
                false => store.surface(mesh, data).kind(),
            };
            let kind = data.kind().unwrap_or_else(found);
            let is_declared = data.declared_kind().is_some();
            let side = match kind {
                SurfaceKind::Sheet => Some(Side::Sheet),
                SurfaceKind::Solid => is_declared.then_some(Side::Outer),
                SurfaceKind::InsideOut => is_declared.then_some(Side::Turned),
            };
            (kind, side)
        })
    }

    /// Returns the surface around a triangle.
    #[inline]
    pub(crate) fn around(&self, triangle: u32) -> Around<MeshFacets<'_>> {
        let facets = self.facets();
        Around { facets, side: facets.declared_side(triangle) }
    }

    /// Returns the triangle nearest to a point, and the nearest point. Also returns the cosine
    /// between the direction to `point` and the normal that leads into the body. Leaves out
    /// triangles that do not bound the body of a closed mesh.
    pub(crate) fn nearest(&self, point: Vec3) -> Option<(u32, Vec3, Real)> {
        let kind = self.kind();
        let bounds_nothing = |triangle| match self.around(triangle).side {
            Side::Inner => true,
            Side::Sheet => kind != SurfaceKind::Sheet,
            Side::Outer | Side::Turned => false,
        };
        let (triangle, nearest, behind) = nearest(self.view.mesh, point, bounds_nothing)?;
        let is_turned = kind != SurfaceKind::Sheet && self.facets().side(triangle) == Side::Turned;
        Some((triangle, nearest, if is_turned { -behind } else { behind }))
    }

    /// Returns the sign of the winding number around a [covered](super::is_covered) point: 1 within
    /// a body, -1 within faces that lead inwards, 0 elsewhere and for a sheet. `None` if rays
    /// disagree. The nearest triangle cannot tell the sign, as it may be of a part that pierces the
    /// surface.
    pub(crate) fn winding_sign(&self, point: Vec3) -> Option<i32> {
        let is_closed = self.kind() != SurfaceKind::Sheet;
        if is_closed { self.facets().winding_sign(point) } else { Some(0) }
    }

    /// Returns true if a user declared that the mesh is a solid.
    pub(crate) fn is_declared_solid(&self) -> bool {
        self.data().declared_kind() == Some(SurfaceKind::Solid)
    }

    /// Returns the tips of the mesh, and the half-edges that start there.
    pub(crate) fn tips(&self) -> impl Iterator<Item = (u32, Vec3)> {
        let tips: &Tips = self.data().tips.get_or_init(|| self.view.tips());
        tips.iter().map(|&tip| (tip, self.view.corner(tip)))
    }

    /// Returns the adjacency of the mesh if it is known by now and has doubles.
    pub(crate) fn with_doubles(&self) -> Option<&Surface> {
        self.data.get()?.surface().filter(|surface| surface.has_doubles())
    }

    /// Returns the kind of the mesh.
    #[inline]
    pub(crate) fn kind(&self) -> SurfaceKind {
        self.kind_and_side().0
    }
}

#[cfg(test)]
mod tests {
    use parry3d::shape::{Ball, SharedShape, TriMesh, TriMeshFlags};

    use super::*;
    use crate::mesh::MeshStore;

    /// A ball of so many rows of triangles.
    fn mesh(rows: u32, flags: TriMeshFlags) -> TriMesh {
        let (vertices, triangles) = Ball::new(1.0).to_trimesh(2 * rows, rows);
        TriMesh::with_flags(vertices, triangles, flags).unwrap()
    }

    fn store() -> MeshStore {
        MeshStore::new(None, 1 << 20)
    }

    #[test]
    fn each_kind_of_change_is_told() {
        let [one, other] = [3, 4].map(|rows| mesh(rows, TriMeshFlags::empty()));
        let soft = mesh(3, TriMeshFlags::DEFORMABLE);
        let stores = [store(), store()];
        let mut known = KnownMesh::default();
        for (mesh, owner, change) in [
            (&one, 0, Change::Unknown),
            (&one, 0, Change::Unchanged),
            (&one, 1, Change::Unknown),
            (&one, 1, Change::Unchanged),
            (&other, 1, Change::Replaced),
            (&soft, 1, Change::Replaced),
            (&soft, 1, Change::Unknown),
            (&one, 1, Change::Replaced),
        ] {
            assert_eq!(known.update(&stores[owner].view(mesh).unwrap()), change);
        }
    }

    /// Returns whether the whole surface is used, and whether the mesh is a solid.
    fn surface(known: &mut KnownMesh, store: &MeshStore, mesh: &TriMesh) -> [bool; 2] {
        let view = store.view(mesh).unwrap();
        known.update(&view);
        let surface = known.acquire(&view, true).unwrap();
        [!surface.is_local(), surface.kind() == SurfaceKind::Solid]
    }

    /// Would catch terrains that cost their first contact a look at all triangles, and others
    /// without that look.
    #[test]
    fn open_terrains_are_analysed_where_something_touches() {
        let store = store();
        let ask = |mesh: &TriMesh| {
            let (view, mut known) = (store.view(mesh).unwrap(), KnownMesh::default());
            known.update(&view);
            let surface = known.acquire(&view, true).unwrap();
            let side = surface.around(7).side;
            (surface.data().surface().is_none(), surface.kind(), side)
        };
        let ball = mesh(100, TriMeshFlags::empty());
        assert_eq!(ask(&ball), (false, SurfaceKind::Solid, Side::Outer));
        // The lower half is open, but rays from within may leave anywhere.
        let triangles: Vec<[u32; 3]> = ball.indices()[..ball.indices().len() / 2].to_vec();
        let bowl = TriMesh::new(ball.vertices().to_vec(), triangles).unwrap();
        assert_eq!(ask(&bowl).1, SurfaceKind::Sheet);
        let flat = ball.vertices().iter().map(|at| at * Vec3::new(1.0, 0.1, 1.0)).collect();
        let hill = TriMesh::new(flat, bowl.indices().to_vec()).unwrap();
        assert_eq!(ask(&hill), (true, SurfaceKind::Sheet, Side::Sheet));
    }

    #[test]
    fn a_pair_follows_registrations_and_declared_kinds() {
        let store = store();
        let shape = SharedShape::new(mesh(260, TriMeshFlags::empty()));
        let mesh = shape.as_trimesh().unwrap();
        let mut known = KnownMesh::default();
        assert_eq!(surface(&mut known, &store, mesh), [false, true]);
        let registered = store.register(mesh, Some(&shape)).unwrap();
        assert_eq!(known.clone().update(&store.view(mesh).unwrap()), Change::Unknown);
        assert_eq!(surface(&mut known, &store, mesh), [true; 2]);
        registered.data.declare_kind(SurfaceKind::Sheet);
        assert_eq!(known.clone().update(&store.view(mesh).unwrap()), Change::Unknown);
        assert_eq!(surface(&mut known, &store, mesh), [true, false]);
        assert_eq!(known.update(&store.view(mesh).unwrap()), Change::Unchanged);
        drop(registered);
        assert_eq!(surface(&mut known, &store, mesh), [false, true]);
    }

    /// Fails if a query takes a lock though the pair has its meshes, or drops one under a lock.
    /// Another registration must not make pairs search for large meshes, as that hashes the
    /// content.
    #[test]
    fn a_pair_that_has_its_meshes_takes_no_lock() {
        let (store, meshes) = (store(), [6, 100].map(|rows| mesh(rows, TriMeshFlags::empty())));
        let _registered = store.register(&meshes[1], None).unwrap();
        let mut known = [(); 2].map(|()| KnownMesh::default());
        let query = |known: &mut [KnownMesh; 2]| {
            let mut both = known.iter_mut().zip(&meshes);
            both.all(|(known, mesh)| surface(known, &store, mesh) == [true; 2])
        };
        assert!((0..2).all(|_| query(&mut known)));
        let _other = store.register(&mesh(99, TriMeshFlags::empty()), None).unwrap();
        let small = store.view(&meshes[0]).unwrap();
        assert_eq!(known[0].update(&small), Change::Unchanged);
        let locked = store.lock_all();
        std::thread::scope(|scope| {
            let queries = || (0..20).all(|_| query(&mut known));
            assert!(scope.spawn(queries).join().unwrap());
        });
        drop(known);
        drop(locked);
    }
}
