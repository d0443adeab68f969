//! Meshes that deform: soft bodies on a rigid mesh, and what it costs to follow one large mesh.

mod heads;
mod plan;
mod refit;

pub use heads::SoftHeadsRow;
pub use plan::{Soft, SoftPlan, soft};
pub use refit::{RefitFrame, RefitStudy};
