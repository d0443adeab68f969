//! Triangle meshes: a plain container, procedural shapes and files.
//!
//! [`Mesh`] is what scenes, tests and benchmarks pass around: positions and triangles, nothing
//! that belongs to a physics engine until [`Mesh::trimesh`] asks for it. Frame: right-handed,
//! `y` up, in the units of the scene. Front faces are counter-clockwise seen from outside.
//!
//! ```
//! use sbbk_lab::mesh;
//!
//! let head = mesh::monkey_head();
//! assert_eq!(head.triangle_count(), 968);
//! assert!(head.check_closed().is_ok());
//! ```

mod grids;
mod helicopter;
mod load;
mod monkey;
mod primitives;
mod surface;
mod triangle_mesh;
mod weld;

pub use helicopter::{HelicopterParts, ROTOR_HEIGHT, ROTOR_RADIUS, helicopter, helicopter_parts};
pub use load::{MeshError, MeshErrorCause, load};
pub use monkey::{monkey_head, monkey_head_with};
pub use primitives::{ball, cuboid, floor, terrain, torus};
pub use surface::{OpenEdge, OpenEdgeKind};
pub use triangle_mesh::Mesh;
