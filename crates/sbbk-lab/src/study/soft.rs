//! Meshes that deform: soft bodies on a rigid mesh, and what it costs to follow one large mesh.

use std::collections::BTreeSet;
use std::time::Instant;

use glamx::{Pose3, Vec3};
use rapier3d::geometry::{ContactManifold, SharedShape};
use rapier3d::math::Pose;
use rapier3d::parry::query::ContactManifoldsWorkspace;
use rapier3d::parry::shape::{TriMesh, TriMeshFlags};
use sbbk_core::tree::{BuildOptions, LayerPlan, Tree};
use serde::Serialize;

use super::turns::in_turn;
use super::{Progress, StudyError};
use crate::backend::{Backend, SharedDispatcher};
use crate::mesh::{self, Mesh};
use crate::metrics::{Environment, ErrorCount, Judge, StepTimes, Summary, timed_step};
use crate::scene::{Scene, SceneError, SoftHeads};

/// How much to measure.
#[derive(Clone, Copy, Debug)]
pub struct SoftPlan {
    /// Soft heads.
    pub heads: usize,
    /// Steps of each run.
    pub steps: usize,
    /// Timed runs of each backend.
    pub repeats: usize,
    /// Every so many steps of a run of its own are judged.
    pub judged_every: usize,
    /// Subdivision of the large ball: 8 times its square triangles.
    pub detail: u32,
    /// Frames through which the ball deforms; at least one.
    pub frames: usize,
}

impl SoftPlan {
    /// Within two minutes on two cores.
    pub fn standard() -> Self {
        Self { heads: 6, steps: 90, repeats: 3, judged_every: 10, detail: 112, frames: 500 }
    }

    /// Some seconds.
    pub fn quick() -> Self {
        Self { heads: 3, repeats: 1, judged_every: 15, detail: 35, frames: 50, ..Self::standard() }
    }
}

/// What [`soft`] found.
#[derive(Clone, Debug, Serialize)]
pub struct Soft {
    /// Machine and build.
    pub environment: Environment,
    /// The scene's name.
    pub scene: String,
    /// By backend.
    pub heads: Vec<SoftHeadsRow>,
    /// The large mesh.
    pub refit: RefitStudy,
}

/// One backend with soft heads. Times are means over the steps of a run, in milliseconds, summed up over the repeats.
#[derive(Clone, Debug, Serialize)]
pub struct SoftHeadsRow {
    /// Who answered.
    pub backend: Backend,
    /// The whole step.
    pub step: Summary,
    /// The queries of heads and helicopter.
    pub queries: Summary,
    /// Queries in all steps of a run.
    pub calls: u64,
    /// Of the answers that Rapier got in the judged run, against the vertices of that step.
    pub errors: ErrorCount,
}

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
    /// Contacts with a torus on a tree that is built in each frame.
    pub contacts: usize,
    /// Of these, how many the refitted tree lacks.
    pub lost: usize,
    /// Contacts that the refitted tree has and the built one lacks.
    pub added: usize,
}

/// Measures both.
///
/// Errors: a mesh does not serve.
pub fn soft(plan: &SoftPlan, progress: &Progress) -> Result<Soft, StudyError> {
    let scene = SoftHeads::with_heads(plan.heads);
    let study = Soft {
        environment: Environment::detect(),
        scene: scene.name(),
        heads: soft_heads(&scene, plan, progress)?,
        refit: refit(plan, progress)?,
    };
    progress.finish();
    Ok(study)
}

fn soft_heads(
    scene: &SoftHeads,
    plan: &SoftPlan,
    progress: &Progress,
) -> Result<Vec<SoftHeadsRow>, SceneError> {
    let backends = [Backend::Stock, Backend::Sbbk];
    progress.phase(scene.name(), (plan.repeats + 1) * backends.len());
    let runs = in_turn(&backends, plan.repeats, |&backend, _| {
        progress.step();
        let mut built = scene.build()?;
        let installed = backend.install(&mut built.world);
        let step = |_| timed_step(&mut built.world, &installed.probe);
        Ok::<Vec<StepTimes>, SceneError>((0..plan.steps).map(step).collect())
    })?;
    let mut rows = Vec::new();
    for (&backend, runs) in backends.iter().zip(&runs) {
        let errors = judged(scene, backend, plan)?;
        progress.step();
        let mean = |time: fn(&StepTimes) -> f64| {
            let of_run =
                |run: &Vec<StepTimes>| run.iter().map(time).sum::<f64>() / run.len() as f64;
            Summary::of(runs.iter().map(of_run))
        };
        if let (Some(step), Some(queries)) = (mean(|t| t.step), mean(|t| t.mesh_mesh)) {
            let calls = runs[0].iter().map(|times| times.mesh_mesh_calls).sum();
            rows.push(SoftHeadsRow { backend, step, queries, calls, errors });
        }
    }
    Ok(rows)
}

/// The answers of some steps, judged by the vertices at the start of the step, where Rapier asks.
fn judged(scene: &SoftHeads, backend: Backend, plan: &SoftPlan) -> Result<ErrorCount, SceneError> {
    let mut built = scene.build()?;
    let installed = backend.install(&mut built.world);
    let mut errors = ErrorCount::default();
    for step in 1..=plan.steps {
        if !step.is_multiple_of(plan.judged_every) {
            built.world.step();
            continue;
        }
        let shapes = built.world.colliders.iter().map(|(_, collider)| collider.shared_shape());
        let judge = Judge::of_present(shapes);
        installed.probe.start_recording();
        built.world.step();
        for answer in installed.probe.take_answers() {
            errors += judge.truth(&answer.question).judge(&answer);
        }
    }
    Ok(errors)
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

fn trimesh(mesh: &Mesh, flags: TriMeshFlags) -> Result<TriMesh, SceneError> {
    mesh.trimesh(flags).map_err(|cause| SceneError { mesh: mesh.name.clone(), cause })
}

fn refit(plan: &SoftPlan, progress: &Progress) -> Result<RefitStudy, StudyError> {
    progress.phase("refits".to_owned(), plan.frames);
    let ball = mesh::ball(1.0, plan.detail);
    let tree_error = |cause| StudyError::Tree { mesh: ball.name.clone(), cause };
    let build = |layers, vertices: &[Vec3]| -> Result<Tree, StudyError> {
        let options = BuildOptions { layers, ..BuildOptions::default() };
        Tree::build(vertices, &ball.triangles, &options).map_err(tree_error)
    };
    let mut trees =
        [build(LayerPlan::SBBK, &ball.vertices)?, build(LayerPlan::AABB_ONLY, &ball.vertices)?];
    let mut soft = SharedShape::new(trimesh(&ball, TriMeshFlags::DEFORMABLE)?);
    let soft = soft.make_mut().as_trimesh_mut().expect("made of a mesh");
    let torus = trimesh(&mesh::torus(1.0, 0.4, 24, 12), TriMeshFlags::empty())?;
    let pos12 = Pose3::from_parts(Vec3::new(1.5, 0.4, 0.2), glamx::Quat::from_rotation_x(1.0));
    let (dispatcher, mut pair) = (Backend::Sbbk.dispatcher(), Pair::default());
    let mut times: [Vec<f64>; 4] = Default::default();
    let (mut contacts, mut lost, mut added) = (0, 0, 0);
    for frame in 0..plan.frames {
        let vertices = deformed(&ball.vertices, frame);
        for (tree, times) in trees.iter_mut().zip(&mut times) {
            let start = Instant::now();
            tree.refit(&vertices, &ball.triangles).map_err(tree_error)?;
            times.push(1e3 * start.elapsed().as_secs_f64());
        }
        let start = Instant::now();
        soft.set_vertices(&vertices);
        times[2].push(1e3 * start.elapsed().as_secs_f64());
        let start = Instant::now();
        build(LayerPlan::SBBK, &vertices)?;
        times[3].push(1e3 * start.elapsed().as_secs_f64());

        let found = pair.contacts(&dispatcher, [soft, &torus], &pos12);
        let copy = soft.clone();
        let fresh = Pair::default().contacts(&Backend::Sbbk.dispatcher(), [&copy, &torus], &pos12);
        contacts += fresh.len();
        lost += fresh.difference(&found).count();
        added += found.difference(&fresh).count();
        progress.step();
    }
    let [all_layers, aabb_only, parry, build] =
        times.map(|times| Summary::of(times).expect("a plan has frames"));
    let (triangle_count, frames) = (ball.triangle_count(), plan.frames);
    Ok(RefitStudy {
        triangle_count,
        frames,
        all_layers,
        aabb_only,
        parry,
        build,
        contacts,
        lost,
        added,
    })
}
