pub use glamx::{Pose3, Quat, Vec2, Vec3};
pub use oorandom::Rand32;
pub use rapier_integration::{ContactDetail, ContactSet, SbbkDispatcher};
pub use rapier3d::dynamics::{RigidBody, RigidBodyBuilder, RigidBodyHandle};
pub use rapier3d::geometry::ColliderBuilder;
pub use rapier3d::math::{Pose, Real, Vector};
pub use rapier3d::parry::query::details::ShapeCastOptions;
pub use rapier3d::parry::query::{
    ClosestPoints, DefaultQueryDispatcher, NonlinearRigidMotion, PersistentQueryDispatcher,
    PointQuery, QueryDispatcher, ShapeCastHit, ShapeCastStatus, TrackedContact,
};
pub use rapier3d::parry::shape::{
    Compound, Cuboid, HeightField, Shape, SharedShape, TriMesh, TriMeshFlags,
};
pub use rapier3d::parry::utils::Array2;
pub use rapier3d::pipeline::PhysicsWorld;
pub use sbbk_testkit::mesh::{self, Mesh};
pub use std::collections::{BTreeMap, BTreeSet};
pub use std::f32::consts::{FRAC_PI_2, PI, TAU};

pub use crate::support::*;
pub use crate::worlds::*;
