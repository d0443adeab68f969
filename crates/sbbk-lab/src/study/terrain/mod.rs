//! Monkey heads on terrains of growing size: the terrain as a height field and as a mesh of the same triangles.
//!
//! Stock Rapier has no contacts of a mesh and a height field, so it is timed on the mesh only. A head stands on the terrain at
//! random places and is asked there for the first time, and then in slow motion with what the query before left. All answers are
//! judged by brute force over the triangles. Besides, heads fall on a terrain in whole worlds, under stock too: how
//! many stay on it.

mod fall;
mod places;
mod plan;
mod way;

pub use fall::{Fall, HEAD_COUNT};
pub use plan::{Terrain, TerrainPlan, TerrainRow, terrain};
