//! One mesh at a time: what its tree costs, and what first queries cost with and without it.

use std::convert::Infallible;
use std::time::Instant;

use glamx::{Pose3, Vec3};
use oorandom::Rand32;
use rapier3d::geometry::{ContactManifold, SharedShape};
use rapier3d::math::Real;
use sbbk_core::tree::{BuildOptions, Tree};
use serde::Serialize;

use super::turns::in_turn;
use super::{Progress, StudyError};
use crate::backend::{Answer, Backend, Primed, Question, SharedDispatcher};
use crate::mesh::Mesh;
use crate::metrics::{ErrorCount, Judge, Summary, ratio};
use crate::scene::{Solid, random};

/// One mesh against itself, at a few poses in touch; times are in milliseconds, summed up over the
/// repeats.
#[derive(Clone, Debug, Serialize)]
pub struct MeshRow {
    /// Name of the mesh.
    pub mesh: String,
    /// Its triangles.
    pub triangle_count: usize,
    /// To build Parry's shape, which is its tree above all.
    pub parry_build: Summary,
    /// To build the SBBK tree, on top of that.
    pub sbbk_build: Summary,
    /// Bytes of Parry's tree.
    pub parry_bytes: usize,
    /// Bytes of the SBBK tree. Its leaves hold the triangles themselves.
    pub sbbk_bytes: usize,
    /// First queries at all poses, with stock Parry; to free the manifolds is part of it.
    pub stock_queries: Summary,
    /// The same with SBBK, its tree built.
    pub sbbk_queries: Summary,
    /// Error of stock Parry's answers; `mesh_pairs` is the number of poses.
    pub stock_error: ErrorCount,
    /// Error of SBBK's answers.
    pub sbbk_error: ErrorCount,
}

impl MeshRow {
    /// Number of first queries after which the time they save has paid for building the tree, by
    /// the medians; `None` if they save none.
    pub fn break_even(&self) -> Option<f64> {
        let saved = self.stock_queries.median - self.sbbk_queries.median;
        ratio(self.sbbk_build.median * self.stock_error.mesh_pairs as f64, saved)
    }
}

/// The prediction distance of the queries: Rapier's default.
const PREDICTION: Real = 0.02;
/// Least and greatest number of poses. Large meshes, whose queries take long, get the least.
const POSES: [usize; 2] = [2, 10];
/// Least and greatest number of repeats.
const REPEATS: [usize; 2] = [3, 25];
/// Triangles in all poses, or all repeats, together.
const TRIANGLES: usize = 100_000;

/// Measures each mesh.
///
/// Errors: a mesh has no triangles, or a tree cannot be built for it.
pub fn meshes(meshes: &[Mesh], progress: &Progress) -> Result<Vec<MeshRow>, StudyError> {
    progress.phase("trees and first queries", meshes.len());
    let rows = meshes.iter().map(|mesh| {
        progress.step();
        measure(mesh)
    });
    rows.collect()
}

fn measure(mesh: &Mesh) -> Result<MeshRow, StudyError> {
    let count =
        |[least, most]: [usize; 2]| (TRIANGLES / mesh.triangle_count().max(1)).clamp(least, most);
    let shape = Solid::new(mesh)?.collider().shape;
    let parry_bytes = shape.as_trimesh().map_or(0, |mesh| mesh.bvh().total_memory_size());
    let sbbk_bytes = build(mesh)?.stats().bytes();
    let repeats = count(REPEATS);
    let [parry_build, sbbk_build] =
        race([&|| drop(mesh.shared_shape()), &|| drop(build(mesh))], repeats);
    let [stock, sbbk] = [Backend::Stock, Backend::Sbbk].map(Backend::dispatcher);
    let _primed = [&stock, &sbbk].map(|dispatcher| Primed::new(dispatcher, [&shape]));
    let touches = |pose: &Pose3| {
        let manifolds = ask(&sbbk, &shape, pose);
        manifolds.iter().any(|manifold| !manifold.points.is_empty())
    };
    let poses = poses(mesh, count(POSES), touches);
    let ask_all = |dispatcher| poses.iter().for_each(|pose| drop(ask(dispatcher, &shape, pose)));
    let [stock_queries, sbbk_queries] = race([&|| ask_all(&stock), &|| ask_all(&sbbk)], repeats);
    let [stock_error, sbbk_error] = judge([&stock, &sbbk], &shape, &poses);
    Ok(MeshRow {
        mesh: mesh.name.clone(),
        triangle_count: mesh.triangle_count(),
        parry_build,
        sbbk_build,
        parry_bytes,
        sbbk_bytes,
        stock_queries,
        sbbk_queries,
        stock_error,
        sbbk_error,
    })
}

fn build(mesh: &Mesh) -> Result<Tree, StudyError> {
    let tree = Tree::build(&mesh.vertices, &mesh.triangles, &BuildOptions::default());
    tree.map_err(|cause| StudyError::Tree { mesh: mesh.name.clone(), cause })
}

/// Milliseconds of two tasks, done in turn. `repeats` is at least 1.
fn race(tasks: [&dyn Fn(); 2], repeats: usize) -> [Summary; 2] {
    let Ok(times) = in_turn(&tasks, repeats, |task, _| {
        let start = Instant::now();
        task();
        Ok::<_, Infallible>(1e3 * start.elapsed().as_secs_f64())
    });
    let mut times = times.into_iter().flat_map(Summary::of);
    [(); 2].map(|()| times.next().expect("both tasks were done at least once"))
}

/// Poses of the mesh beside itself, in random directions and orientations: as far as it reaches,
/// then nearer by a twentieth at a time until `touches` says so, or the centres nearly meet.
fn poses(mesh: &Mesh, count: usize, touches: impl Fn(&Pose3) -> bool) -> Vec<Pose3> {
    let mut random = Rand32::new(1);
    let reach = |direction: Vec3| {
        let heights = mesh.vertices.iter().map(|vertex| vertex.dot(direction));
        heights.fold(f32::NEG_INFINITY, f32::max)
    };
    let poses = (0..count).map(|_| {
        let (direction, rotation) = (random::direction(&mut random), random::rotation(&mut random));
        let opposite = rotation.inverse() * -direction;
        let farthest = reach(direction) + reach(opposite);
        let pose = |step: u8| {
            let distance = farthest * (1.0 - 0.05 * f32::from(step));
            Pose3::from_parts(distance * direction, rotation)
        };
        (0..19).map(pose).find(&touches).unwrap_or(pose(19))
    });
    poses.collect()
}

/// A first query of the mesh against itself.
fn ask(dispatcher: &SharedDispatcher, shape: &SharedShape, pos12: &Pose3) -> Vec<ContactManifold> {
    let (mut manifolds, mut workspace) = (Vec::new(), None);
    dispatcher
        .contact_manifolds(pos12, &**shape, &**shape, PREDICTION, &mut manifolds, &mut workspace)
        .expect("every backend answers for two meshes");
    manifolds
}

/// Errors of both dispatchers; the truth of each pose is worked out once.
fn judge(
    dispatchers: [&SharedDispatcher; 2],
    shape: &SharedShape,
    poses: &[Pose3],
) -> [ErrorCount; 2] {
    let judge = Judge::new([shape]);
    let mut errors = [ErrorCount::default(); 2];
    for pose in poses {
        let question = Question::new(pose, [&**shape; 2], PREDICTION);
        let truth = judge.truth(&question);
        for (dispatcher, error) in dispatchers.iter().zip(&mut errors) {
            *error += truth.judge(&Answer::new(question, &ask(dispatcher, shape, pose)));
        }
    }
    errors
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh;

    /// Would catch poses at which nothing touches, or a race that does nothing: times and errors
    /// would then be about nothing. SBBK's answers must be right.
    #[test]
    fn the_queries_are_about_something() {
        let rows = meshes(&[mesh::ball(1.0, 4)], &Progress::hidden()).unwrap();
        let row = &rows[0];
        assert_eq!(row.triangle_count, 128);
        assert_eq!(row.sbbk_error.mesh_pairs, POSES[1]);
        assert!(row.sbbk_error.true_pairs >= POSES[1]);
        assert_eq!(row.sbbk_error.wrong(), 0);
        assert!(row.stock_queries.min > 0.0 && row.sbbk_build.min > 0.0);
        assert!(row.parry_bytes > 0 && row.sbbk_bytes > 0);
    }
}
