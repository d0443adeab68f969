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
//! ```

mod container;
mod file;
mod helicopter;
mod machine;
mod monkey;
mod shapes;

pub use container::Mesh;
pub use file::{MeshError, load};
pub use helicopter::helicopter;
pub use machine::{Gear, Rack, Thread, prism, revolved};
pub use monkey::{monkey_head, monkey_head_with};
pub use shapes::{ball, cuboid, floor, hill_height, hills, slab, terrain, torus};
