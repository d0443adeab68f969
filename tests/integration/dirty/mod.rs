//! Meshes as people have them, in worlds, beside the same bodies on Rapier's cuboid.
//!
//! Each test prints a table of what it measures and has a list of the cases that fail today. It fails
//! when another case fails, and when one of the list does not any more. To see the tables:
//! `cargo test -p sbbk --test integration dirty -- --nocapture`.

use rapier_integration::SbbkDispatcher;
use rapier3d::geometry::SharedShape;
use rapier3d::parry::shape::TriMeshFlags;
use rapier3d::pipeline::PhysicsWorld;
use sbbk_testkit::mesh::Mesh;
use sbbk_testkit::scene;

/// Bodies that slide and roll over floors.
mod floors;
/// Rooms with bodies inside.
mod rooms;
/// Meshes that roll, and fall, on two triangles.
mod slopes;
/// Closed meshes that push out what has sunk in, and vessels that do not.
mod solids;
/// What the tests print and what they know to fail.
mod table;
/// Sheets that stand upright along the edges of a floor.
mod upright;

/// The flags of all meshes of a run.
const FLAGS: [TriMeshFlags; 2] = [TriMeshFlags::empty(), TriMeshFlags::FIX_INTERNAL_EDGES];

/// An empty world with the dispatcher of a user.
fn world() -> PhysicsWorld {
    let mut world = PhysicsWorld::new();
    world.narrow_phase.set_query_dispatcher(SbbkDispatcher::default());
    world
}

fn shape(mesh: &Mesh, flags: TriMeshFlags) -> SharedShape {
    scene::shape(mesh, flags)
}

/// The name of a row, marked if meshes have flags.
fn row(name: &str, flags: TriMeshFlags) -> String {
    if flags.is_empty() { name.into() } else { format!("{name}{}", table::FLAG) }
}
