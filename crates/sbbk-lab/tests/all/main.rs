//! All tests of the lab's interface, in one binary.

mod judge;
mod mesh_load;
mod mesh_shapes;
mod runs;
mod scenes;
mod studies;
