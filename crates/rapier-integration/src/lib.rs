//! SBBK for Rapier: fast and exact contacts between triangle meshes, as a drop-in query dispatcher.
//!
#![cfg_attr(feature = "rapier3d", doc = "```")]
#![cfg_attr(not(feature = "rapier3d"), doc = "```ignore")]
//! use rapier_integration::SbbkDispatcher;
//! use rapier3d::prelude::*;
//!
//! let mut world = PhysicsWorld::new();
//! world.narrow_phase.set_query_dispatcher(SbbkDispatcher::default()); // the one line
//! ```
//!
//! Nothing else in a scene changes: colliders stay plain triangle meshes. Each pair of meshes is answered from
//! [trees](sbbk_core::tree) of a bounding sphere, AABBs and k-DOPs, descended together, with
//! [exact contacts](sbbk_core::contact) of the triangles they find; a mesh and a convex shape from the mesh's tree, with
//! Parry's contacts; a mesh and a compound part by part; a mesh and a height field from the mesh's tree and the cells
//! under it; every other pair goes to Parry's own dispatcher. Rapier's behaviour stays that of Rapier: prediction distance,
//! contact skins, internal edges, recycling and clustering work as before.
//!
//! * [`SbbkConfig`]: the layers of the trees, whose contact generator, how much memory unused trees may keep.
//! * [`SbbkDispatcher::prepare`] builds a tree at load time; [`SbbkDispatcher::stats`] says what was built and done.
//! * [`TriangleContacts`]: the contact generator alone, for hosts with a midphase of their own.
//!
//! # Who answers
//!
//! Contacts ([`contact_manifolds`](parry3d::query::PersistentQueryDispatcher::contact_manifolds)), by what a triangle mesh meets; in
//! either order of the two shapes. The last column names the tests (under `tests/integration`, by function) that would notice if the row
//! were wrong; `who_answers` checks the second column for each kind, and that these tests exist.
//!
//! | a mesh and | contacts | state kept between steps | tested by |
//! |---|---|---|---|
//! | a mesh | SBBK | candidates, features, manifolds | `exact`: `heads_touch_as_the_truth_says`, `contacts_are_stocks_where_triangles_are_large`; `bits`: `parrys_contacts_are_stocks`; `motion`: `thousands_of_histories_end_alike`; `edited_mesh`: `slightly_moved_vertices_are_seen` |
//! | a ball, cuboid, capsule, segment, triangle, cylinder, cone, convex polyhedron | SBBK's trees, Parry's contact routines: on a first query Parry's contacts of all triangles, bit for bit | candidates with distances and separating axes, manifolds | `convex`: `fresh_contacts_are_those_of_parrys_routine_on_all_triangles`, `motion_is_no_part_of_the_answer`, `a_head_rests_on_a_floor_as_with_stock` |
//! | a round cuboid, triangle, cylinder, cone, convex polyhedron | the same | the same | `convex`: the same |
//! | a half-space | the same | the same | `convex`: the same |
//! | a height field | SBBK; stock Rapier has none, bodies fall through | candidates, features, manifolds | `heightfield`: `lattice_contacts_are_those_of_brute_force`, `contacts_equal_those_of_the_terrain_as_a_mesh`, `motion_never_differs_from_fresh_queries`, `heads_rest_on_a_height_field` |
//! | a compound of convex kinds above | part by part as above: on a first query stock's contacts, bit for bit and in stock order | the same of each part | `compound`: `fresh_contacts_are_those_of_stock`, `compounds_rest_on_a_mesh_as_with_stock` |
//! | a compound with a part of another kind | Parry | Parry's | `compound`: `other_parts_leave_the_pair_to_stock` |
//! | a polyline, voxels, a custom shape | Parry | Parry's | `who_answers`: `contacts_of_each_kind` (not the custom shape) |
//!
//! The mesh may deform (`TriMeshFlags::DEFORMABLE`), and the other one too:
//!
//! | a deformable mesh and | contacts | state kept between steps | tested by |
//! |---|---|---|---|
//! | a mesh, deformable or not | as for the mesh that it is at present; its tree is refitted by the first query after its vertices moved, for all pairs (two soft bodies: Rapier itself, no dispatcher is asked) | manifolds; candidates while no vertex moves | `deformable`: `a_soft_mesh_keeps_its_contacts_with_a_rigid_one`, `two_soft_meshes_have_a_tree_each`, `pairs_on_many_threads_share_one_refit`, `a_soft_body_of_rapier_keeps_its_contacts` |
//! | a convex kind above | the same | the same | `deformable`: `a_soft_mesh_keeps_its_contacts_with_convex_shapes` |
//! | a height field | the same | the same | `soft_pairs`: `contacts_with_a_height_field_are_those_of_a_mesh_built_anew`, `a_soft_mesh_keeps_its_contacts_with_a_height_field`, `a_soft_body_rests_on_a_height_field` |
//! | a compound of convex kinds | the same | the same | `soft_pairs`: `contacts_with_a_compound_are_those_of_a_mesh_built_anew`, `a_soft_mesh_keeps_its_contacts_with_a_compound`, `a_soft_body_rests_on_a_compound_as_with_stock` |
//! | anything else | Parry | Parry's | `who_answers`: `contacts_of_each_kind` |
//!
//! Some vertices of a deformable mesh may be NaN or infinite: triangles without one touch as before, the others touch nothing
//! (`whole_triangles_touch_and_broken_ones_do_not`). A rigid mesh with such a vertex cannot have a tree and is Parry's
//! (`a_mesh_that_is_not_finite_is_answered_by_stock_and_counted`), as is a deformable one of which nothing is left; Parry can panic
//! where such triangles come near. Pairs without a mesh are Parry's.
//!
//! Queries without manifolds, of two rigid meshes: SBBK. They keep no state. Surfaces are what counts, as for stock: a mesh inside another
//! one does not meet it. A pose that is not finite finds nothing.
//!
//! | query | answer | tested by |
//! |---|---|---|
//! | `intersection_test` | whether two triangles meet, and which | `queries`: `proximity_is_true`, `sensors_see_what_stock_sees`, `inside_is_not_intersecting` |
//! | `distance`, `closest_points` | of the nearest triangles | `queries`: `proximity_is_true`, `proximity_is_like_stock` |
//! | `contact` | of the deepest triangles or, where none cross, the nearest | `queries`: `proximity_is_true`, `proximity_is_like_stock` |
//! | `cast_shapes` | the first impact; pairs of triangles that touch at the start and do not approach are left out if `stop_at_penetration` is off | `queries`: `casts_stop_at_the_first_impact`, `casts_that_start_inside` |
//! | `cast_shapes_nonlinear` | the same | `queries`: `nonlinear_casts_stop_at_the_first_impact`; `nonlinear`: `casts_from_contact_are_true`, `casts_from_contact_are_like_stock` |
//!
//! Of all other pairs, deformable meshes among them, these queries are Parry's (`others_are_stocks`). As hosts keep no state for them, each
//! compares vertices and triangles of its meshes with copies to know their trees, in time that grows with their number (a positive
//! `intersection_test` only those two that meet); the first one builds the trees, unless
//! [`SbbkDispatcher::prepare`] did, and each thread knows those of the last eight meshes it asked
//! about. The dispatcher keeps them as [`SbbkConfig::idle_tree_bytes`] says.
//!
//! # Hosts
//!
//! The dispatcher is generic over manifold and contact data, so any host of Parry can use it. A host must drop a pair's
//! workspace when it edits one of its shapes, as Rapier does and as Parry's own workspaces need too. Queries from many
//! threads at once are fine: no lock is taken by a pair of rigid meshes whose trees are known. A deformable mesh may be edited in place at
//! any time between queries, and the workspaces kept: each query reads all of it (about 1 µs for 1000 triangles).
//!
//! Rapier's character controller asks the dispatcher of the query pipeline for shape casts and for
//! how deep it is in a collider. For the contacts with its ground, and with bodies that it pushes, it
//! asks Parry's own dispatcher, whatever dispatcher is set.
//!
//! Runs repeat bit for bit. The contacts of two meshes are a function of their pose and triangles, and their order of the
//! meshes: not of what was remembered from earlier steps, of threads, or of when a tree was built.
//!
//! A snapshot of a Rapier world can be taken and restored, with or without this crate. As Rapier does not store its
//! dispatcher, set it again after restoring.
//!
//! # Features
//!
//! * `rapier3d` (default): Rapier as a dependency, for the example above and for the features below to reach it. Without it this is a
//!   plain Parry dispatcher.
//! * `parallel`, `enhanced-determinism`, `serde-serialize`: Rapier's and Parry's features of these names.

mod config;
mod dispatcher;
mod mesh;
mod pair;
mod query;
mod stats;

pub use config::{ContactGenerator, SbbkConfig};
pub use dispatcher::{PreparedTree, SbbkDispatcher};
pub use pair::TriangleContacts;
pub use sbbk_core;
pub use stats::SbbkStats;

/// Fails to compile if the dispatcher stops being one that Rapier takes.
#[cfg(feature = "rapier3d")]
const _: fn() = || {
    use rapier3d::geometry::{ContactData, ContactManifoldData};
    use rapier3d::parry::query::PersistentQueryDispatcher;

    fn is_for_rapier<D>()
    where
        D: PersistentQueryDispatcher<ContactManifoldData, ContactData> + Clone + Default + 'static,
    {
    }
    is_for_rapier::<SbbkDispatcher>();
};
