//! Names that most modules use.

pub(crate) use crate::backend::{Backend, Dispatcher, Memory, SharedDispatcher};
pub(crate) use crate::mesh;
pub(crate) use crate::mesh::Mesh;
pub(crate) use crate::metrics::{Errors, Sequence, Summary, sample, solver_points};
pub(crate) use crate::parallel;
pub(crate) use crate::progress::Progress;
pub(crate) use crate::replay;
pub(crate) use crate::replay::Recorder;
pub(crate) use crate::report::{Results, Row, file_error};
pub(crate) use crate::scene::{MonkeyPile, Scene, SceneWorld, collider, random};
pub(crate) use clap::ValueEnum;
pub(crate) use glamx::{DVec3, Pose3, Quat, Vec3};
pub(crate) use oorandom::Rand32;
pub(crate) use rapier3d::dynamics::{RigidBodyBuilder, RigidBodyHandle};
pub(crate) use rapier3d::geometry::{
    ColliderBuilder, ColliderHandle, ContactManifold, SharedShape, TriMeshFlags,
};
pub(crate) use rapier3d::math::{Pose, Real};
pub(crate) use rapier3d::pipeline::PhysicsWorld;
pub(crate) use serde::Serialize;
pub(crate) use std::collections::HashMap;
pub(crate) use std::io;
pub(crate) use std::path::{Path, PathBuf};
pub(crate) use std::sync::Arc;
pub(crate) use std::time::{Duration, Instant};
