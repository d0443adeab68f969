//! Triangle meshes: a plain container and procedural shapes.
//!
//! Frame: right-handed, `y` up, in the units of the scene. Front faces are counter-clockwise seen
//! from outside.
//!
//! ```
//! use sbbk_testkit::mesh;
//!
//! let head = mesh::monkey_head();
//! assert_eq!(head.triangle_count(), 968);
//! ```

mod container;
mod dirty;
mod helicopter;
mod machine;
mod monkey;
mod shapes;

pub use container::Mesh;
pub use dirty::{
    cube_ball, doubled, random_winding, skirted, strips, tiles, tube, turned_inside_out,
    turned_near, two_sided, uneven_box, unwelded, vessel, walled_box, with_slivers,
};
pub use helicopter::helicopter;
pub use machine::{Gear, Rack, Thread, prism, revolved};
pub use monkey::{monkey_head, monkey_head_with};
pub use shapes::{ball, cuboid, floor, hill_height, hills, slab, terrain, torus};
