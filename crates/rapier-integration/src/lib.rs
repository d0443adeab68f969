//! SBBK for Rapier: fast and exact collision of triangle meshes, as a drop-in query dispatcher.
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
//! Colliders stay plain triangle meshes; nothing else in a scene changes. Prediction distance,
//! contact skins, internal edges, recycling and clustering of contacts work as in stock Rapier.
//!
//! The [`guide`] says what to set where a scene is difficult, and when not to use SBBK; [`draw`] shows
//! trees and contacts.
//!
//! # What changes
//!
//! * The contacts of two meshes are exact at every scale, and so are those of a mesh with convex
//!   shapes (cylinders and cones: apart to 1e-7, crossing to 1e-5 of the distance). Stock's
//!   tolerances are absolute lengths: it loses contacts of triangles that are small, and gets their
//!   depths and normals wrong.
//! * Two meshes have the contacts of their *surfaces*, see below: stacks of meshes stand, gears turn,
//!   boxes slide over the edges of a floor, and what has sunk into a body comes out again.
//! * A pair has *patches* ([`ContactDetail::Patches`]): a few manifolds of at most four points that
//!   carry, named after their deepest contacts. Stock has a manifold for each triangle, or each two;
//!   [`ContactDetail::Every`] gives these.
//! * Queries about meshes are faster, several times for two meshes; the repository's README has the
//!   figures.
//! * Contacts depend on the pose and the shapes alone, bit for bit. What is remembered from earlier
//!   steps saves time and is never part of the answer.
//! * A mesh that meets a height field has contacts. In stock Rapier it falls through.
//!
//! # Trees
//!
//! Rigid meshes that meet other rigid meshes get a [tree](sbbk_core::tree), shared by all colliders
//! with equal geometry. A mesh of up to 8192 triangles gets it unasked, in the midst of a step: a
//! build takes less than 2 ms, and all of them no more than that and a share of what queries have
//! taken, however many meshes land together. A larger mesh gets a tree when the program prepares it,
//! at load time:
//!
//! * [`SbbkDispatcher::prepare_shape`] is for a mesh that is used as one `SharedShape` and its
//!   clones. Queries know it by its address, at any size.
//! * [`SbbkDispatcher::prepare`] is for copies too, loaded twice or restored from a snapshot. They
//!   are found by a hash of their content, up to about 500,000 triangles.
//!
//! Without trees the pairs of triangles of two meshes are the same, bit for bit and in the same
//! order, and take longer: they are found by Parry's own hierarchies of the meshes. Pairs of a mesh
//! and anything else are always found that way; they need no build and no memory for a tree.
//!
//! [`SbbkConfig`] chooses the volumes of the trees, the contact generator, and how much memory
//! unused trees may keep. [`SbbkDispatcher::stats`] counts trees and queries. [`TriangleContacts`]
//! is the contact generator alone, for hosts with a midphase of their own.
//!
//! # Inside and outside
//!
//! A triangle alone cannot tell on which side of it a body is, nor whether its border is a corner of
//! the body or lies within a flat face. Stock Rapier asks each two triangles by themselves, so meshes
//! lock into each other, and stumble over edges that nobody can see. Two rigid meshes have other
//! contacts here ([`ContactSet::Surfaces`]):
//!
//! * A mesh that bounds a *solid* ([`SurfaceKind::Solid`]) pushes out what has sunk into it. It is
//!   wound consistently, with normals that point outwards, and closed or nearly: its holes together
//!   are at most 6 % of its surface, of a hole with a lid the gap. Vertices at one place count as one. Depths count up to a
//!   tenth of the radius of the smaller mesh, or four prediction distances if that is more, so that deep
//!   bodies come out slowly.
//! * Any other mesh is a *sheet* and met from both sides: terrains, walls, bowls, vases with a wide
//!   neck, soups of triangles. So is a closed mesh whose normals point inwards
//!   ([`SbbkStats::inside_out`]). A thin solid in the midst of a larger sheet goes to the
//!   side that its middle is on, or to the front while this is little behind.
//! * Contacts apart are local minima of the distance, so edges within a face and walls that pass by
//!   make none; of sharp edges and corners only those nearer than a quarter of the prediction distance
//!   count, as they may pass each other. Contacts farther than a tenth of that radius, which only soft CCD
//!   asks for, are exempt: bodies may turn before they meet. If all are that far, each direction has at
//!   most four points.
//! * Surfaces that cross never stay without a contact.
//!
//! What a mesh bounds is found when it first meets another mesh, in about a third of the time that a
//! tree takes. In a mesh of more than 8192 triangles that is not
//! [registered](SbbkDispatcher::prepare_shape) it is looked for where it meets another such mesh, and
//! never in one of more than 131,072. Else such a mesh is a sheet, of which the neighbours of triangles
//! are found where it is touched. [`PreparedTree::set_surface_kind`] says what a mesh bounds where
//! SBBK would think otherwise; [`SbbkStats`] counts the kinds.
//!
//! Of a rigid mesh and a convex shape, contacts at edges within the surface are along the normal of the
//! nearest triangle there, so that bodies slide and roll. Inside and outside are as in stock, unless
//! [`SbbkConfig::convex_leave_solids`] leads convex shapes out of solids, too.
//!
//! A height field is the top of a solid for rigid meshes: they do not stumble over its edges, and what
//! has sunk into it comes up. What is wholly below it is left alone, as in a cave, and passes it from
//! there. [`SbbkConfig::height_fields`] makes it a sheet.
//!
//! `TriMeshFlags::FIX_INTERNAL_EDGES` changes nothing about any of these contacts: surfaces have no
//! internal edges, and know outside from inside.
//!
//! With [`ContactSet::Triangles`] all is as in stock: of meshes without
//! `TriMeshFlags::FIX_INTERNAL_EDGES` triangles have no outside. Deformable meshes have
//! these contacts always. There a body that lies wholly inside another, farther from its surface than the
//! prediction distance, has no contact.
//!
//! # Who answers
//!
//! By what a mesh meets, in either order of the two shapes. Pairs without a mesh are Parry's, as
//! without this crate (but for [`contact_manifold_convex_convex`] of two single triangles).
//!
//! [`contact_manifold_convex_convex`]: parry3d::query::PersistentQueryDispatcher::contact_manifold_convex_convex
//!
//! | a mesh and | pairs found by | contact points by |
//! |---|---|---|
//! | a mesh | SBBK: trees, or Parry's hierarchies | SBBK |
//! | a ball, cuboid, half-space | SBBK: Parry's hierarchy of the mesh | SBBK |
//! | a capsule, segment, triangle, cylinder, cone, convex polyhedron | likewise | SBBK |
//! | a round cuboid, triangle, cylinder, cone, convex polyhedron | likewise | SBBK |
//! | a compound of the convex shapes above | likewise | SBBK |
//! | a polyline | likewise | SBBK |
//! | a height field | SBBK: the same, and the cells under it | SBBK |
//! | voxels, a custom shape, a deformable polyline | Parry | Parry |
//! | a compound with any other part | Parry | Parry |
//!
//! Balls that touch about six triangles of a mesh at a time or fewer, by the triangles' mean size,
//! have Parry's contacts: these are exact at every scale, and there nothing is quicker.
//!
//! SBBK's contacts of a convex shape are those of [`sbbk_core::contact::convex`], computed in f64;
//! Parry says which feature of a polyhedron, cylinder or cone faces the triangle. With
//! [`ContactDetail::Every`] each contact has its manifold, in the order of subshapes.
//!
//! A mesh may deform (`TriMeshFlags::DEFORMABLE`, Rapier's soft bodies), and the other one too. It
//! has no tree, and pairs keep the data of its manifolds from query to query and nothing else. Where
//! it has changed, the next query reads its vertices once, about a nanosecond each, to see whether
//! they are finite. Triangles with a vertex that is NaN or infinite touch nothing; the others touch
//! as before. Rapier itself answers for two soft bodies and asks no dispatcher.
//!
//! Parry answers for a rigid mesh with a vertex that is NaN or infinite, and
//! [`SbbkStats::unsupported_queries`] counts.
//!
//! # Queries without manifolds
//!
//! Of two rigid meshes `intersection_test`, `distance`, `closest_points`, `contact`, `cast_shapes`
//! and `cast_shapes_nonlinear` are SBBK's, with the exception below; of one and a convex shape too,
//! but of a ball only casts; of all other pairs, deformable meshes among them, Parry's.
//!
//! * A mesh is a surface, as in stock: one inside another does not meet it.
//! * `contact` is that of the deepest pair of triangles or, where none cross, of the nearest.
//! * With `stop_at_penetration` off, a cast leaves out pairs of triangles that touch at the start
//!   and do not approach. A nonlinear one of a convex shape leaves out the triangles which it would
//!   not sink into by more than its `ccd_thickness`, as Parry does, and like Parry it looks at them
//!   again at some times if the shape turns.
//! * A nonlinear cast stops as soon as the bodies are within a millionth of the radius of
//!   the ball around the smaller.
//! * A pose that is not finite finds nothing.
//!
//! A host keeps no state for these queries, so each one has to find the trees of its meshes:
//!
//! * A mesh of [`SbbkDispatcher::prepare_shape`] is known by its address.
//! * A mesh of up to 8192 triangles gets a tree at its first query. Each later one compares
//!   vertices and triangles with a copy, in time that grows with their number; an
//!   `intersection_test` that finds two triangles compares those two. Each thread knows the last
//!   eight meshes it asked about.
//! * A larger mesh has no tree here. Then the answer comes from Parry's hierarchies of both meshes,
//!   with the same exact distances; casts are Parry's.
//!
//! Rapier's character controller asks the dispatcher of the query pipeline for shape casts and for
//! how deep it is in a collider. For the contacts with its ground, and with bodies that it pushes,
//! it asks Parry's own dispatcher, whatever dispatcher is set.
//!
//! # Hosts other than Rapier
//!
//! The dispatcher is generic over manifold and contact data: any host of Parry 0.31.1 can use it.
//!
//! ```
//! use parry3d::math::Pose;
//! use parry3d::query::{ContactManifold, PersistentQueryDispatcher, Unsupported};
//! use parry3d::shape::{Ball, TriMesh};
//! use rapier_integration::SbbkDispatcher;
//!
//! let (vertices, triangles) = Ball::new(1.0).to_trimesh(24, 12);
//! let mesh = TriMesh::new(vertices, triangles).unwrap();
//! let dispatcher = SbbkDispatcher::default();
//!
//! // Of each pair the host keeps these two from step to step.
//! let mut manifolds: Vec<ContactManifold<(), ()>> = Vec::new();
//! let mut workspace = None;
//! for step in 0..10 {
//!     let at = Pose::translation(2.04 - 0.01 * step as f32, 0.0, 0.0);
//!     dispatcher.contact_manifolds(&at, &mesh, &mesh, 0.02, &mut manifolds, &mut workspace)?;
//! }
//! let deepest = manifolds.iter().flat_map(|manifold| &manifold.points);
//! let deepest = deepest.map(|point| point.dist).fold(f32::INFINITY, f32::min);
//! assert!((deepest + 0.05).abs() < 0.01);
//! # Ok::<(), Unsupported>(())
//! ```
//!
//! A host must drop a pair's workspace when it edits one of its shapes, as Rapier does and as Parry's
//! own workspaces need. A deformable mesh may be edited in place between queries, and the
//! workspaces kept. A pair without manifolds that is apart may be left without a workspace.
//!
//! # Threads
//!
//! Queries may come from many threads at once. Contact queries take no lock, but for rigid meshes that
//! meet another, a height field or a convex shape that is to leave solids, and of which not all is known
//! yet: these look for it under a lock, for a moment. A tree is built outside of it. Results do not depend on the number of threads.
//!
//! # Snapshots
//!
//! A Rapier world can be saved and restored, with or without this crate. Rapier does not store its
//! dispatcher: set it again after restoring, and register large meshes again
//! ([`SbbkDispatcher::prepare_shape`]), as restored shapes are others. The world then goes on as if it had
//! not been saved.
//!
//! # Features
//!
//! * `rapier3d` (default): Rapier as a dependency, for the example above and for the features below
//!   to reach it. Without it this is a plain Parry dispatcher.
//! * `parallel`, `enhanced-determinism`, `serde-serialize`: Rapier's and Parry's features of these
//!   names.

mod config;
mod dispatcher;
pub mod draw;
pub mod guide;
mod mesh;
mod pair;
mod query;
mod stats;

pub use config::{ContactDetail, ContactSet, Kinds, SbbkConfig};
pub use dispatcher::{PrepareError, PreparedTree, SbbkDispatcher};
pub use pair::TriangleContacts;
pub use sbbk_core;
pub use sbbk_core::surface::SurfaceKind;
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

#[cfg(all(doctest, feature = "rapier3d"))]
#[doc = include_str!("../README.md")]
struct Readme;
