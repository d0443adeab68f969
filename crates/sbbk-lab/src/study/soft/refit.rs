//! What it costs to follow one large mesh that deforms, and whether contacts are lost.

use std::collections::BTreeSet;
use std::time::Instant;

use glamx::{Pose3, Quat, Vec3};
use rapier3d::geometry::{ContactManifold, SharedShape};
use rapier3d::math::Pose;
use rapier3d::parry::query::ContactManifoldsWorkspace;
use rapier3d::parry::shape::{TriMesh, TriMeshFlags};
use sbbk_core::tree::{BuildError, BuildOptions, LayerPlan, Tree};
use serde::Serialize;

use super::plan::SoftPlan;
use crate::backend::{Backend, SharedDispatcher};
use crate::mesh::{self, Mesh};
use crate::metrics::Summary;
use crate::scene::SceneError;
use crate::study::{Progress, StudyError};

/// One mesh through many frames. Times are of one frame, in milliseconds.
#[derive(Clone, Debug, Serialize)]
pub struct RefitStudy {
    /// Triangles of the mesh.
    pub triangle_count: usize,
    /// Frames.
    pub frames: usize,
    /// Refit of sphere, AABBs and k-DOPs.
    pub all_layers: Summary,
    /// Refit of the same code with AABBs alone.
    pub aabb_only: Summary,
    /// Parry's `TriMesh::set_vertices`: AABBs, without optimisation; copies the vertices first.
    pub parry: Summary,
    /// A build of all layers.
    pub build: Summary,
    /// Frame by frame.
    pub by_frame: Vec<RefitFrame>,
    /// Contacts with a torus on a tree that is built in each frame.
    pub contacts: usize,
    /// Of these, how many the refitted tree lacks.
    pub lost: usize,
    /// Contacts that the refitted tree has and the built one lacks.
    pub added: usize,
}

/// One frame. Times are in milliseconds, and of what [`RefitStudy`] names alike.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct RefitFrame {
    /// Of all layers.
    pub all_layers: f64,
    /// Of AABBs.
    pub aabb_only: f64,
    /// By Parry.
    pub parry: f64,
    /// From nothing.
    pub build: f64,
    /// Contacts on a tree that is built in this frame.
    pub contacts: usize,
    /// Contacts on the refitted tree.
    pub refitted_contacts: usize,
    /// Contacts that only the built tree has.
    pub lost: usize,
    /// Contacts that only the refitted tree has.
    pub added: usize,
}

/// Follows one mesh through all frames.
pub(super) fn refit(plan: &SoftPlan, progress: &Progress) -> Result<RefitStudy, StudyError> {
    progress.phase("refits".to_owned(), plan.frames);
    let mut followed = Followed::new(mesh::ball(1.0, plan.detail))?;
    let by_frame = (0..plan.frames).map(|frame| {
        progress.step();
        followed.frame(frame)
    });
    let by_frame = by_frame.collect::<Result<Vec<_>, _>>()?;
    let time = |of: fn(&RefitFrame) -> f64| {
        Summary::of(by_frame.iter().map(of)).expect("a plan has frames")
    };
    let sum = |of: fn(&RefitFrame) -> usize| by_frame.iter().map(of).sum();
    Ok(RefitStudy {
        triangle_count: followed.ball.triangle_count(),
        frames: plan.frames,
        all_layers: time(|frame| frame.all_layers),
        aabb_only: time(|frame| frame.aabb_only),
        parry: time(|frame| frame.parry),
        build: time(|frame| frame.build),
        contacts: sum(|frame| frame.contacts),
        lost: sum(|frame| frame.lost),
        added: sum(|frame| frame.added),
        by_frame,
    })
}

/// A ball that deforms, and all that follows it.
struct Followed {
    ball: Mesh,
    all_layers: Tree,
    aabb_only: Tree,
    parry: SharedShape,
    torus: TriMesh,
    dispatcher: SharedDispatcher,
    pair: Pair,
}

impl Followed {
    fn new(ball: Mesh) -> Result<Self, StudyError> {
        Ok(Self {
            all_layers: build(&ball, LayerPlan::SBBK, &ball.vertices)?,
            aabb_only: build(&ball, LayerPlan::AABB_ONLY, &ball.vertices)?,
            parry: SharedShape::new(trimesh(&ball, TriMeshFlags::DEFORMABLE)?),
            torus: trimesh(&mesh::torus(1.0, 0.4, 24, 12), TriMeshFlags::empty())?,
            dispatcher: Backend::Sbbk.dispatcher(),
            pair: Pair::default(),
            ball,
        })
    }

    fn frame(&mut self, frame: usize) -> Result<RefitFrame, StudyError> {
        let Self { ball, all_layers, aabb_only, parry, torus, dispatcher, pair } = self;
        let vertices = deformed(&ball.vertices, frame);
        let refit = |tree: &mut Tree| tree.refit(&vertices, &ball.triangles);
        let (all_layers, refitted) = timed(|| refit(all_layers));
        refitted.map_err(|cause| tree_error(ball, cause))?;
        let (aabb_only, refitted) = timed(|| refit(aabb_only));
        refitted.map_err(|cause| tree_error(ball, cause))?;
        let soft = parry.make_mut().as_trimesh_mut().expect("made of a mesh");
        let (parry, ()) = timed(|| soft.set_vertices(&vertices));
        let (build, built) = timed(|| build(ball, LayerPlan::SBBK, &vertices));
        drop(built?);

        let pos12 = Pose3::from_parts(Vec3::new(1.5, 0.4, 0.2), Quat::from_rotation_x(1.0));
        let found = pair.contacts(dispatcher, [&*soft, &*torus], &pos12);
        let copy = soft.clone();
        let fresh = Pair::default().contacts(&Backend::Sbbk.dispatcher(), [&copy, torus], &pos12);
        Ok(RefitFrame {
            all_layers,
            aabb_only,
            parry,
            build,
            contacts: fresh.len(),
            refitted_contacts: found.len(),
            lost: fresh.difference(&found).count(),
            added: found.difference(&fresh).count(),
        })
    }
}

/// What some work takes, in milliseconds, and its result.
fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let result = work();
    (1e3 * start.elapsed().as_secs_f64(), result)
}

fn build(ball: &Mesh, layers: LayerPlan, vertices: &[Vec3]) -> Result<Tree, StudyError> {
    let options = BuildOptions { layers, ..BuildOptions::default() };
    Tree::build(vertices, &ball.triangles, &options).map_err(|cause| tree_error(ball, cause))
}

fn tree_error(ball: &Mesh, cause: BuildError) -> StudyError {
    StudyError::Tree { mesh: ball.name.clone(), cause }
}

fn trimesh(mesh: &Mesh, flags: TriMeshFlags) -> Result<TriMesh, SceneError> {
    mesh.trimesh(flags).map_err(|cause| SceneError { mesh: mesh.name.clone(), cause })
}

/// A pair of shapes from query to query.
#[derive(Default)]
struct Pair {
    manifolds: Vec<ContactManifold>,
    workspace: Option<ContactManifoldsWorkspace>,
}

impl Pair {
    /// The pairs of triangles that touch.
    fn contacts(
        &mut self,
        dispatcher: &SharedDispatcher,
        [one, two]: [&TriMesh; 2],
        pos12: &Pose,
    ) -> BTreeSet<(u32, u32)> {
        let Self { manifolds, workspace } = self;
        let answer = dispatcher.contact_manifolds(pos12, one, two, 0.02, manifolds, workspace);
        answer.expect("two meshes are supported");
        manifolds.iter().map(|manifold| (manifold.subshape1, manifold.subshape2)).collect()
    }
}

/// Waves that wander over the ball.
fn deformed(rest: &[Vec3], frame: usize) -> Vec<Vec3> {
    let phase = 0.05 * frame as f32;
    let wave = |v: &Vec3| (4.0 * v.x + phase).sin() * (3.0 * v.y - 2.0 * phase).cos();
    rest.iter().map(|v| *v * (1.0 + 0.15 * wave(v)) + Vec3::Z * (0.2 * (2.0 * v.x).sin())).collect()
}
