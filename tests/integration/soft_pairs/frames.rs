use std::collections::BTreeSet;

use glamx::Vec3;
use oorandom::Rand32;
use rapier_integration::SbbkDispatcher;
use rapier3d::math::{Pose, Real};
use rapier3d::parry::query::{DefaultQueryDispatcher, QueryDispatcher};
use rapier3d::parry::shape::{Shape, SharedShape, TriMesh, TriMeshFlags};
use sbbk_testkit::mesh;

use super::question::{PREDICTION, anew, assert_same_set, furniture, hills};
use crate::heightfield::terrain::Terrain;
use crate::support::{
    Manifold, Pair, Question, assert_same, counting, deform, distance, shape, shape_with,
};
use crate::truth::Tally;

fn soft_ball(flags: TriMeshFlags) -> TriMesh {
    shape_with(&mesh::ball(0.7, 5), TriMeshFlags::DEFORMABLE | flags)
}

/// Moves a soft ball and another shape through hundreds of frames, in both orders. In some frames
/// vertices or pose stay. Panics if something is built or kept of the mesh.
fn run(
    other: &dyn Shape,
    flags: TriMeshFlags,
    height: Real,
    check: &mut dyn FnMut(&Question, &[Manifold]),
) {
    let dispatcher = counting();
    let mut soft = soft_ball(flags);
    let rest = soft.vertices().to_vec();
    let mut pairs: [Pair; 2] = Default::default();
    let mut pose = Pose::translation(0.05, height, 0.1);
    let (mut deformations, frames) = (0, 240);
    for frame in 0..frames {
        if frame % 12 < 7 {
            deform(&mut soft, &rest, frame);
            deformations += 1;
        }
        if !matches!(frame % 12, 4 | 11) {
            pose.translation.x += 1e-3 * (0.1 * frame as Real).sin();
        }
        for (pair, flipped) in pairs.iter_mut().zip([false, true]) {
            let question = Question::new(other, &soft, pose).flipped(flipped);
            check(&question, &pair.ask(&dispatcher, &question).manifolds);
        }
    }
    let stats = dispatcher.stats();
    assert_eq!((stats.unsupported_queries, stats.queries), (0, 2 * frames as u64), "{stats:?}");
    assert_eq!((stats.trees, stats.descended_queries), (0, stats.queries), "{stats:?}");
    assert!(deformations > frames / 2);
}

/// Would catch a lost or invented contact, and contacts of earlier vertices.
#[test]
fn a_soft_mesh_keeps_its_contacts_with_a_height_field() {
    let terrain = Terrain::new(hills(&mut Rand32::new(3)));
    let mut tally = Tally::default();
    run(&terrain.field, TriMeshFlags::empty(), 0.75, &mut |question, found| {
        assert_same_set(found, &anew(question, &SbbkDispatcher::default()));
        let question = Question { shapes: [&terrain.mesh, question.shapes[1]], ..*question };
        tally.add(&question, &terrain.renumbered(&question, found));
    });
    tally.check_all_right(10_000);
}

fn torus() -> TriMesh {
    shape(&mesh::torus(1.0, 0.4, 24, 12))
}

/// Would catch lost or invented contacts, and candidates, features or cones of vertices that are no
/// more.
#[test]
fn a_soft_mesh_keeps_its_contacts_with_a_rigid_one() {
    let torus = torus();
    for flags in [
        TriMeshFlags::empty(),
        TriMeshFlags::FIX_INTERNAL_EDGES,
        TriMeshFlags::FIX_INTERNAL_EDGES_TWO_SIDED,
    ] {
        let (mut tally, mut count) = (Tally::default(), 0);
        run(&torus, flags, 0.42, &mut |question, found| {
            assert_same(found, &question.fresh(&SbbkDispatcher::default()), 0.0);
            assert_same_set(found, &anew(question, &SbbkDispatcher::default()));
            count += found.len();
            if flags.is_empty() {
                tally.add(question, found);
            }
        });
        tally.check_all_right(if flags.is_empty() { 10_000 } else { 0 });
        assert!(count > 3_000, "{count} contacts with {flags:?}");
    }
}

/// Would catch stale candidates, separating axes or points.
#[test]
fn a_soft_mesh_keeps_its_contacts_with_convex_shapes() {
    for (other, top) in [
        (SharedShape::ball(0.5), 0.5),
        (SharedShape::cuboid(3.0, 0.2, 3.0), 0.2),
        (SharedShape::capsule_y(0.5, 0.3), 0.8),
        (SharedShape::cylinder(0.5, 0.4), 0.5),
        (SharedShape::halfspace(Vec3::Y), 0.0),
    ] {
        let mut count = 0;
        run(&*other, TriMeshFlags::empty(), top + 0.6, &mut |question, found| {
            assert_same_set(found, &anew(question, &SbbkDispatcher::default()));
            count += found.len();
        });
        assert!(count > 480, "{count} contacts with {:?}", other.shape_type());
    }
}

/// Would catch a lost or invented contact, by Parry's distance of each triangle and part.
#[test]
fn a_soft_mesh_keeps_its_contacts_with_a_compound() {
    let furniture = furniture(SharedShape::capsule_x(0.5, 0.1));
    // Error of Parry's iterations.
    const BAND: Real = 1e-3 * PREDICTION;
    let mut contacts = 0;
    run(&furniture, TriMeshFlags::empty(), 0.78, &mut |question, found| {
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

/// Would catch impulses lost where a mesh deforms a little: soft bodies would jitter.
#[test]
fn contacts_keep_their_data_while_a_mesh_deforms() {
    let (field, furniture) =
        (hills(&mut Rand32::new(3)), furniture(SharedShape::capsule_x(0.5, 0.1)));
    let torus = torus();
    for (other, height) in [(&field as &dyn Shape, 0.8), (&furniture, 0.78), (&torus, 0.42)] {
        let dispatcher = SbbkDispatcher::default();
        let mut soft = soft_ball(TriMeshFlags::empty());
        let mut pair = Pair::<(), u32>::default();
        for step in 0..6 {
            if step == 3 {
                // Rapier copies a shared shape before an edit.
                soft = soft.clone();
            }
            soft.update_vertices(|vertices| vertices.iter_mut().for_each(|v| *v *= 1.00001));
            let pose = Pose::translation(0.05, height, 0.1);
            let question = Question::new(other, &soft, pose).flipped(true);
            pair.ask(&dispatcher, &question);
            for point in pair.manifolds.iter_mut().flat_map(|manifold| &mut manifold.points) {
                point.data += 1;
            }
        }
        let points = || pair.manifolds.iter().flat_map(|manifold| &manifold.points);
        let (old, all) = (points().filter(|point| point.data == 6).count(), points().count());
        assert!(all > 10 && 10 * old > 8 * all, "{old} of {all}");
    }
}
