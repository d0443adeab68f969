use sbbk_core::surface::SurfaceKind;
use sbbk_core::tree::{BuildOptions, LayerPlan};

/// Which contacts two meshes have, and a mesh and a height field or convex shapes.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum ContactSet {
    /// Those of their surfaces: what touches is pushed out of a mesh that bounds a solid, not through
    /// it, and edges within a surface do not count. Against convex shapes only the latter. For rigid
    /// meshes; see the documentation of this crate.
    #[default]
    Surfaces,
    /// Those of each triangle by itself, as in stock Rapier: for comparison.
    Triangles,
}

/// How many of the contacts of two shapes a host gets: what the field calls contact or manifold
/// reduction.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum ContactDetail {
    /// Each triangle that touches, or each two, has a manifold of its own, as in stock Rapier. But
    /// where two surfaces are no nearer than a tenth of the smaller radius, within the prediction
    /// distance of soft CCD, they have one manifold of at most four points a direction: of more
    /// Rapier's solver would take one.
    Every,
    /// A few manifolds for two shapes: of each direction up to four points, the outermost ones that
    /// carry, and others as deep that are far from these; what hangs beside one that touches is of its
    /// direction if it leans less than 26 degrees from it. They are chosen before they are made; the
    /// deepest point is always among them. Bodies come to rest sooner than on every contact, of which
    /// Rapier's solver takes four by their spread alone. For rigid meshes; pairs of
    /// which one may deform have every contact, and so do balls, and convex shapes on meshes with
    /// `FIX_INTERNAL_EDGES`. Of a manifold, the subshapes are those of its deepest contact.
    #[default]
    Patches,
}

/// What SBBK answers for when it meets a mesh. Parry answers for the rest, as without SBBK.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Kinds {
    /// Other meshes, and queries without manifolds of two meshes.
    pub meshes: bool,
    /// Height fields. In stock Rapier a mesh falls through them.
    pub height_fields: bool,
    /// Convex shapes of every kind.
    pub convex_shapes: bool,
    /// Compounds of convex shapes, and polylines.
    pub composites: bool,
}

impl Default for Kinds {
    /// All.
    fn default() -> Self {
        Self { meshes: true, height_fields: true, convex_shapes: true, composites: true }
    }
}

/// How an [`SbbkDispatcher`](crate::SbbkDispatcher) builds trees and contacts.
///
/// ```
/// use rapier_integration::{ContactSet, SbbkConfig, SbbkDispatcher};
///
/// let mut config = SbbkConfig::default();
/// config.contact_set = ContactSet::Triangles; // which contacts: as stock's, but exact
/// config.kinds.convex_shapes = false; // Parry answers for these
/// let dispatcher = SbbkDispatcher::new(config);
/// assert!(!dispatcher.config().kinds.convex_shapes);
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SbbkConfig {
    /// The volume of each layer of the trees. `None`: for each mesh what is fastest by a model
    /// ([`LayerPlan`]).
    pub layers: Option<LayerPlan>,
    /// Contacts of surfaces, or of each two triangles.
    pub contact_set: ContactSet,
    /// What height fields bound, for meshes with [`ContactSet::Surfaces`]:
    /// [`Solid`](SurfaceKind::Solid), as all is ground below their upper side, or
    /// [`Sheet`](SurfaceKind::Sheet), to be met from below as well, as a roof.
    pub height_fields: SurfaceKind,
    /// Whether convex shapes, too, leave meshes that bound a solid, with [`ContactSet::Surfaces`]: one
    /// whose middle is inside goes the shortest way from there to the surface. Not by default, as in stock
    /// Rapier: a room that is modelled by one closed surface, its faces outward, counts as a solid, and what
    /// lives in it would be thrown out. Say of such meshes that they are sheets
    /// ([`PreparedTree::set_surface_kind`](crate::PreparedTree::set_surface_kind)), and register those of more than 8192
    /// triangles ([`SbbkDispatcher::prepare_shape`](crate::SbbkDispatcher::prepare_shape)), which count as
    /// sheets otherwise. Each part of a compound goes its own way. Where an edge is nearest to the middle, as
    /// below a ditch, contacts stay as in stock.
    pub convex_leave_solids: bool,
    /// Whether the contacts of a pair are reduced to patches, or all reported.
    pub detail: ContactDetail,
    /// What is answered.
    pub kinds: Kinds,
    /// Memory that trees may keep while no pair of colliders uses them, in bytes. A mesh that
    /// leaves all contacts and comes back finds its tree here; with 0 the tree is gone by then. The
    /// trees of the last eight meshes that queries without manifolds asked for stay beyond it, and
    /// so do those that a [`PreparedTree`](crate::PreparedTree) keeps.
    pub idle_tree_bytes: usize,
    /// Whether queries are counted in [`SbbkStats`](crate::SbbkStats). Costs some percent, more
    /// with many threads.
    pub count_queries: bool,
}

impl Default for SbbkConfig {
    fn default() -> Self {
        Self {
            layers: None,
            contact_set: ContactSet::Surfaces,
            height_fields: SurfaceKind::Solid,
            convex_leave_solids: false,
            detail: ContactDetail::default(),
            kinds: Kinds::default(),
            idle_tree_bytes: 16 << 20,
            count_queries: false,
        }
    }
}

impl SbbkConfig {
    /// The comparison of the SBBK paper: the same code with AABBs in every layer, no sphere at the
    /// root and no k-DOPs below.
    pub fn aabb_only() -> Self {
        Self { layers: Some(LayerPlan::AABB_ONLY), ..Self::default() }
    }

    pub(crate) fn build_options(&self) -> BuildOptions {
        BuildOptions { layers: self.layers, ..BuildOptions::default() }
    }
}
