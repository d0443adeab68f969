//! Queries without manifolds, for a pair of meshes or a mesh and a convex shape.
//!
//! Registered and small meshes are searched by their trees ([`trees`]), all others by Parry's BVHs
//! ([`walk`]). A mesh and a convex shape ([`convex`]) use the BVH of the mesh. [`nonlinear`]
//! and [`moving`] cast along the curves of rigid motions.

mod bvh_search;
mod casts;
mod convex;
mod moving;
mod nonlinear;
mod proximity;
mod touch;
mod trees;
mod walk;

pub(crate) use convex::ConvexQuery;
pub(crate) use nonlinear::NonlinearCast;
pub(crate) use walk::MeshQuery;
