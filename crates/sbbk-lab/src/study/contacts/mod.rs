//! Contacts of mesh pairs at every scale, stock Parry beside SBBK: how many are right, and what they
//! cost.
//!
//! A *case* is one mesh at one size, asked for its contacts with itself within one prediction
//! distance. Its poses come from *approaches*: one copy comes along a random direction, in a random
//! orientation, and is stopped at five places from nearly apart to deep inside. Every answer is
//! compared with brute force in f64, and both dispatchers answer in turn in one process.
//!
//! Dispatchers are called as the narrow phase calls them, but directly: contact skins, soft-CCD
//! margins and contact recycling are Rapier's, and have no part in it.

mod approach;
mod case;
mod contest;
mod errors;
mod exactness;
mod generator;
mod motion;
mod plan;
mod report;
mod side;
mod speed;
mod triangles;

pub use approach::PAIR_LIMIT;
pub(super) use approach::{Place, places};
pub use case::ContactCase;
pub use contest::CONTESTANTS;
pub(super) use contest::{Contest, Memory};
pub use errors::ContactErrors;
pub use exactness::{ExactnessRow, ExactnessSide};
pub(super) use motion::motion;
pub use motion::{FAST, SLOW, STEP_COUNT};
pub use plan::{ApproachedMesh, ContactsPlan, SHORT_REPEATS};
pub use report::{Contacts, SPEED_CASE, contacts};
pub use side::{Measured, Mode, Side};
pub use speed::SpeedRow;
pub use triangles::GeneratorRow;
