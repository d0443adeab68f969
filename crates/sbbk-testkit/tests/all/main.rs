//! All tests of meshes and scenes, in one binary.

mod meshes;
mod scenes;
