//! SBBK for Rapier: fast and exact contacts between triangle meshes, as a drop-in query dispatcher.
//!
//! ```
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
//! Parry's contacts; a mesh and a height field from the mesh's tree and the cells under it; every other pair goes to Parry's own dispatcher. Rapier's behaviour stays that of Rapier: prediction distance, contact skins, internal edges,
//! recycling and clustering work as before.
//!
//! * [`SbbkConfig`]: the layers of the trees, whose contact generator, how much memory unused trees may keep.
//! * [`SbbkDispatcher::prepare`] builds a tree at load time; [`SbbkDispatcher::stats`] says what was built and done.
//! * [`TriangleContacts`]: the contact generator alone, for hosts with a midphase of their own.
//!
//! # Who answers
//!
//! | pair | contacts | state kept between steps |
//! |---|---|---|
//! | mesh and mesh | SBBK | candidates, features, manifolds |
//! | deformable mesh (`TriMeshFlags::DEFORMABLE`) and any mesh, or any shape below that SBBK answers for | as for the mesh that it is at present; its tree is refitted by the first query after its vertices moved, for all pairs (two soft bodies: Rapier itself, no dispatcher is asked) | manifolds; candidates while no vertex moves |
//! | mesh and cuboid, ball, capsule, segment, triangle, cylinder, cone, convex polyhedron, their round kinds, or half-space, in either order | SBBK's trees, Parry's contact routines: on a first query Parry's contacts of all triangles, bit for bit | candidates with distances and separating axes, manifolds |
//! | mesh and height field, in either order | SBBK; stock Rapier has none, bodies fall through | candidates, features, manifolds |
//! | mesh and compound of the convex kinds above, in either order | part by part as above: on a first query stock's contacts, bit for bit and in stock order | the same of each part |
//! | mesh and anything else (polyline, voxels, custom shape, a compound with parts of other kinds) | Parry | Parry's |
//! | all else | Parry | Parry's |
//!
//! Queries without manifolds (distance, closest points, intersection, contact, casts) of two rigid meshes are answered from
//! trees too, of surfaces as stock does: a mesh inside another one does not meet it. Hosts keep no state for them, so each
//! hashes the vertices of its meshes to know their trees, in time that grows with their number; the first one builds the trees,
//! unless [`SbbkDispatcher::prepare`] did, and each thread keeps those of the last eight meshes it asked about. A pose that is
//! not finite finds nothing. All other pairs are Parry's, and so is one case of meshes: a nonlinear cast that starts
//! in contact with `stop_at_penetration` off.
//!
//! # Hosts
//!
//! The dispatcher is generic over manifold and contact data, so any host of Parry can use it. A host must drop a pair's
//! workspace when it edits one of its shapes, as Rapier does and as Parry's own workspaces need too. Queries from many
//! threads at once are fine: no lock is taken by a pair of rigid meshes whose trees are known. A deformable mesh may be edited in place at
//! any time between queries, and the workspaces kept: each query reads all of it (about 1 µs for 1000 triangles).
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
