//! Tests of the dispatcher inside Rapier and Parry, by stock Parry, by brute force in f64, and by
//! new dispatchers.
//!
//! `properties` and `coming_back` hold for every kind of pair: no memory in the result, no
//! allocation, no contact at poses that are not finite. `who_answers` tests who computes which
//! query.
//!
//! | a mesh and | contacts are right | after any history | in worlds |
//! |---|---|---|---|
//! | a mesh | `exact`, `normals`, `surfaces`, `judged` | `motion`, `edited_mesh` | `rest`, `scenes` |
//! | a mesh without a tree | `walks` | `properties` | `deformable` |
//! | convex shapes | `convex::fresh` | `properties` | `convex::rest` |
//! | compounds | `compound` | `properties` | `compound` |
//! | a height field | `heightfield::truth` | `heightfield::change` | `heightfield::rest` |
//! | a soft mesh and any shape | `properties` | `soft_pairs::histories` | `soft_pairs::worlds` |
//!
//! Queries without manifolds are in `queries`, `nonlinear` and, of meshes without trees, `walks`.
//! `features.rs` has the tests that are run again with Rapier's features.

/// Pairs that come back to where they were, are cut short, or forget everything.
mod coming_back;
/// Meshes against compounds of convex shapes.
mod compound;
/// Promises about successive calls of a host.
mod contract;
/// Meshes against convex shapes.
mod convex;
/// Meshes that move their vertices between queries.
mod deformable;
/// Same inputs, same bits.
mod determinism;
/// Meshes with the defects of meshes that people have, in worlds.
mod dirty;
/// A mesh that changes while pairs know it.
mod edited_mesh;
/// SBBK's own contacts against the truth, and against stock where stock is right.
mod exact;
/// Time that grows with the triangles.
mod growth;
/// Meshes against height fields.
mod heightfield;
/// Bodies wholly inside a solid.
mod inside;
/// Selection of contacts of surfaces, near and far.
mod judged;
/// Pairs of every kind.
mod kinds;
/// Runs of minutes, which `cargo test --workspace` leaves out.
mod long_runs;
/// Memory of trees.
mod memory;
/// Motion that never loses a contact: random walks against fresh queries.
mod motion;
/// Nonlinear casts that start in contact.
mod nonlinear;
/// Contact normals constrained at internal edges.
mod normals;
/// Candidates, and data of manifolds and points.
mod pairs;
/// A few manifolds for all contacts of a pair.
mod patches;
/// Names that most tests use.
mod prelude;
/// Promises that hold for every kind of pair.
mod properties;
/// Queries without manifolds against brute force.
mod proximity;
/// Queries without manifolds.
mod queries;
/// Bodies at rest, and sliding, beside stock Rapier.
mod rest;
/// Meshes that share a tree, and edits of them.
mod same_mesh;
/// The paper's scenes beside stock Rapier.
mod scenes;
/// Worlds that are saved and restored.
mod snapshot;
/// Meshes that move their vertices, against height fields and compounds.
mod soft_pairs;
/// Asking, comparing, meshes and poses.
mod support;
/// Contacts of surfaces beside contacts of triangles.
mod surfaces;
/// Thin and fast bodies, and contacts of fine meshes that are not near.
mod thin;
/// Brute force in f64.
mod truth;
/// Rigid meshes with vertices that are not finite.
mod unsupported;
/// Meshes without trees: large, deformable, or many at once.
mod walks;
/// Who answers for which pair and query.
mod who_answers;
/// Bodies above a ground.
mod worlds;
