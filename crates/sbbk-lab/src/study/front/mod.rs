//! What the parts of a front are worth: node tests, time and errors of each variant, for pairs that move slowly, fast, rest
//! with jitter, or tumble.
//!
//! Every variant answers the same sequences of poses, from nothing known on, and all queries are timed. Two times are taken:
//! of the *traversal*, until the pairs of leaves are known, the frame of the pose included; and of the whole
//! *query*, until the pairs of triangles within the prediction distance are known, exactly. These pairs are
//! compared with those of fresh descents.
//!
//! Besides, the dispatcher as a user has it makes a *journey* through all places of a mesh in slow motion, with a teleport
//! from each place to the next, beside stock.

mod journey;
mod motion;
mod plan;
mod report;
mod search;
mod variant;

pub use journey::{JourneyRow, JourneySide};
pub use motion::{FrontMotion, STEP_COUNT};
pub use plan::FrontPlan;
pub use report::{FrontRow, FrontStudy, VariantRow, front};
pub use variant::Variant;
