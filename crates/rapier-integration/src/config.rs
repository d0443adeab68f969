use sbbk_core::tree::LayerPlan;
#[cfg(feature = "serde-serialize")]
use serde::{Deserialize, Serialize};

/// Selects the contacts of rigid meshes with meshes, height fields and convex shapes. Deformable
/// meshes always have [`Triangles`](Self::Triangles).
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde-serialize", derive(Serialize, Deserialize))]
pub enum ContactSet {
    /// Contacts of the surfaces: solids push out bodies that have sunk in, and internal edges have
    /// no contacts.
    #[default]
    Surfaces,
    /// Contacts of each two triangles, as in stock Rapier. For comparison.
    Triangles,
}

/// Selects how many of the contacts of [`ContactSet`] a host gets.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde-serialize", derive(Serialize, Deserialize))]
pub enum ContactDetail {
    /// A manifold for each pair of touching subshapes, as in stock Rapier. Contacts of two meshes,
    /// or of a mesh and a height field, are reduced if all are farther than a tenth of the smaller
    /// radius.
    Every,
    /// Reduced contacts: a few manifolds of at most four points, which carry like all of them. They
    /// have a deepest point, up to rounding. Subshapes name the triangles of the deepest contact.
    /// Pairs with a ball or a deformable mesh have every contact.
    #[default]
    Patches,
}

/// Selects what SBBK handles when it meets a mesh. Parry handles the rest, as without SBBK.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde-serialize", derive(Serialize, Deserialize), serde(default))]
#[non_exhaustive]
pub struct Kinds {
    /// Other meshes, also in queries without manifolds. Default: true.
    pub meshes: bool,
    /// Height fields. In stock Rapier a mesh falls through them. Default: true.
    pub height_fields: bool,
    /// Convex shapes of every kind, also in queries without manifolds. Default: true.
    pub convex_shapes: bool,
    /// Compounds of convex shapes, and polylines. Default: true.
    pub composites: bool,
}

impl Default for Kinds {
    fn default() -> Self {
        Self { meshes: true, height_fields: true, convex_shapes: true, composites: true }
    }
}

/// Configures an [`SbbkDispatcher`](crate::SbbkDispatcher). The defaults suit nearly all scenes.
///
/// ```
/// use rapier_integration::{ContactDetail, SbbkConfig, SbbkDispatcher};
///
/// let config = SbbkConfig::default().with_detail(ContactDetail::Every).with_count_queries(true);
/// let dispatcher = SbbkDispatcher::new(config);
/// assert!(dispatcher.config().kinds.convex_shapes);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde-serialize", derive(Serialize, Deserialize), serde(default))]
#[non_exhaustive]
pub struct SbbkConfig {
    /// Contacts of surfaces or of triangles. Default: surfaces.
    pub contact_set: ContactSet,
    /// Reduced contacts or every one of [`contact_set`](Self::contact_set). Default: reduced.
    pub detail: ContactDetail,
    /// Pairs that SBBK handles. Default: all.
    pub kinds: Kinds,
    /// True if a height field is the top of a solid, for meshes with [`ContactSet::Surfaces`].
    /// False: a sheet, such as a roof, that collides from below, too. Default: true.
    pub solid_height_fields: bool,
    /// True if solids push out convex shapes whose centre is inside them, with
    /// [`ContactSet::Surfaces`]. Each part of a compound is pushed for itself.
    ///
    /// Default: false, as in stock Rapier. A room that is one closed surface with outward normals
    /// counts as a solid, and would push out its furniture. Declare such a mesh a sheet by
    /// [`PreparedTree::set_surface_kind`](crate::PreparedTree::set_surface_kind).
    pub convex_leave_solids: bool,
    /// Volumes of the layers of each tree. Default: `None`, which chooses the fastest ones for each
    /// mesh by a cost model. Not serialized.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub layers: Option<LayerPlan>,
    /// Memory, in bytes, that recently used meshes may keep for their trees and surfaces while no
    /// pair uses them. A mesh that comes back finds its tree. Registered meshes stay in any case.
    /// Default: 16 MiB.
    pub idle_tree_bytes: usize,
    /// True if contact queries are counted in [`SbbkStats`](crate::SbbkStats). Costs some percent
    /// of time, more with many threads. Default: false.
    pub count_queries: bool,
}

impl Default for SbbkConfig {
    fn default() -> Self {
        Self {
            contact_set: ContactSet::default(),
            detail: ContactDetail::default(),
            kinds: Kinds::default(),
            solid_height_fields: true,
            convex_leave_solids: false,
            layers: None,
            idle_tree_bytes: 16 << 20,
            count_queries: false,
        }
    }
}

/// Defines a setter that returns the changed value for each field.
macro_rules! setters {
    ($($setter:ident: $field:ident: $type:ty,)*) => {
        $(
            #[doc = concat!("Sets [`", stringify!($field), "`](Self::", stringify!($field), ").")]
            #[must_use]
            pub fn $setter(self, $field: $type) -> Self {
                Self { $field, ..self }
            }
        )*
    };
}

impl SbbkConfig {
    setters! {
        with_contact_set: contact_set: ContactSet,
        with_detail: detail: ContactDetail,
        with_kinds: kinds: Kinds,
        with_solid_height_fields: solid_height_fields: bool,
        with_convex_leave_solids: convex_leave_solids: bool,
        with_layers: layers: Option<LayerPlan>,
        with_idle_tree_bytes: idle_tree_bytes: usize,
        with_count_queries: count_queries: bool,
    }

    pub(crate) fn wants_surfaces(&self) -> bool {
        self.contact_set == ContactSet::Surfaces
    }

    pub(crate) fn has_patches(&self) -> bool {
        self.detail == ContactDetail::Patches
    }

    /// Returns true if convex shapes are pushed out of solids.
    pub(crate) fn leave_solids(&self) -> bool {
        self.wants_surfaces() && self.convex_leave_solids
    }
}

#[cfg(all(test, feature = "serde-serialize"))]
mod tests {
    use super::*;

    #[test]
    fn a_stored_configuration_comes_back_and_missing_fields_have_their_defaults() {
        let config = SbbkConfig::default().with_detail(ContactDetail::Every);
        let text = serde_json::to_string(&config).unwrap();
        assert_eq!(serde_json::from_str::<SbbkConfig>(&text).unwrap(), config);
        let text = r#"{ "kinds": { "meshes": false } }"#;
        let partial: SbbkConfig = serde_json::from_str(text).unwrap();
        let kinds = Kinds { meshes: false, ..Kinds::default() };
        assert_eq!(partial, SbbkConfig::default().with_kinds(kinds));
    }
}
