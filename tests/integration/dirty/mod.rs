//! Meshes as people have them, in worlds, beside the same bodies on Rapier's cuboid.
//!
//! Each test prints a table and lists the cases that fail today. It fails when another case fails,
//! and when a listed case passes. To see the tables: `cargo test -p sbbk --test integration dirty
//! -- --nocapture`.

use crate::prelude::*;
use rapier_integration::PreparedTree;
use table::{Case, judge};

/// Triangles that are there several times, or wound the other way.
mod doubles;
/// Edges with T-junctions.
mod edges;
/// Meshes that fall on flat grounds.
mod falls;
/// Bodies that slide and roll over floors, some with a contact skin.
mod floors;
/// Levels of boxes that overlap.
mod levels;
/// Bodies that ride, and where.
mod rides;
/// Lids on the rims of open vessels.
mod rims;
/// Bodies that ride over meshes side by side.
mod roads;
/// Rooms with bodies inside.
mod rooms;
/// A nut on a bolt, by its closed form.
mod screw;
/// Meshes that roll, and fall, on two triangles.
mod slopes;
/// Closed meshes with bodies sunk in, and vessels.
mod solids;
/// Tables of the tests, and lists of known failures.
mod table;
/// Thin bodies that rest on the ground.
mod thin;
/// Sheets that stand upright along the edges of a floor.
mod upright;

/// The flags of all meshes of a run.
const FLAGS: [TriMeshFlags; 2] = [TriMeshFlags::empty(), TriMeshFlags::FIX_INTERNAL_EDGES];

/// A world with a fixed ground and the dispatcher of a user.
fn world(ground: ColliderBuilder) -> PhysicsWorld {
    world_of([ground], SbbkDispatcher::default())
}

/// Returns the place of a body some steps after its start in a world with a fixed ground.
fn end(steps: usize, ground: &SharedShape, start: RigidBodyBuilder, body: &SharedShape) -> Vec3 {
    let [ground, body] = [ground, body].map(|shape| ColliderBuilder::new(shape.clone()));
    after(steps, world(ground), start, body).translation()
}

/// An empty world with the dispatcher of a user, and its registrations of shapes.
fn prepared_world(shapes: &[&SharedShape], is_prepared: bool) -> (PhysicsWorld, Vec<PreparedTree>) {
    let dispatcher = SbbkDispatcher::default();
    let prepared = shapes.iter().filter(|_| is_prepared);
    let prepared = prepared.filter_map(|shape| dispatcher.prepare_shape(shape).expect("no defect"));
    let prepared = prepared.collect();
    (world_of([], dispatcher), prepared)
}

/// Returns each item with all flags of a run.
fn with_flags<T: Clone>(
    items: impl IntoIterator<Item = T>,
) -> impl Iterator<Item = (TriMeshFlags, T)> {
    items.into_iter().flat_map(|item| FLAGS.map(|flags| (flags, item.clone())))
}
