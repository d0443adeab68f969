//! The experiments: the paper's two scenes on all backends, and what lies behind their times.
//!
//! [`compare`] does all of them; each can be run on its own. Results are plain data, which
//! [`report`](crate::report) turns into tables, files and plots.
//!
//! Times are taken in one process, backends in turn, and without what happens only once: trees are
//! built before. Two runs of one scene soon differ, as chaos makes a different last bit of a contact
//! into a different trajectory; so the same pairs at the same poses are timed as well
//! ([`same_poses`]).

mod comparison;
pub mod contacts;
pub mod convex;
mod cut;
pub mod determinism;
mod error;
pub mod front;
mod helicopter;
mod meshes;
mod outline;
mod pile;
mod progress;
pub mod queries;
mod same_poses;
pub mod soak;
pub mod soft;
pub mod terrain;
mod turns;

pub use comparison::{ComparePlan, Comparison, compare};
pub use cut::{CutRow, CutStudy, Hierarchy, cut};
pub use error::StudyError;
pub use helicopter::{HelicopterPlan, HelicopterRow, helicopter};
pub use meshes::{MeshRow, meshes};
pub use pile::{PILE_QUERY_STRIDE, PilePlan, PileRow, PileStudy, pile};
pub use progress::Progress;
pub use same_poses::{SamePosesPlan, SamePosesRow, same_poses};
