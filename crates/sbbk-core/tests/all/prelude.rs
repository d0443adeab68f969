//! Names that most tests use.

pub use crate::support::*;
pub use glamx::{DQuat, DVec3, Pose3, Quat, Vec3};
pub use sbbk_core::contact::{Feature, ManifoldPoints, TriangleContact};
pub use sbbk_core::leaf::LeafTest;
pub use sbbk_core::query::{FoundPair, SearchScratch};
pub use sbbk_core::surface::{Around, Facets, PlaceMemo, Side, SurfaceKind};
pub use sbbk_core::traverse::{
    DescentCounts, DescentScratch, MovingBody, PairFrame, Placement, Slack, SlackLimits, SlackPlan,
    TestedBox, descend,
};
pub use sbbk_core::tree::{BATCH, LayerPlan, LeafBatch, Node, Tree};
pub use sbbk_core::volumes::{Aabb, Kdop, SLABS, Sphere, directions};
pub use std::collections::{BTreeMap, BTreeSet};
pub use std::f32::consts::{FRAC_PI_2, PI, TAU};
