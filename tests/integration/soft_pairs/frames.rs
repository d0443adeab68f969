use std::collections::BTreeSet;

use glamx::Vec3;
use oorandom::Rand32;
use rapier_integration::SbbkDispatcher;
use rapier3d::math::{Pose, Real};
use rapier3d::parry::query::{DefaultQueryDispatcher, QueryDispatcher};
use rapier3d::parry::shape::{HeightField, Shape, SharedShape, TriMesh, TriMeshFlags};
use sbbk_testkit::mesh;

use super::question::{PREDICTION, anew, assert_same_set, furniture, hills};
use crate::support::{Manifold, Pair, Question, counting, distance, shape_with};
use crate::truth::Tally;

fn soft_ball() -> TriMesh {
    shape_with(&mesh::ball(0.7, 5), TriMeshFlags::DEFORMABLE)
}

/// Dents that wander over a mesh, from where its vertices are at rest.
fn deform(mesh: &mut TriMesh, rest: &[Vec3], frame: usize) {
    let phase = 0.07 * frame as Real;
    mesh.update_vertices(|vertices| {
        for (vertex, &rest) in vertices.iter_mut().zip(rest) {
            let dent = (4.0 * rest.x + phase).sin() * (3.0 * rest.z - 2.0 * phase).cos();
            *vertex = rest * (1.0 + 0.15 * dent);
        }
    });
}

/// A soft ball and another shape through hundreds of frames: of every twelve, five leave the
/// vertices, two the pose, and one both as they were. Both orders are asked; `check` gets the
/// question and the answer. Proves that nothing was built or kept of a mesh that may change.
fn run(other: &dyn Shape, height: Real, check: &mut dyn FnMut(&Question, &[Manifold], bool)) {
    let dispatcher = counting();
    let mut soft = soft_ball();
    let rest = soft.vertices().to_vec();
    let mut pairs: [Pair; 2] = Default::default();
    let mut pose = Pose::translation(0.05, height, 0.1);
    let (mut deformations, frames) = (0, 240);
    for frame in 0..frames {
        let is_deformed = frame % 12 < 7;
        if is_deformed {
            deform(&mut soft, &rest, frame);
            deformations += 1;
        }
        if !matches!(frame % 12, 4 | 11) {
            pose.translation.x += 1e-3 * (0.1 * frame as Real).sin();
        }
        for (pair, flipped) in pairs.iter_mut().zip([false, true]) {
            let question = Question::new(other, &soft, pose).flipped(flipped);
            check(&question, &pair.ask(&dispatcher, &question).manifolds, is_deformed);
        }
    }
    let stats = dispatcher.stats();
    assert_eq!((stats.unsupported_queries, stats.queries), (0, 2 * frames as u64), "{stats:?}");
    assert_eq!((stats.trees, stats.descended_queries), (0, stats.queries), "{stats:?}");
    assert!(deformations > frames / 2);
}

/// The triangles of a field as a mesh, and the number in the field of each, ascending.
fn as_mesh(field: &HeightField) -> (TriMesh, Vec<u32>) {
    let all = 0..2 * (field.nrows() * field.ncols()) as u32;
    let triangles = all.filter_map(|id| Some((id, *field.triangle_at_id(id)?.vertices())));
    let (ids, corners): (Vec<_>, Vec<_>) = triangles.unzip();
    let indices = (0..ids.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
    (TriMesh::new(corners.concat(), indices.collect()).unwrap(), ids)
}

/// Would catch a lost or invented contact, and a field that is asked with the mesh as it was: each
/// answer is judged by brute force in f64 over all pairs of triangles, and equal to that of a mesh
/// built anew bit for bit.
#[test]
fn a_soft_mesh_keeps_its_contacts_with_a_height_field() {
    let field = hills(&mut Rand32::new(3));
    let (ground, ids) = as_mesh(&field);
    let mut tally = Tally::default();
    run(&field, 0.75, &mut |question, found, _| {
        assert_same_set(found, &anew(question, &SbbkDispatcher::default()));
        let mut found = found.to_vec();
        for manifold in &mut found {
            let Manifold { subshape1, subshape2, .. } = manifold;
            let id = if question.is_flipped { subshape2 } else { subshape1 };
            *id = ids.binary_search(id).expect("a triangle of the field") as u32;
        }
        let meshes = [&ground, question.mesh()];
        let meshes = if question.is_flipped { [meshes[1], meshes[0]] } else { meshes };
        tally.add(&Question::new(meshes[0], meshes[1], question.pos12()), &found);
    });
    tally.check_all_right(10_000);
}

/// The same against stock's distance of each triangle and part.
#[test]
fn a_soft_mesh_keeps_its_contacts_with_a_compound() {
    let furniture = furniture(SharedShape::capsule_x(0.5, 0.1));
    // What Parry's iterations leave open, and its rounding.
    const BAND: Real = 1e-3 * PREDICTION;
    let mut contacts = 0;
    run(&furniture, 0.78, &mut |question, found, _| {
        let found: BTreeSet<[u32; 2]> = found
            .iter()
            .filter(|manifold| distance(manifold) <= PREDICTION)
            .map(|manifold| [manifold.subshape1, manifold.subshape2])
            .collect();
        for (part_index, (part_pose, part)) in (0..).zip(furniture.shapes()) {
            let part_pose = question.pose.inverse() * *part_pose;
            for (index, triangle) in (0..).zip(question.mesh().triangles()) {
                let apart = DefaultQueryDispatcher.distance(&part_pose, &triangle, &**part);
                let apart = apart.expect("Parry knows all these distances").distance;
                let pair = [index, part_index];
                let pair = if question.is_flipped { pair } else { [part_index, index] };
                let is_found = found.contains(&pair);
                let must = apart < PREDICTION - BAND;
                assert!(is_found || !must, "{pair:?} is lost, {apart} away");
                assert!(!is_found || apart <= PREDICTION + BAND, "{pair:?} is {apart} away");
                contacts += usize::from(is_found);
            }
        }
    });
    assert!(contacts > 5_000, "{contacts} contacts");
}

/// What a host stores with each contact point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Impulse(u32);

/// Would catch impulses lost where a mesh deforms a little: soft bodies would jitter.
#[test]
fn contacts_keep_their_data_while_a_mesh_deforms() {
    let (field, furniture) =
        (hills(&mut Rand32::new(3)), furniture(SharedShape::capsule_x(0.5, 0.1)));
    for (other, height) in [(&field as &dyn Shape, 0.8), (&furniture, 0.78)] {
        let dispatcher = SbbkDispatcher::default();
        let mut soft = soft_ball();
        let mut pair = Pair::<(), Impulse>::default();
        for _ in 0..6 {
            soft.update_vertices(|vertices| vertices.iter_mut().for_each(|v| *v *= 1.00001));
            let pose = Pose::translation(0.05, height, 0.1);
            let question = Question::new(other, &soft, pose).flipped(true);
            pair.ask(&dispatcher, &question);
            for point in pair.manifolds.iter_mut().flat_map(|manifold| &mut manifold.points) {
                point.data.0 += 1;
            }
        }
        let points = || pair.manifolds.iter().flat_map(|manifold| &manifold.points);
        let (old, all) = (points().filter(|point| point.data.0 == 6).count(), points().count());
        assert!(all > 10 && 10 * old > 8 * all, "{old} of {all}");
    }
}
